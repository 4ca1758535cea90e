"""A session of Blender as a Python module, with the extension of apps/blender."""

import os
import pathlib
import shutil
import signal
import sys
import tempfile

import bpy

HERE = pathlib.Path(__file__).resolve().parent
_folders = []
EXTENSION = "gatelight_extension"


def enable(program):
    """The extension under a name that no other module has."""
    folder = tempfile.mkdtemp(prefix="modules-")
    os.symlink(HERE.parents[1] / "apps" / "blender", os.path.join(folder, EXTENSION))
    _folders.append(folder)
    sys.path.insert(0, folder)
    bpy.ops.preferences.addon_enable(module=EXTENSION)
    bpy.context.preferences.addons[EXTENSION].preferences.program = program


def file_name(scene, engine):
    """Of the picture of a scene."""
    return f"{scene.replace(', ', '-').replace(' ', '-')}-{engine.lower()}.exr"


def set_up(engine, size, samples):
    scene = bpy.context.scene
    scene.render.engine = engine
    scene.render.resolution_x = scene.render.resolution_y = size
    if hasattr(scene.render.image_settings, "media_type"):
        scene.render.image_settings.media_type = "MULTI_LAYER_IMAGE"
    scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    if hasattr(scene.render.image_settings, "use_exr_interleave"):
        scene.render.image_settings.use_exr_interleave = True  # one part, as earlier versions
    scene.render.image_settings.color_depth = "32"
    if engine == "CYCLES":
        cycles = scene.cycles
        cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = samples, False, False
        cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
        cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = cycles.volume_bounces = 64
    else:
        settings = scene.gatelight
        settings.preset, settings.integrator, settings.denoiser, settings.spp = "NONE", "path", "none", samples
    return scene


def start(program):
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell starts background jobs with it ignored
    bpy.ops.wm.read_factory_settings(use_empty=True)
    enable(program)


def end():
    """Blender as a module does not end cleanly by itself."""
    for folder in _folders:
        shutil.rmtree(folder)
    sys.stdout.flush()
    os._exit(0)
