"""Work that only Blender's main thread may do, for renders in another one: F12 in a window has its own, and -b has not."""

import queue
import threading

import bpy

POLL = 0.05  # seconds

_asked = queue.SimpleQueue()


class GivenUp(Exception):
    """The render was stopped before the main thread came to it."""


def run(act, is_over):
    """What `act` returns, or what it throws. Throws GivenUp once `is_over` says so."""
    if threading.current_thread() is threading.main_thread():
        return act()
    answer, given_up = queue.SimpleQueue(), threading.Event()
    _asked.put((act, answer, given_up))
    while True:
        try:
            result, error = answer.get(timeout=POLL)
        except queue.Empty:
            if is_over():
                given_up.set()
                raise GivenUp from None
            continue
        if error is not None:
            raise error
        return result


def _tick():
    while not _asked.empty():
        act, answer, given_up = _asked.get()
        if given_up.is_set():
            continue
        try:
            answer.put((act(), None))
        except Exception as error:  # noqa: BLE001  the thread that asked has to get it
            answer.put((None, error))
    return POLL


def register():
    if not bpy.app.background:
        bpy.app.timers.register(_tick, persistent=True)


def unregister():
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
