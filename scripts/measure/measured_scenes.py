"""The scenes that measurements are made with: file (below GATELIGHT_SCENES, or of the project) and flags of 'gatelight render'."""

import os

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SKY = ["--environment", "0.65,0.8,1", "--environment-scale", "2"]
SCENES = {
    "kitchen": ("country-kitchen/country-kitchen.glb", []),
    "bath": ("salle-de-bain/salle-de-bain.glb", []),
    "sponza": ("sponza/sponza.glb", ["--camera", "hall", *SKY]),
    "bistro": ("bistro-exterior/bistro-exterior.glb", SKY),
    "teapot": (os.path.join(ROOT, "data/teapot-stadium.glb"), []),
    "living-room": (os.path.join(ROOT, "data/living-room.glb"), []),
}


def scene_path(name, folder):
    """Of its file; folder: of the large scenes."""
    file = SCENES[name][0]
    return file if os.path.isabs(file) else os.path.join(folder or "", file)
