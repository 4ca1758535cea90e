"""Renders leave Python's other threads at work, and end when they are asked to."""

import os
import signal
import threading
import time
import unittest

import numpy
from support import DATA, gatelight, lit_square, main

LONG = dict(size=(320, 180), preset=None, integrator="path", denoiser="none", spp=65536)


class Threads(unittest.TestCase):
    def test_stop_from_another_thread(self):
        renderer = gatelight.Renderer(gatelight.load(DATA / "cornell-box.glb"), **LONG)
        threading.Timer(0.5, renderer.stop).start()
        picture = renderer.render()
        self.assertTrue(picture.statistics["interrupted"])
        self.assertGreater(numpy.asarray(picture).sum(), 0)

    def test_other_threads_count(self):
        counted, done = [0], threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        end = time.monotonic() + 0.7
        gatelight.render(lit_square(), stop=lambda: time.monotonic() > end, **LONG)
        done.set()
        thread.join()
        self.assertGreater(counted[0], 50)

    def test_progress(self):
        seen, end = [], time.monotonic() + 0.5
        gatelight.render(lit_square(), progress=seen.append, stop=lambda: time.monotonic() > end, **LONG)
        self.assertIn(seen[-1]["phase"], ("render", "denoise"))

    def test_interrupt(self):
        threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            gatelight.render(DATA / "cornell-box.glb", **LONG)

    def test_exceptions_of_callables(self):
        with self.assertRaises(ZeroDivisionError):
            gatelight.render(lit_square(), progress=lambda _: 1 / 0, **LONG)


if __name__ == "__main__":
    main()
