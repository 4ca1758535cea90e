"""The examples run, and leave their plots."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

from support import SOURCE, main


class Examples(unittest.TestCase):
    def test_examples(self):
        for name in ("trade", "field_on_mesh", "light_rig", "animation"):
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                script = SOURCE / "apps/python/examples" / f"{name}.py"
                subprocess.run([sys.executable, script, folder, "--small"], check=True, stdout=subprocess.DEVNULL)
                self.assertGreater(pathlib.Path(folder, f"{name}.png").stat().st_size, 1000)


if __name__ == "__main__":
    main()
