"""View in Gatelight: the scene in the program's window, and again where it is pressed again."""

import os
import shutil
import subprocess
import tempfile

import bpy

from . import find_program, flags, preferences, report
from .export import Unusable, export

_window = {"child": None, "folder": None}


def close(*_):
    """Ends the window's program and removes its files."""
    child, folder = _window["child"], _window["folder"]
    if child is not None and child.poll() is None:
        child.terminate()
        child.wait(10.0)
    if folder:
        shutil.rmtree(folder, ignore_errors=True)
    _window.update(child=None, folder=None)


class GATELIGHT_OT_view(bpy.types.Operator):
    bl_idname = "gatelight.view"
    bl_label = "View in Gatelight"
    bl_description = "Opens the scene, as it is now, in the program's window; press again after changes"

    def execute(self, context):
        close()
        _window["folder"] = tempfile.mkdtemp(prefix="gatelight-")
        notes = report.Notes()
        try:
            program = find_program.find(preferences.program_path())
            find_program.check(program)
            made = export(context.scene, context.evaluated_depsgraph_get(), _window["folder"], notes, False)
            chosen = flags.of_panel(preferences.values(context.scene.gatelight))
            chosen = flags.for_media(chosen) if made.only_clear_media else chosen
        except (Unusable, find_program.NoProgram, flags.BadFlags, OSError) as error:
            close()
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        notes.print()
        unused = {"--aov", "--cryptomatte", "--region"}
        pairs = list(zip(made.flags[::2], made.flags[1::2]))
        kept = [word for name, value in pairs if name not in unused for word in (name, value)]
        with open(os.path.join(_window["folder"], "log"), "w", encoding="utf-8") as log:
            _window["child"] = subprocess.Popen([program, "view", made.path, *kept, *chosen], stdin=subprocess.DEVNULL, stdout=log,
                                                stderr=log)
        self.report({"INFO"}, notes.summary() or "The window opens in the browser")
        return {"FINISHED"}


def register():
    bpy.utils.register_class(GATELIGHT_OT_view)


def unregister():
    close()
    bpy.utils.unregister_class(GATELIGHT_OT_view)
