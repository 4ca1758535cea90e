"""Gatelight as a render engine of Blender."""

import bpy

from . import engine, main_thread, panel, preferences, sequence, view
from .exporter_hooks import glTF2ExportUserExtension  # noqa: F401  Blender's exporter looks for it here

PARTS = (main_thread, preferences, sequence, view, panel)


def register():
    for part in PARTS:
        part.register()
    bpy.utils.register_class(engine.GatelightEngine)


def unregister():
    bpy.utils.unregister_class(engine.GatelightEngine)
    for part in reversed(PARTS):
        part.unregister()
