"""Gatelight, an offline path tracer for glTF scenes with a neural cache on the triangles.

    import gatelight
    picture = gatelight.render("room.glb", size=(960, 540), preset="standard")
    picture.save("room.png")

Start with help(gatelight.render). gatelight.options() describes every option.
"""

import importlib.util
import os
import pathlib

try:
    from . import _gatelight
except ImportError as error:
    if "cannot open shared object file" not in str(error):
        raise
    raise ImportError(
        f"gatelight needs shared libraries of Debian 12 ({error}): install the packages that apps/python/README.md names, "
        "libembree3-3 libtbb12 libopenexr-3-1-30 libopenimageio2.4 libdraco7 libmeshoptimizer2 libfmt9"
    ) from None
from ._gatelight import (
    Cache, Camera, Error, Frames, Instance, Light, Material, Mesh, Picture, Renderer, Scene, Texture, options, read,
)
from ._gatelight import __version__
from .manual import manual as _manual
from .points import Points, sample_points

__all__ = [
    "Cache", "Camera", "Error", "Frames", "Instance", "Light", "Material", "Mesh", "Picture", "Points", "Renderer", "Scene",
    "Texture", "compare", "denoise", "frames", "load", "options", "read", "render", "sample_points",
]

_LOADING = [name for name, option in _gatelight.options().items() if option["loading"]]


def _use_installed_denoiser():
    """Uses Open Image Denoise of the package pyoidn, unless the user names another."""
    if os.environ.get("GATELIGHT_OIDN"):
        return
    found = importlib.util.find_spec("pyoidn")
    for place in (found.submodule_search_locations or ()) if found else ():
        folder = pathlib.Path(place) / "oidn" / "lib"
        if (folder / "libOpenImageDenoise.so.2").exists():
            os.environ["GATELIGHT_OIDN"] = str(folder)


_use_installed_denoiser()


def load(path, **options):
    """Load a .gltf or .glb file. Returns a Scene.

    Options: time (seconds: the moment of its animations), animation, variant, scene_index, show_hidden, backfaces,
    lights, ies, visibility, light_links, missing, allow_external, ignore_required, shutter and fps (motion blur),
    threads. They are those of `gatelight render`; gatelight.options() explains them.
    """
    return _gatelight.load(os.fspath(path), options)


def _split(scene, options):
    """The scene, loaded if it is a path, and the options of rendering."""
    if isinstance(scene, Scene):
        return scene, options
    loading = {name: options.pop(name) for name in _LOADING if options.get(name) is not None}
    for name in ("shutter", "fps", "threads"):
        if options.get(name) is not None and ("time" in loading or name == "threads"):
            loading[name] = options[name]
    return load(scene, **loading), options


def render(scene, size=(960, 540), preset="standard", spp=None, *, progress=None, stop=None, **options):
    scene, options = _split(scene, options)
    renderer = Renderer(scene, size=size, preset=preset, spp=spp, **options)
    return renderer.render(progress=progress, stop=stop)


render.__doc__ = _manual(options())


def frames(scene, size=(960, 540), preset="standard", spp=None, *, progress=None, stop=None, **options):
    """Render the frames of an animation, one after the other. Returns an iterator over Pictures.

    The options are those of render, and frames ("0:47", range(48) or [1, 3, 5]), fps, turntable, shutter. The cache is kept
    from frame to frame. A Scene was loaded with a time (time=0), and with fps and shutter for motion blur.
    """
    if not isinstance(scene, Scene) and options.get("time") is None:
        scene, options = _split(scene, options | {"time": 0.0})
    return Frames(scene, dict(size=size, preset=preset, spp=spp, **options), progress, stop)


def denoise(color, albedo=None, normal=None, **options):
    """Denoise with Open Image Denoise. Returns a Picture.

    color   a Picture (its layers guide the denoiser), a path, or an array (h, w, 3) of linear radiance
    albedo  (h, w, 3), 0 to 1, with normal (h, w, 3), -1 to 1; or both None
    Options: prefilter ("accurate", "none", "fast"), background, filter, filter_width (by which supersampling is scaled),
    oidn, threads, memory_limit.
    """
    return _gatelight.denoise(color, albedo, normal, **options)


def compare(reference, test, metric=("flip", "ssim", "rel_mse"), exposure=0.0, tonemap="none"):
    """Compare a picture with a reference. Returns a dict of numbers.

    Both are Pictures, paths, or arrays (h, w, 3) of linear radiance. Metrics: mse, rel_mse, psnr, mean, max, bias (mean
    of test minus reference), and as a screen shows them with exposure (stops) and tonemap: ssim, flip, hdr_flip.
    """
    return _gatelight.compare(reference, test, metric, exposure, tonemap)
