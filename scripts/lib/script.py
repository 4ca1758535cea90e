"""Code that the scripts share: paths, commands, files, tables, and errors of one line."""

import argparse
import json
import os
import shlex
import subprocess
import sys

NAME = os.path.basename(sys.argv[0])
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PROGRAMS = os.path.join(ROOT, "build", "release", "bin")


class Failed(Exception):
    """A command failed, or did not give its result. The text is for the user."""


def say(text):
    print(f"{NAME}: {text}", file=sys.stderr, flush=True)


def start(main):
    """Ends with the exit code that `main` returns, or with the message of what failed."""
    try:
        sys.exit(main())
    except (Failed, OSError) as failure:
        sys.exit(f"{NAME}: {failure}")


def run(command, environment=None, **more):
    """Returns what the command writes to stdout. `environment` adds to our own."""
    done = subprocess.run(command, check=False, text=True, env={**os.environ, **(environment or {})},
                          **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **more})
    if done.returncode != 0:
        said = ((done.stdout or "") + (done.stderr or "")).strip()
        raise Failed(f"'{shlex.join(command)}' ended with {done.returncode}{':' if said else ''}\n{said}".rstrip())
    return done.stdout


def need_program(path):
    if not os.access(path, os.X_OK):
        raise Failed(f"there is no program '{path}': build the preset release (scripts/quickstart does), or name another")


def read_json(path):
    with open(path, encoding="utf-8") as file:
        try:
            return json.load(file)
        except ValueError as error:
            raise Failed(f"'{path}' is not JSON: {error}") from error


def write(path, text):
    """Writes the complete text or leaves the file unchanged."""
    with open(path + ".part", "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(path + ".part", path)


def errors(program, reference, test, *flags):
    """What 'gatelight compare' says of the second picture, as its JSON."""
    return json.loads(run([program, "compare", reference, test, "--json", "-", *flags]))


def print_table(rows):
    """Rows of text in columns: the first to the left, the others to the right."""
    widths = [max(map(len, column)) for column in zip(*rows)]
    for first, *others in rows:
        cells = [first.ljust(widths[0])] + [text.rjust(width) for text, width in zip(others, widths[1:])]
        print("  ".join(cells).rstrip())


def parser(description):
    return argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)


def add_program(to):
    to.add_argument("--gatelight", default=os.path.join(PROGRAMS, "gatelight"), metavar="FILE",
                    help="the program (default: that of build/release)")


def integers(text):
    return [int(word) for word in text.split(",") if word]
