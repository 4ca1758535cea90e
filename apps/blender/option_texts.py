"""The texts of the program's flags, taken from the table that its help prints."""

import json
import os
import re

TABLE = os.path.join(os.path.dirname(__file__), "option_texts.json")
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


def load(help_text):
    """The table that the packaging wrote, or what the program's own help says (None: there is no program)."""
    if os.path.exists(TABLE):
        with open(TABLE, encoding="utf-8") as file:
            return json.load(file)
    return parse(help_text or "")
