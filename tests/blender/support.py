"""What the tests share: the modules of the extension that need no Blender, as a package without its own start."""

import importlib
import os
import pathlib
import sys
import types
import unittest

SOURCE = pathlib.Path(__file__).parents[2]
DATA = SOURCE / "data"
PROGRAM = os.environ.get("GATELIGHT_PROGRAM", str(SOURCE / "build/release/bin/gatelight"))

_package = types.ModuleType("gatelight_extension")
_package.__path__ = [str(SOURCE / "apps/blender")]
sys.modules[_package.__name__] = _package


def module(name):
    return importlib.import_module(f"gatelight_extension.{name}")


main = unittest.main
