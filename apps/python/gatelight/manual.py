"""The page of help(gatelight.render)."""

import textwrap

_HEAD = """Render a picture of a scene. Returns a Picture.

    picture = gatelight.render("room.glb", size=(960, 540), preset="standard")
    picture = gatelight.render(scene, preset=None, integrator="path", spp=64, camera="hall", environment=(1, 1, 1))

scene     a Scene, or the path of a .gltf or .glb file
size      width and height in pixels
preset    bare, preview, standard, final, paper-nao, paper-nrc; None: the defaults of the options
spp       samples per pixel; None: the number of the preset
progress  called a few times per second with a dict: phase (scout, train, render, denoise), fraction, seconds, spp_done,
          spp, samples, steps_done, steps, loss, error
stop      called as often; if it returns True, rendering stops and the picture so far is returned

Every flag of `gatelight render` is a keyword, with underscores for dashes. A value is a number, a word, True or False, a
tuple ((1, 2, 3) is "1,2,3"), a dict ({"lamp": 2} is "lamp=2"), or the text of the flag. None is the default. Options of
loading (time, variant, lights, ...) apply only to a path; a Scene got them in gatelight.load. Output files are written
too: output="a.exr", stats="a.json". Ctrl-C ends a render with KeyboardInterrupt. A wrong value is a gatelight.Error.

numpy.asarray(picture) is (h, w, 3) float32 radiance without a copy; picture["albedo"] is a layer of aov="albedo";
picture.display() is (h, w, 3) uint8 as a PNG shows it; picture.save("a.png") writes a file.

Common options (gatelight.options() has all):
"""
_NAMED = ("size", "preset", "spp", "progress", "quiet")


def manual(options):
    """The docstring of render, from the table of options."""
    lines = []
    for name, option in options.items():
        if option["common"] and name not in _NAMED:
            lines.append(f"  {name:<18}{textwrap.shorten(option['help'], 98, placeholder=' ...')}")
    return _HEAD + "\n".join(lines) + "\n"
