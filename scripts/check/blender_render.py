"""blender_render.py PROGRAM FOLDER NAME ENGINE SIZE SAMPLES: renders a scene of blender_scenes.py, in a Python that has bpy, and prints
the means of its passes as JSON."""

import json
import os
import pathlib
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(HERE))

import bpy  # noqa: E402
import blender_scenes  # noqa: E402
import numpy  # noqa: E402

EXTENSION = "gatelight_extension"


def enable(program):
    """The extension under a name that no other module has."""
    folder = tempfile.mkdtemp(prefix="gatelight-modules-")
    os.symlink(HERE.parents[1] / "apps" / "blender", os.path.join(folder, EXTENSION))
    sys.path.insert(0, folder)
    bpy.ops.preferences.addon_enable(module=EXTENSION)
    bpy.context.preferences.addons[EXTENSION].preferences.program = program
    os.remove(os.path.join(folder, EXTENSION))
    os.rmdir(folder)


def set_up(engine, size, samples):
    scene = bpy.context.scene
    scene.render.engine = engine
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    scene.render.image_settings.color_depth = "32"
    if engine == "CYCLES":
        cycles = scene.cycles
        cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling, cycles.sample_clamp_indirect, cycles.blur_glossy = samples, False, False, 0.0, 0.0
        cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = cycles.volume_bounces = 64
    else:
        settings = scene.gatelight
        settings.preset, settings.integrator, settings.denoiser, settings.spp = "NONE", "path", "none", samples
    return scene


def main():
    program, folder, name, engine, size, samples = sys.argv[1:7]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    enable(program)
    scene = set_up(engine, int(size), int(samples))
    build = next(build for title, build, *_ in blender_scenes.SCENES if title == name)
    build()
    path = os.path.join(folder, f"{name.replace(', ', '-').replace(' ', '-')}-{engine.lower()}.exr")
    scene.render.filepath = path
    begun = time.monotonic()
    bpy.ops.render.render(write_still=True)
    seconds = time.monotonic() - begun
    sys.path.insert(0, str(HERE.parents[1] / "apps" / "blender"))
    import exr  # noqa: PLC0415  the extension's own reader
    layers = exr.read(path).layers
    layers = {key: pixels for key, pixels in layers.items() if ".Crypto" not in key}
    for kind in ("Dir", "Ind"):  # Cycles divides light by the surface's colour, Gatelight leaves it in
        for key in [key for key in layers if key.endswith(kind)]:
            layers[key] = layers[key] * layers.get(key.replace(kind, "Col"), 1.0)
    layers = {key: pixels for key, pixels in layers.items() if not key.endswith("Col")}
    means = {key.partition(".")[2]: [float(x) for x in numpy.where(pixels < 1e9, pixels, 0.0).mean(axis=(0, 1))]
             for key, pixels in layers.items()}
    print("RESULT " + json.dumps({"means": means, "seconds": seconds}))
    sys.stdout.flush()
    os._exit(0)  # Blender as a module does not end cleanly


main()
