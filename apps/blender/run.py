"""The program as a child: its events, snapshots of the picture so far, and its end."""

import collections
import json
import os
import signal
import subprocess
import threading

CODES = {1: "wrong usage", 2: "unusable input", 3: "output not written", 4: "out of memory or threads", 5: "something is missing",
         6: "a sample was not finite"}
STOPPED = {129, 130, 143, -signal.SIGINT, -signal.SIGTERM}


class Run:
    """One call of the program, with --progress json."""

    def __init__(self, command):
        self.command = command
        self.progress = {}  # the last event with a fraction
        self.messages = []  # warnings
        self.error = None
        self.frames_done = set()
        self._events = collections.deque()
        self._child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                       encoding="utf-8", errors="replace")
        self._reader = threading.Thread(target=self._read, args=(self._child.stderr,), daemon=True)
        self._reader.start()

    def _read(self, pipe):
        with pipe:
            self._events.extend(pipe)

    def update(self):
        """Takes in what the program has said. Returns whether it still runs."""
        running = self._child.poll() is None
        if not running:
            self._reader.join(5.0)
        while self._events:
            line = self._events.popleft()
            try:
                self._take(json.loads(line))
            except ValueError:
                self.error = line.strip() or self.error
        return running

    def _take(self, event):
        kind = event.get("event")
        if kind == "progress":
            self.progress = event
        elif kind == "frame":
            self.frames_done.add(event["frame"])
        elif kind in ("warning", "note"):
            self.messages.append(event["message"])
        elif kind == "error":
            self.error = event["message"]

    def failure(self):
        """Why the program ended without a whole picture; None if all is well, or if it was asked to stop."""
        code = self._child.returncode
        if code == 0 or code in STOPPED:
            return None
        if code is not None and code < 0:
            return f"gatelight was ended by signal {-code}: expected it to finish its picture"
        return f"gatelight: {self.error or CODES.get(code, 'failed')} (exit code {code})"

    def take_messages(self):
        """The warnings since the last call."""
        taken, self.messages = self.messages, []
        return taken

    def ask_for_snapshot(self):
        if hasattr(signal, "SIGUSR1") and self._child.poll() is None:
            self._child.send_signal(signal.SIGUSR1)

    def stop(self, seconds=60.0):
        """Lets it write the picture so far; ends it if that takes too long."""
        if self._child.poll() is None:
            self._child.send_signal(signal.SIGINT)
            try:
                self._child.wait(seconds)
            except subprocess.TimeoutExpired:
                self._child.kill()
                self._child.wait()
        self.update()


def line_of(progress):
    """A status line, as 'Rendering 12 of 64 samples'."""
    phase = progress.get("phase")
    if phase == "render":
        return f"Rendering {progress.get('spp_done', 0)} of {progress.get('spp', '?')} samples"
    return {"scout": "Looking for surfaces", "train": "Training the cache", "denoise": "Denoising"}.get(phase, "Starting")


def time_left(progress):
    """Text of the remaining time, or nothing."""
    seconds = progress.get("eta_seconds")
    return f"{int(seconds) // 60:02d}:{seconds % 60:04.1f} left" if seconds is not None else ""


def when_written(path):
    """A number that changes when the file does; None: it is not there."""
    try:
        return os.stat(path).st_mtime_ns
    except OSError:
        return None
