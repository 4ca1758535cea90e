"""Runs cycles_render.py in Blender."""

import json
import os

from script import Failed, run

HERE = os.path.dirname(os.path.abspath(__file__))


def render(blender, job):
    """The seconds of each of the job's sample counts. `blender`: the program, or a Python that has the package bpy."""
    file = os.path.join(HERE, "cycles_render.py")
    python = os.path.basename(blender).startswith("python")
    command = [blender, file] if python else [blender, "-b", "--factory-startup", "-P", file]
    # Blender finds the modules of its Python through the first python3 on the path, which must be the system's.
    text = run([*command, "--", json.dumps(job)], {"PATH": "/usr/local/bin:/usr/bin:/bin"})
    lines = [line for line in text.splitlines() if line.startswith("cycles: ")]
    if not lines:
        raise Failed(f"blender rendered nothing of {job['scene']}; its output:\n{text}")
    seconds = json.loads(lines[-1].removeprefix("cycles: "))["seconds"]
    return [seconds[str(count)] for count in job["spp"]]
