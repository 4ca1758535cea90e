"""Run by a whole Blender, as `blender -b --python blender_file.py -- PROGRAM FILE`: names the program in the preferences of the installed
extension, and saves an animated scene for it."""

import pathlib
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import blender_scenes  # noqa: E402
import blender_session  # noqa: E402
import bpy  # noqa: E402

PROGRAM, FILE = sys.argv[-2:]
bpy.context.preferences.addons["bl_ext.user_default.gatelight"].preferences.program = PROGRAM
bpy.ops.wm.save_userpref()
bpy.data.batch_remove(bpy.data.objects)
blender_session.set_up("GATELIGHT", 48, 8)
blender_scenes.moving_ball()
bpy.context.scene.render.image_settings.file_format = "PNG"
bpy.ops.wm.save_as_mainfile(filepath=FILE)
