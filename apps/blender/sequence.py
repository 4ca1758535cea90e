"""Runs of the program, and the one that lives from frame to frame of an animation."""

import atexit
import shutil

import bpy

_kept = {}  # (scene, view layer) -> Job


class Job:
    """A run, its folder and its pictures."""

    def __init__(self, program_run, folder, output, frames, exported, notes):
        self.run, self.folder, self.output, self.frames = program_run, folder, output, frames
        self.exported, self.notes = exported, notes
        self._running = True

    def picture(self, frame):
        return self.output.replace("{frame}", str(frame))

    def is_finished(self, frame):
        """Whether the program has said that the picture of a frame is complete."""
        return frame in self.run.frames_done

    def is_waiting(self, frame):
        """Takes in what the program has said. Whether the picture of a frame is yet to come."""
        self._running = self.run.update()
        return self._running and not self.is_finished(frame)

    def stop(self):
        self.run.stop()

    def close(self):
        self.run.stop(seconds=2.0)
        shutil.rmtree(self.folder, ignore_errors=True)


def current(scene, layer):
    """The run that already renders the frames of a scene's layer."""
    return _kept.get((scene.name_full, layer))


def keep(scene, layer, job):
    _kept[scene.name_full, layer] = job


@bpy.app.handlers.persistent
def end_all(*_):
    """Ends the runs of a render that is complete or cancelled."""
    while _kept:
        _kept.popitem()[1].close()


def register():
    for handlers in (bpy.app.handlers.render_complete, bpy.app.handlers.render_cancel):
        handlers.append(end_all)
    atexit.register(end_all)


def unregister():
    end_all()
    atexit.unregister(end_all)
    for handlers in (bpy.app.handlers.render_complete, bpy.app.handlers.render_cancel):
        handlers.remove(end_all)
