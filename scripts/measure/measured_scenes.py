"""The table of the scenes that all measurements use."""

import os
from typing import NamedTuple

from script import ROOT, Failed

SKY = (0.65, 0.8, 1.0)
# The brightness of the sky over scenes in the open, for each measurement. A change needs new measurements.
BRIGHTNESS = {"cache": 2.0, "cycles": 1.0}


class Scene(NamedTuple):
    title: str
    file: str  # in the folder of the large scenes, or in the project if it begins with data/
    camera: str | None = None  # None: the first
    open_air: bool = False

    def path(self, folder):
        """`folder` is that of the large scenes."""
        return os.path.join(ROOT if self.file.startswith("data/") else folder or "", self.file)

    def stem(self):
        return os.path.splitext(os.path.basename(self.file))[0]

    def sky(self, measured):
        """Its radiance, or None."""
        return [BRIGHTNESS[measured] * value for value in SKY] if self.open_air else None

    def flags(self, measured):
        """Flags of 'gatelight render'. `measured` is a key of BRIGHTNESS."""
        words = ["--camera", self.camera] if self.camera else []
        if self.open_air:
            words += ["--environment", ",".join(f"{value:g}" for value in SKY), "--environment-scale", f"{BRIGHTNESS[measured]:g}"]
        return words


SCENES = {
    "kitchen": Scene("Country Kitchen", "country-kitchen/country-kitchen.glb"),
    "bath": Scene("Salle de bain", "salle-de-bain/salle-de-bain.glb"),
    "sponza": Scene("Sponza", "sponza/sponza.glb", camera="hall", open_air=True),
    "bistro": Scene("Bistro", "bistro-exterior/bistro-exterior.glb", open_air=True),
    "teapot": Scene("Stadium", "data/teapot-stadium.glb"),
    "living-room": Scene("Living room", "data/living-room.glb"),
}


def add_scenes(parser):
    parser.add_argument("--scenes", default=os.environ.get("GATELIGHT_SCENES"), metavar="DIR",
                        help="folder of the large scenes (default: the environment variable GATELIGHT_SCENES)")


def need_scenes(options):
    if not options.scenes or not os.path.isdir(options.scenes):
        raise Failed("GATELIGHT_SCENES does not name the folder of the large scenes")
