"""The texts of the program's flags, taken from the table that its help prints."""

import re

COLUMN = 30  # where the help's explanations begin


def parse(text):
    """Flag -> explanation, from the text of `gatelight render --help-all`."""
    texts, name = {}, None
    for line in text.splitlines():
        started = re.match(r"  --([a-z][a-z-]*)", line)
        if started:
            name = started[1]
            texts[name] = line[COLUMN:].strip() if len(line) > COLUMN and line[COLUMN - 1] == " " else ""
        elif name and line.startswith(" " * COLUMN):
            texts[name] = f"{texts[name]} {line.strip()}".strip()
        else:
            name = None
    return texts
