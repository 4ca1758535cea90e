"""blender_render.py PROGRAM FOLDER NAME ENGINE SIZE SAMPLES: renders a scene of blender_scenes.py, in a Python that has bpy, and prints
the means of its passes as JSON."""

import json
import os
import pathlib
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(HERE))

import blender_scenes  # noqa: E402
import blender_session  # noqa: E402
import bpy  # noqa: E402
import numpy  # noqa: E402

def main():
    program, folder, name, engine, size, samples = sys.argv[1:7]
    blender_session.start(program)
    scene = blender_session.set_up(engine, int(size), int(samples))
    build = next(build for title, build, *_ in blender_scenes.SCENES if title == name)
    build()
    path = os.path.join(folder, blender_session.file_name(name, engine))
    scene.render.filepath = path
    begun = time.monotonic()
    bpy.ops.render.render(write_still=True)
    seconds = time.monotonic() - begun
    sys.path.insert(0, str(HERE.parents[1] / "apps" / "blender"))
    import exr  # noqa: PLC0415  the extension's own reader
    layers = exr.read(path).layers
    layers = {key: pixels for key, pixels in layers.items() if ".Crypto" not in key}
    for kind, color in (("Dir", "Col"), ("Ind", "Col"), ("Direct", "Color"), ("Indirect", "Color")):
        for key in [key for key in layers if key.endswith(kind)]:  # Cycles divides light by the surface's colour
            layers[key] = layers[key] * layers.get(key.removesuffix(kind) + color, 1.0)
    layers = {key: pixels for key, pixels in layers.items() if not key.endswith(("Col", "Color"))}
    means = {key.partition(".")[2]: [float(x) for x in numpy.where(pixels < 1e9, pixels, 0.0).mean(axis=(0, 1))]
             for key, pixels in layers.items()}
    print("RESULT " + json.dumps({"means": means, "seconds": seconds}))
    blender_session.end()


main()
