"""blender_live.py PROGRAM: "View in Gatelight", in a Python that has bpy: what the page gets, before and after changes. Prints seconds
and what is left behind."""

import json
import os
import pathlib
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(HERE))

import blender_scenes  # noqa: E402
import blender_session  # noqa: E402
import bpy  # noqa: E402


def ask(window, path):
    """What a browser gets."""
    return sys.modules[f"{blender_session.EXTENSION}.relay"].ask(window.relay.address, "GET", path)


def wait_for(view, replaced):
    """Lets Blender's timer, which a module does not have, run until the program was replaced so often. Returns the seconds."""
    begun = time.monotonic()
    while view._window.relay.replaced < replaced:
        view._tick()
        time.sleep(0.05)
        if time.monotonic() > begun + 60.0:
            raise SystemExit("the window does not follow")
    return time.monotonic() - begun


def floor(window):
    """The radiance of the floor in front, in the whole picture."""
    while not json.loads(ask(window, "api/status?viewer=shared")[2])["complete"]:
        time.sleep(0.05)
    return json.loads(ask(window, "api/pixel?x=0.5&y=0.95&viewer=shared")[2])["layers"]["radiance"][0]


def main():
    blender_session.start(sys.argv[1])
    view = sys.modules[f"{blender_session.EXTENSION}.view"]
    blender_session.set_up("GATELIGHT", 48, 16)
    cube, _ = blender_scenes.stage()
    _, background = blender_scenes.world((0.4, 0.4, 0.4))
    bpy.ops.gatelight.view()
    window, seconds = view._window, wait_for(view, 1)
    light = floor(window)
    page = [ask(window, name)[0] for name in ("", "view.js", "api/scene?viewer=a")]
    print(f"LIVE opened: {seconds:.1f} s; the page is {'there' if page == [200] * 3 else page}; radiance {light:.3f}")
    background.inputs["Strength"].default_value = 2.0
    cube.location.z += 0.01
    bpy.context.view_layer.update()
    seconds = wait_for(view, 2)
    print(f"LIVE a brighter world: {seconds:.1f} s; {floor(window) / light:.2f} times as bright, expected 2.00")
    bpy.context.view_layer.update()
    for _ in range(20):
        view._tick()
        time.sleep(0.1)
    print(f"LIVE without a change: {'nothing' if window.relay.replaced == 2 and not window.next else 'exported again'}")
    view.close()
    left = [name for name in os.listdir(tempfile.gettempdir()) if name.startswith("gatelight-")]
    print(f"LIVE closed; left behind: {left or 'nothing'}")
    blender_session.end()


main()
