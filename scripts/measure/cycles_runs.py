"""Blender's Cycles beside Gatelight: the arguments of both comparisons, and runs of cycles_render.py in Blender. A file
cycles.py beside that script would hide the add-on of this name."""

import json
import os

from measured_scenes import add_scenes
from script import Failed, add_program, run

HERE = os.path.dirname(os.path.abspath(__file__))


def add_arguments(parser, scenes, size, blender):
    """Arguments of a comparison on these scenes; `blender`: those of its argument."""
    add_scenes(parser)
    parser.add_argument("--scene", action="append", choices=scenes, help="only this one (default: all)")
    add_program(parser)
    parser.add_argument("--blender", **blender)
    parser.add_argument("--size", default=size, metavar="WxH", help=f"default: {size}")
    parser.add_argument("--threads", type=int, default=len(os.sched_getaffinity(0)), help="default: all")


def render(options, scene, measured, counts, **more):
    """The seconds of each sample count. `more`: bounces, seed, out and denoise of cycles_render.py; `measured` is a key of
    measured_scenes.BRIGHTNESS. options.blender: the program, or a Python that has the package bpy."""
    job = {"scene": scene.path(options.scenes), "camera": scene.camera, "environment": scene.sky(measured),
           "size": [int(v) for v in options.size.split("x")], "threads": options.threads, "spp": counts, **more}
    file = os.path.join(HERE, "cycles_render.py")
    python = os.path.basename(options.blender).startswith("python")
    command = [options.blender, file] if python else [options.blender, "-b", "--factory-startup", "-P", file]
    # Blender finds the modules of its Python through the first python3 on the path, which must be the system's.
    text = run([*command, "--", json.dumps(job)], {"PATH": "/usr/local/bin:/usr/bin:/bin"})
    lines = [line for line in text.splitlines() if line.startswith("cycles: ")]
    if not lines:
        raise Failed(f"blender rendered nothing of {job['scene']}; its output:\n{text}")
    seconds = json.loads(lines[-1].removeprefix("cycles: "))["seconds"]
    return [seconds[str(count)] for count in counts]
