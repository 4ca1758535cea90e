"""blender_faults.py PROGRAM: what can go wrong, in a Python that has bpy. Prints a line for each case: what Blender says, and what is
left behind."""

import os
import pathlib
import resource
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
FAKE = "#!/bin/sh\necho '{}'\n"  # answers everything with one line


def preferences():
    return bpy.context.preferences.addons[blender_session.EXTENSION].preferences


def fresh_scene(spp=16):
    """The plain stage in an empty file."""
    bpy.ops.wm.read_homefile(use_empty=True)
    preferences().program = PROGRAM
    blender_session.set_up("GATELIGHT", 48, spp)
    blender_scenes.stage()
    blender_scenes.world((0.4, 0.4, 0.4))


def children():
    """Processes of the program that this one has started."""
    found = []
    for entry in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            fields = (entry / "stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[1]) == os.getpid() and fields[0] != "Z":
            found.append(int(entry.name))
    return found


def render(folder):
    """What Blender says, and the seconds."""
    begun = time.monotonic()
    bpy.context.scene.render.filepath = os.path.join(folder, "picture.exr")
    try:
        bpy.ops.render.render(write_still=True)
        said = "no error"
    except RuntimeError as error:
        said = str(error).strip().splitlines()[0]
    return said, time.monotonic() - begun


def later(seconds, act):
    threading.Timer(seconds, act).start()


def no_program(folder):
    preferences().program = os.path.join(folder, "nothing")


def fake(folder, text):
    path = os.path.join(folder, "gatelight")
    pathlib.Path(path).write_text(FAKE.format(text))
    os.chmod(path, 0o755)
    preferences().program = path


def old_program(folder):
    fake(folder, "gatelight 0.9.0")


def other_program(folder):
    fake(folder, "something else")


def no_camera(folder):
    bpy.context.scene.camera = None


def full_disk(folder):
    """No file may have more than 256 KiB: enough for the scene, too little for the picture."""
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 640
    bpy.context.scene.gatelight.spp = 1
    resource.setrlimit(resource.RLIMIT_FSIZE, (256 << 10, resource.RLIM_INFINITY))


def killed_child(folder):
    bpy.context.scene.gatelight.spp = 1 << 20
    later(1.0, lambda: [os.kill(child, signal.SIGKILL) for child in children()])


def stopped(folder):
    """A signal after a second and a half; the picture so far is kept."""
    bpy.context.scene.gatelight.spp = 1 << 20
    later(1.5, lambda: os.kill(os.getpid(), signal.SIGINT))


def path_with_umlauts(folder):
    tempfile.tempdir = os.path.join(folder, "schöne Bilder mit Leerzeichen")
    os.mkdir(tempfile.tempdir)


def linked_library(folder):
    """A ball of another file."""
    path = os.path.join(folder, "bücherei.blend")
    made = bpy.data.objects["Sphere"]
    bpy.data.libraries.write(path, {made})
    bpy.data.objects.remove(made)
    with bpy.data.libraries.load(path, link=True) as (there, here):
        here.objects = there.objects
    for linked in here.objects:
        bpy.context.scene.collection.objects.link(linked)


def wrong_flags(folder):
    bpy.context.scene.gatelight.more = "--no-such-flag"


CASES = (no_program, old_program, other_program, no_camera, full_disk, killed_child, stopped, path_with_umlauts, linked_library,
         wrong_flags)


def main():
    blender_session.start(PROGRAM)
    for case in CASES:
        fresh_scene()
        with tempfile.TemporaryDirectory(prefix="faults-") as folder:
            tempfile.tempdir = None
            before = set(os.listdir(tempfile.gettempdir()))
            case(folder)
            said, seconds = render(folder)
            left = [name for name in set(os.listdir(tempfile.gettempdir())) - before if name.startswith("gatelight-")]
            picture = os.path.exists(os.path.join(folder, "picture.exr"))
            resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
            tempfile.tempdir = None
            print(f"FAULT {case.__name__.replace('_', ' ')}: {said} ({seconds:.1f} s; picture: {'yes' if picture else 'no'}; "
                  f"left behind: {left or 'nothing'}; running: {children() or 'nothing'})")
    blender_session.end()


main()
