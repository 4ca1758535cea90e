"""blender_sheet.py FOLDER FILE.jpg: the pictures that `scripts/check/blender -o FOLDER` has left, in a Python that has bpy: those of
Cycles above those of Gatelight."""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(HERE.parents[1] / "apps" / "blender"))
sys.path.insert(0, str(HERE))

import blender_scenes  # noqa: E402
import blender_session  # noqa: E402
import bpy  # noqa: E402
import exr  # noqa: E402  the extension's own reader
import numpy  # noqa: E402

COLUMNS, GAP = 5, 4


def combined(folder, name, engine):
    """A square picture; of a panorama, its middle."""
    layers = exr.read(folder / blender_session.file_name(name, engine)).layers
    pixels = next(value for key, value in layers.items() if key.endswith("Combined"))[..., :3]
    start = (pixels.shape[1] - pixels.shape[0]) // 2
    return pixels[:, start:start + pixels.shape[0]]


def sheet(folder):
    names = [row[0] for row in blender_scenes.SCENES]
    pairs = [numpy.concatenate([combined(folder, name, engine) for engine in ("CYCLES", "GATELIGHT")]) for name in names]
    height, width, _ = pairs[0].shape
    rows = -(-len(pairs) // COLUMNS)
    made = numpy.ones((rows * (height + GAP) - GAP, COLUMNS * (width + GAP) - GAP, 3), numpy.float32)
    for index, pair in enumerate(pairs):
        y, x = index // COLUMNS * (height + GAP), index % COLUMNS * (width + GAP)
        made[y:y + height, x:x + width] = pair
    return made


def main():
    folder, path = pathlib.Path(sys.argv[1]), sys.argv[2]
    pixels = sheet(folder)
    height, width, _ = pixels.shape
    image = bpy.data.images.new("sheet", width, height, float_buffer=True)
    image.pixels.foreach_set(numpy.concatenate([pixels[::-1], numpy.ones((height, width, 1), numpy.float32)], axis=-1).reshape(-1))
    scene = bpy.context.scene
    scene.view_settings.view_transform = "AgX"
    scene.render.image_settings.file_format, scene.render.image_settings.quality = "JPEG", 88
    image.save_render(path, scene=scene)
    blender_session.end()


main()
