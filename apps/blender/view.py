"""View in Gatelight: the scene in the program's window, which follows changes in Blender until its page is closed."""

import os
import shutil
import subprocess
import tempfile
import time

import bpy

from . import find_program, flags, option_texts, preferences, relay, report
from .export import Unusable, export

POLL = 0.2  # seconds
PAUSE, LONGEST_PAUSE = 0.5, 3.0  # seconds without a change before the scene is exported again; twice the time that this takes
GONE = 150.0  # seconds after which a page that does not ask is closed; browsers let hidden ones ask once a minute
FAILURES = (Unusable, find_program.NoProgram, flags.BadFlags, OSError)


class Window:
    """The relay that the page talks to, the program behind it, and the next one, which loads a changed scene."""

    def __init__(self, scene):
        self.scene, self.relay = scene.name, relay.Relay()  # not the scene itself, which an undo replaces
        self.shown = self.next = None  # Viewer
        self.changed = None  # when
        self.exporting, self.pause = False, PAUSE

    def export(self):
        """Starts the program with the scene as it is. Returns what was lost on the way."""
        self.exporting, begun = True, time.monotonic()
        try:
            notes = report.Notes()
            started = Viewer(bpy.data.scenes[self.scene], bpy.context.evaluated_depsgraph_get(), notes)
            bpy.context.view_layer.update()  # what the exporter has changed and put back is no change
        finally:
            self.exporting, self.changed = False, None
        if self.next:
            self.next.close()
        self.next, self.pause = started, min(max(PAUSE, 2.0 * (time.monotonic() - begun)), LONGEST_PAUSE)
        return notes

    def step(self):
        """Exports a changed scene, and shows the next program once it has loaded it."""
        if self.next and (address := self.next.address()):
            self.relay.replace(address, self.shown is None or self.shown.view == self.next.view)
            if self.shown:
                self.shown.close()
            elif not bpy.app.background:
                bpy.ops.wm.url_open(url=self.relay.address)
            self.shown, self.next = self.next, None
        elif self.next and self.next.child.poll() is not None:
            said = self.next.said()
            self.next.close()
            self.next = None
            raise Unusable(said.splitlines()[-1] if said else "the window's program ended")
        if self.changed and time.monotonic() - self.changed > self.pause and not bpy.app.is_job_running("RENDER"):
            self.export()

    def close(self):
        self.relay.close()
        for viewer in (self.shown, self.next):
            if viewer:
                viewer.close()


class Viewer:
    """A run of `gatelight view` and its folder."""

    def __init__(self, scene, depsgraph, notes):
        program = find_program.find(preferences.program_path())
        find_program.check(program)
        self.folder = tempfile.mkdtemp(prefix="gatelight-")
        try:
            made = export(scene, depsgraph, self.folder, notes, False)
            chosen = flags.of_panel(preferences.values(scene.gatelight))
            chosen = flags.for_media(chosen) if made.only_clear_media else chosen
            known = option_texts.parse(find_program.output(program, "view", "--help-all"))
            self.view = [*map(tuple, scene.camera.matrix_world), made.lens]
            command = [program, "view", made.path, "--no-browser", *flags.known_of([*made.flags, *chosen], known)]
            with open(self._log(), "w", encoding="utf-8") as log:
                self.child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        except BaseException:
            shutil.rmtree(self.folder, ignore_errors=True)
            raise

    def _log(self):
        return os.path.join(self.folder, "log")

    def said(self):
        with open(self._log(), encoding="utf-8", errors="replace") as log:
            return log.read().strip()

    def address(self):
        """Where it listens; None while it loads the scene."""
        return next((line for line in self.said().splitlines() if line.startswith("http://")), None)

    def close(self):
        if self.child.poll() is None:
            self.child.terminate()
            try:
                self.child.wait(5.0)
            except subprocess.TimeoutExpired:
                self.child.kill()
                self.child.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


_window = None


def close():
    global _window
    if _window:
        _window.close()
    _window = None


@bpy.app.handlers.persistent
def _forget(*_):
    """Another file has no part in the window."""
    close()


@bpy.app.handlers.persistent
def _note_change(scene, depsgraph):
    seen = any(update.is_updated_geometry or update.is_updated_shading or update.is_updated_transform for update in depsgraph.updates)
    if _window and not _window.exporting and scene.name == _window.scene and seen:
        _window.changed = time.monotonic()


@bpy.app.handlers.persistent
def _note_undo(*_):
    if _window:
        _window.changed = time.monotonic()


def _tick():
    """Blender's timer; None ends it."""
    if not _window or time.monotonic() - _window.relay.asked > GONE:
        close()
        return None
    try:
        _window.step()
    except FAILURES as error:
        line = f"Gatelight: {error}"
        print(line)
        if not bpy.app.background:
            bpy.context.window_manager.popup_menu(lambda menu, _: menu.layout.label(text=line), icon="ERROR")
    return POLL


class GATELIGHT_OT_view(bpy.types.Operator):
    bl_idname = "gatelight.view"
    bl_label = "View in Gatelight"
    bl_description = "Opens the scene in the program's window, which follows changes until its page is closed"

    def execute(self, context):
        global _window
        close()
        _window = Window(context.scene)
        try:
            notes = _window.export()
        except FAILURES as error:
            close()
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        notes.print()
        if not bpy.app.timers.is_registered(_tick):
            bpy.app.timers.register(_tick, first_interval=POLL)
        self.report({"INFO"}, notes.summary() or f"The window is {_window.relay.address}")
        return {"FINISHED"}


HANDLERS = ((bpy.app.handlers.depsgraph_update_post, _note_change), (bpy.app.handlers.frame_change_post, _note_change),
            (bpy.app.handlers.undo_post, _note_undo), (bpy.app.handlers.redo_post, _note_undo), (bpy.app.handlers.load_pre, _forget))


def register():
    bpy.utils.register_class(GATELIGHT_OT_view)
    for handlers, function in HANDLERS:
        handlers.append(function)


def unregister():
    close()
    for handlers, function in HANDLERS:
        handlers.remove(function)
    bpy.utils.unregister_class(GATELIGHT_OT_view)
