"""The program is found, checked, started, watched and stopped; flags and texts are its own."""

import os
import pathlib
import signal
import subprocess
import tempfile
import time
import tomllib
import unittest

from support import DATA, PROGRAM, SOURCE, main, module

find_program, flags, option_texts, report, run = (module(name) for name in ("find_program", "flags", "option_texts", "report", "run"))


class Finding(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(suffix=" mit Ümlaut")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def program(self, answer):
        path = self.folder / "bin" / find_program.NAME
        path.parent.mkdir(exist_ok=True)
        path.write_text(f"#!/bin/sh\necho '{answer}'\n")
        path.chmod(0o755)
        return str(path)

    def test_a_folder_or_a_file_is_named(self):
        path = self.program("")
        self.assertEqual((find_program.find(str(self.folder)), find_program.find(path)), (path, path))

    def refusal(self, path):
        with self.assertRaises(find_program.NoProgram) as caught:
            find_program.check(path)
        self.assertEqual(len(str(caught.exception).splitlines()), 1)
        return str(caught.exception)

    def test_others_are_refused(self):
        self.assertIn("0.9.3", self.refusal(self.program("gatelight 0.9.3")))
        self.assertIn("not Gatelight", self.refusal(self.program("something")))
        with self.assertRaises(find_program.NoProgram):
            find_program.find(str(self.folder / "nothing"))

    def test_the_program_itself_is_taken(self):
        self.assertIn("--spp", find_program.check(PROGRAM))


class Manifest(unittest.TestCase):
    def setUp(self):
        with open(SOURCE / "apps/blender/blender_manifest.toml", "rb") as file:
            self.manifest = tomllib.load(file)

    def test_texts_are_as_short_as_blender_demands(self):
        for text in (self.manifest["tagline"], *self.manifest["permissions"].values()):
            self.assertLessEqual(len(text), 64)
            self.assertNotEqual(text[-1], ".")

    def test_the_version_is_the_programs(self):
        said = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True, check=True).stdout
        self.assertEqual(tuple(map(int, self.manifest["version"].split("."))), find_program.version_of(said))


class Texts(unittest.TestCase):
    def test_every_property_has_a_tooltip(self):
        texts = option_texts.parse(find_program.check(PROGRAM))
        for name in flags.NAMES:
            self.assertGreater(len(texts[name.replace("_", "-")]), 10, name)


class Flags(unittest.TestCase):
    def test_zero_leaves_the_choice_to_the_preset(self):
        values = {"preset": "standard", "spp": 0, "denoiser": "DEFAULT", "device": "", "clamp": 0.0, "more": ""}
        self.assertEqual(flags.of_panel(values), ["--preset", "standard"])

    def test_values_and_further_words(self):
        given = flags.of_panel({"preset": "NONE", "spp": 8, "time_limit": 2.5, "more": "--fog '0.1, 1,1,1'"})
        self.assertEqual(given, ["--spp", "8", "--time-limit", "2.5", "--fog", "0.1, 1,1,1"])
        for bad in ("--size 4x4", "-o x.png", "'open"):
            with self.assertRaises(flags.BadFlags):
                flags.further(bad)

    def test_a_window_gets_the_flags_that_it_knows(self):
        words = ["--time-limit", "2", "--spp", "8", "--fog=1", "--sky", "none"]
        self.assertEqual(flags.known_of(words, {"spp", "sky"}), ["--spp", "8", "--sky", "none"])

    def test_media_have_straight_shadows_unless_chosen(self):
        self.assertEqual(flags.for_media(["--spp", "4"]), ["--spp", "4", "--glass-shadows", "straight"])
        self.assertEqual(flags.for_media(["--glass-shadows", "refract"]), ["--glass-shadows", "refract"])

    def test_bounces_are_events_less_one(self):
        taken = flags.from_cycles(dict(samples=7, use_denoising=True, max_bounces=0, transmission_bounces=2, time_limit=0.0, seed=3))
        self.assertEqual((taken["spp"], taken["max_depth"], taken["max_transmission_depth"], taken["denoiser"]), (7, 1, 3, "oidn"))


class Running(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.picture = os.path.join(folder.name, "a.exr")

    def start(self, *more):
        return run.Run([PROGRAM, "render", str(DATA / "cornell-box.glb"), "-o", self.picture, "--size", "32x32", "--progress", "json", *more])

    def wait(self, started, until):
        ends = time.monotonic() + 60.0
        while started.update() and not until():
            self.assertLess(time.monotonic(), ends)
            time.sleep(0.02)

    def test_a_picture(self):
        started = self.start("--spp", "4")
        self.wait(started, lambda: False)
        self.assertIsNone(started.failure())
        self.assertEqual(started.progress["spp_done"], 4)

    def test_a_snapshot_and_a_stop_leave_pictures(self):
        started = self.start("--spp", "1000000")
        self.wait(started, lambda: started.progress.get("spp_done", 0) > 0)
        started.ask_for_snapshot()
        self.wait(started, lambda: run.when_written(self.picture))
        os.remove(self.picture)
        started.stop()
        self.assertIsNone(started.failure())
        self.assertIsNotNone(run.when_written(self.picture))

    def test_failures_are_one_line(self):
        wrong = self.start("--no-such-flag")
        self.wait(wrong, lambda: False)
        self.assertIn("--no-such-flag", wrong.failure())
        killed = self.start("--spp", "1000000")
        self.wait(killed, lambda: killed.progress)
        killed._child.send_signal(signal.SIGKILL)
        self.wait(killed, lambda: False)
        self.assertIn("signal 9", killed.failure())

    def test_frames_are_counted(self):
        self.picture = self.picture.replace("a.exr", "f-{frame}.exr")
        started = self.start("--spp", "1", "--turntable", "3")
        self.wait(started, lambda: False)
        self.assertEqual(len(started.frames_done), 3)


class Notes(unittest.TestCase):
    def test_each_is_named_once(self):
        notes = report.Notes()
        for _ in range(2):
            notes.add("object 'a'", "hair")
        notes.add("object 'b'", "hair")
        self.assertEqual(len(notes.lines), 2)


if __name__ == "__main__":
    main()
