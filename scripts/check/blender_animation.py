"""blender_animation.py PROGRAM: an animation of 12 frames as one run and as twelve, and one that is interrupted after two frames, in a
Python that has bpy. Prints seconds and what is left."""

import os
import pathlib
import signal
import sys
import tempfile
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(HERE))

import blender_scenes  # noqa: E402
import blender_session  # noqa: E402
import bpy  # noqa: E402

PROGRAM = sys.argv[1]
FRAMES = 12


def moving_scene():
    scene = blender_session.set_up("GATELIGHT", 96, 4)
    blender_scenes.moving_ball()
    settings = scene.gatelight
    settings.preset, settings.integrator, settings.denoiser, settings.spp = "standard", "nrc", "DEFAULT", 0
    scene.view_layers[0].use_pass_vector = False
    if hasattr(scene.render.image_settings, "media_type"):
        scene.render.image_settings.media_type = "IMAGE"
    scene.render.image_settings.file_format = "PNG"
    return scene


def timed(folder, act):
    bpy.context.scene.render.filepath = os.path.join(folder, "f")
    begun = time.monotonic()
    try:
        act()
        said = ""
    except RuntimeError as error:
        said = str(error).strip().splitlines()[-1]
    return time.monotonic() - begun, len(os.listdir(folder)), said


def singles(scene):
    def act():
        path = scene.render.filepath
        for frame in range(1, FRAMES + 1):
            scene.frame_set(frame)
            scene.render.filepath = f"{path}{frame:04d}"
            bpy.ops.render.render(write_still=True)
    return act


def interrupt_after(folder, count):
    def watch():
        while len(os.listdir(folder)) < count:
            time.sleep(0.02)
        time.sleep(0.4)
        os.kill(os.getpid(), signal.SIGINT)
    threading.Thread(target=watch, daemon=True).start()


def main():
    blender_session.start(PROGRAM)
    scene = moving_scene()
    for name, make in (("one run", lambda: lambda: bpy.ops.render.render(animation=True)), ("twelve runs", lambda: singles(scene))):
        with tempfile.TemporaryDirectory() as folder:
            seconds, files, said = timed(folder, make())
            print(f"ANIMATION {name}: {seconds:.1f} s, {files} files {said}")
    with tempfile.TemporaryDirectory() as folder:
        interrupt_after(folder, 2)
        seconds, files, said = timed(folder, lambda: bpy.ops.render.render(animation=True))
        left = [name for name in os.listdir(tempfile.gettempdir()) if name.startswith("gatelight-")]
        print(f"ANIMATION interrupted after two frames: {seconds:.1f} s, {files} files; left behind: {left or 'nothing'}; {said}")
    blender_session.end()


main()
