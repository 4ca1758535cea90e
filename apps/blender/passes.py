"""Passes by Blender's names, from layers of the program's EXR."""

import numpy

NOTHING = 1e10  # Blender's depth of the background
LONG_NAMES = (5, 0, 0)  # the version of Blender from which on names are written out


class Pass:
    """A pass of Blender: its channels, the property of the view layer that asks for it, and the layers that it is made of."""

    def __init__(self, name, channels, kind, asked, layers, make=lambda *layers: layers[0], long_name=None):
        self.name, self.long_name = name, long_name or name
        self.channels, self.kind, self.asked, self.layers, self.make = channels, kind, asked, layers, make

    def name_in(self, version):
        return self.long_name if version >= LONG_NAMES else self.name


def _z_up(layer):
    return numpy.stack([layer[..., 0], -layer[..., 2], layer[..., 1]], axis=-1)


def _depth(layer):
    return numpy.where(numpy.isfinite(layer) & (layer > 0.0), layer, NOTHING)


def _vector(before, after):
    """Where the surface was and from where it goes on, as Cycles writes it."""
    return numpy.concatenate([-before, -after], axis=-1)


def _white(layer):
    return numpy.ones_like(layer)


def _with_alpha(layer):
    return layer if layer.shape[-1] == 4 else numpy.concatenate([layer, numpy.ones_like(layer[..., :1])], axis=-1)


def _light(name, kind, layer):
    """The passes of one kind of reflection. The colours of surfaces are in the light already, so Blender's colour is white."""
    title = kind.title()
    return [Pass(name + "Dir", "RGB", "COLOR", f"use_pass_{kind}_direct", [f"{layer}-direct"], long_name=f"{title} Direct"),
            Pass(name + "Ind", "RGB", "COLOR", f"use_pass_{kind}_indirect", [f"{layer}-indirect"], long_name=f"{title} Indirect"),
            Pass(name + "Col", "RGB", "COLOR", f"use_pass_{kind}_color", [f"{layer}-direct"], _white, f"{title} Color")]


COMBINED = Pass("Combined", "RGBA", "COLOR", "use_pass_combined", [""], _with_alpha)
PASSES = [
    Pass("Depth", "Z", "VALUE", "use_pass_z", ["depth"], _depth),
    Pass("Position", "XYZ", "VECTOR", "use_pass_position", ["position"], _z_up),
    Pass("Normal", "XYZ", "VECTOR", "use_pass_normal", ["normal"], _z_up),
    Pass("Vector", "XYZW", "VECTOR", "use_pass_vector", ["motion", "motion-next"], _vector),
    *_light("Diff", "diffuse", "diffuse"), *_light("Gloss", "glossy", "glossy"), *_light("Trans", "transmission", "transmission"),
    Pass("VolumeDir", "RGB", "COLOR", "use_pass_volume_direct", ["volume-direct"], long_name="Volume Direct"),
    Pass("VolumeInd", "RGB", "COLOR", "use_pass_volume_indirect", ["volume-indirect"], long_name="Volume Indirect"),
    Pass("Emit", "RGB", "COLOR", "use_pass_emit", ["emission"], long_name="Emission"),
    Pass("Env", "RGB", "COLOR", "use_pass_environment", ["background"], long_name="Environment"),
    Pass("Noisy Image", "RGBA", "COLOR", "denoising_store_passes", ["denoising-color"], _with_alpha),
    Pass("Denoising Normal", "XYZ", "VECTOR", "denoising_store_passes", ["denoising-normal"], _z_up),
    Pass("Denoising Albedo", "RGB", "COLOR", "denoising_store_passes", ["denoising-albedo"]),
    Pass("Denoising Depth", "Z", "VALUE", "denoising_store_passes", ["depth"], _depth),
]
# What Blender asks for and the program does not have.
MISSING = {"use_pass_mist": "Mist", "use_pass_uv": "UV", "use_pass_object_index": "IndexOB", "use_pass_material_index": "IndexMA",
           "use_pass_shadow": "Shadow", "use_pass_ambient_occlusion": "AO", "use_pass_cryptomatte_asset": "CryptoAsset"}
DENOISING = ("denoising-color", "denoising-normal", "denoising-albedo")


def asked(view_layer):
    """The passes that the view layer asks for; some of its switches are in Cycles' part of it."""
    cycles = getattr(view_layer, "cycles", None)
    return [p for p in PASSES if getattr(view_layer, p.asked, False) or getattr(cycles, p.asked, False)]


def masks(view_layer):
    """Kinds of Cryptomatte, and the number of their passes."""
    kinds = [kind for kind in ("object", "material") if getattr(view_layer, f"use_pass_cryptomatte_{kind}", False)]
    return kinds, min((view_layer.pass_cryptomatte_depth + 1) // 2, 3)


def mask_passes(view_layer):
    kinds, levels = masks(view_layer)
    return [Pass(f"Crypto{kind.title()}{level:02d}", "rgba", "COLOR", None, [f"Crypto{kind.title()}{level:02d}"])
            for kind in kinds for level in range(levels)]


def flags(view_layer):
    """--aov and --cryptomatte for the view layer."""
    layers = {layer for p in asked(view_layer) for layer in p.layers}
    if layers.intersection(DENOISING):
        layers = layers.difference(DENOISING) | {"denoising"}
    kinds, _ = masks(view_layer)
    return (["--aov", ",".join(sorted(layers))] if layers else []) + (["--cryptomatte", ",".join(kinds)] if kinds else [])


def complain(view_layer, notes):
    for name, title in MISSING.items():
        if getattr(view_layer, name, False):
            notes.add(f"pass {title}", "not available")
    if len(view_layer.aovs):
        notes.add("shader AOVs", "not available")


def pixels_of(made, picture):
    """The values of a pass, rows from the bottom as Blender has them; None if the picture lacks its layers."""
    if any(layer not in picture.layers for layer in made.layers):
        return None
    pixels = made.make(*(picture.layers[layer] for layer in made.layers))
    return numpy.ascontiguousarray(pixels[::-1, :, :len(made.channels)], numpy.float32)


def flatten_depth(picture, lens):
    """Depth along the view, as Blender has it, instead of the distance from the camera."""
    layer = picture.layers.get("depth")
    if layer is None or lens.slope == 0.0:
        return
    height, width = layer.shape[:2]
    x = (picture.corner[0] + numpy.arange(width) + 0.5 - 0.5 * lens.size[0]) * lens.slope
    y = (picture.corner[1] + numpy.arange(height) + 0.5 - 0.5 * lens.size[1]) * lens.slope
    picture.layers["depth"] = layer / numpy.sqrt(1.0 + x[None, :, None] ** 2 + y[:, None, None] ** 2)
