"""Finds the program and checks that it knows what the extension asks of it."""

import os
import re
import shutil
import subprocess

NAME = "gatelight.exe" if os.name == "nt" else "gatelight"
OLDEST = (1, 0, 0)
NEEDED = ("--fog", "--cryptomatte", "--clip", "--light-links")  # the newest flags; extensions of glTF came with the last one
PLACES = ("/usr/local/bin", "/usr/bin", "/opt/gatelight/bin", "~/gatelight/bin", "~/.local/bin", "~/gatelight/usr/bin")

_helps = {}


class NoProgram(Exception):
    """There is no usable program; the text is for the user."""


def candidates(preference):
    """Where to look, in this order; with a preference, only there."""
    if preference:
        path = os.path.expanduser(preference)
        if not os.path.isdir(path):
            return [path]
        return [os.path.join(path, *part, NAME) for part in ((), ("bin",), ("usr", "bin"))]
    found = shutil.which(NAME)
    return ([found] if found else []) + [os.path.join(os.path.expanduser(place), NAME) for place in PLACES]


def find(preference):
    """The path of the program. Throws NoProgram."""
    looked = candidates(preference)
    for path in looked:
        if os.path.isfile(path) and os.access(path, os.X_OK):
            return path
    where = f"in '{preference}', which the preferences name" if preference else "in PATH or the usual folders"
    raise NoProgram(f"there is no program 'gatelight' {where}: install it, or name its file or folder in the extension's preferences")


def output(path, *arguments):
    """What the program writes to stdout. Throws NoProgram."""
    try:
        done = subprocess.run([path, *arguments], capture_output=True, text=True, encoding="utf-8", timeout=20, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise NoProgram(f"'{path}' does not start: {error}; expected the program Gatelight") from error
    return done.stdout


def version_of(text):
    """The numbers of `gatelight --version`, or nothing."""
    match = re.match(r"gatelight (\d+)\.(\d+)\.(\d+)", text)
    return tuple(map(int, match.groups())) if match else None


def check(path):
    """The help of `render`. Throws NoProgram if the program is another or too old. Asks once as long as the file stays the same."""
    key = (path, os.stat(path).st_mtime_ns)
    if key not in _helps:
        version, oldest = version_of(output(path, "--version")), ".".join(map(str, OLDEST))
        if version is None:
            raise NoProgram(f"'{path}' is not Gatelight: expected 'gatelight {oldest}' or later from --version")
        text = output(path, "render", "--help-all")
        missing = [flag for flag in NEEDED if flag not in text]
        if version < OLDEST or missing:
            lack = f" without {', '.join(missing)}" if missing else ""
            raise NoProgram(f"'{path}' is version {'.'.join(map(str, version))}{lack}: expected {oldest} or later with all its flags")
        _helps[key] = text
    return _helps[key]
