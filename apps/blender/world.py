"""The world as the program's environment, sky and fog."""

import math
import os

import numpy

from . import exr, materials

ROTATION = -90.0  # between the first meridian of Blender's pictures and the program's
# Radiance of a horizontal surface below Blender's sky over that below the program's, by the sun's elevation in degrees, measured.
ELEVATIONS = (1.0, 3.0, 6.0, 10.0, 15.0, 25.0, 35.0, 50.0, 70.0, 90.0)
SINGLE_SCATTERING = (42.0, 49.3, 53.6, 50.6, 46.0, 41.1, 38.9, 37.5, 36.8, 36.9)
MULTIPLE_SCATTERING = (54.2, 59.8, 62.3, 58.1, 52.5, 46.7, 44.4, 42.8, 42.1, 42.0)  # since 5.0
# Skies without a sun: their mean radiance with the sun at 35 degrees, measured.
ONE_COLOR = {"PREETHAM": (0.317, 0.457, 0.809), "HOSEK_WILKIE": (0.0392, 0.0659, 0.112)}


def flags_of(world, folder, notes):
    if world is None:
        return ["--environment", "none"]
    if not world.use_nodes:
        return ["--environment", _numbers(world.color)]
    background = _background(world, notes)
    if background is None:
        return ["--environment", "none"] + _fog(world, notes)
    strength, color = _value(background, "Strength", world, notes), background.inputs["Color"]
    if not color.is_linked:
        return ["--environment", _numbers([strength * c for c in color.default_value[:3]])] + _fog(world, notes)
    source = color.links[0].from_node
    if source.type == "TEX_ENVIRONMENT" and source.image:
        flags = _picture(source, strength, world, folder, notes)
    elif source.type == "TEX_SKY":
        flags = _sky(source, strength, world, notes)
    else:
        notes.add(f"world '{world.name}'", f"the node '{source.name}' behind its colour; the world is black")
        flags = ["--environment", "none"]
    return flags + _fog(world, notes)


def _numbers(values):
    return ",".join(f"{value:.9g}" for value in values) if max(values) > 0.0 else "none"


def _background(world, notes):
    """The Background node, or nothing."""
    node = materials.at_output(world, "Surface")
    if node is not None and node.type != "BACKGROUND":
        notes.add(f"world '{world.name}'", f"the node '{node.name}' at its output; the first Background is taken")
        node = next((n for n in world.node_tree.nodes if n.type == "BACKGROUND"), None)
    return node


def _value(node, name, world, notes):
    socket = node.inputs[name]
    if socket.is_linked:
        notes.add(f"world '{world.name}'", f"the node behind {name}; its plain value is taken")
    return socket.default_value


def _turn(texture, world, notes):
    """The rotation about the vertical axis, in degrees."""
    vector = texture.inputs["Vector"]
    if not vector.is_linked:
        return 0.0
    node = vector.links[0].from_node
    if node.type == "TEX_COORD":
        return 0.0
    if node.type != "MAPPING":
        notes.add(f"world '{world.name}'", f"the node '{node.name}' behind the picture's vector")
        return 0.0
    x, y, z = node.inputs["Rotation"].default_value
    others = [*node.inputs["Location"].default_value, *(s - 1.0 for s in node.inputs["Scale"].default_value), x, y]
    if any(abs(value) > 1e-4 for value in others):
        notes.add(f"world '{world.name}'", "a mapping other than a rotation about z")
    return math.degrees(z)


def _picture(texture, strength, world, folder, notes):
    image = texture.image
    if texture.projection != "EQUIRECTANGULAR":
        notes.add(f"world '{world.name}'", "a mirror ball; it is taken as latitude-longitude")
    path = os.path.join(folder, "world.exr")
    width, height = image.size
    if not width or not height:
        notes.add(f"world '{world.name}'", f"the picture '{image.name}', which cannot be read; the world is black")
        return ["--environment", "none"]
    pixels = numpy.empty(width * height * image.channels, numpy.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, image.channels)[::-1, :, :3]
    if image.colorspace_settings.name == "sRGB" and not image.is_float:
        pixels = numpy.where(pixels <= 0.04045, pixels / 12.92, ((pixels + 0.055) / 1.055) ** 2.4)
    exr.write(path, numpy.broadcast_to(pixels, (height, width, 3)))
    turn = (ROTATION - _turn(texture, world, notes)) % 360.0
    return ["--environment", path, "--environment-rotation", f"{turn:.6g}", "--environment-scale", f"{strength:.9g}"]


def _sky(sky, strength, world, notes):
    what = f"world '{world.name}'"
    if sky.sky_type in ONE_COLOR:
        notes.add(what, f"the sky of the kind {sky.sky_type}, which has no sun; it has one colour")
        return ["--environment", _numbers([strength * c for c in ONE_COLOR[sky.sky_type]])]
    elevation, azimuth = math.degrees(sky.sun_elevation), math.degrees(sky.sun_rotation)
    notes.add(what, "Blender's sky; it is the program's clear sky of the same brightness, with other colours")
    if not sky.sun_disc:
        notes.add(what, "a sky without its sun; it has a sun")
    if elevation < 0.0:
        notes.add(what, "a sun below the horizon; it stands at the horizon")
    elevation, size = max(elevation, 0.0), max(math.degrees(sky.sun_size), 0.1)
    scales = MULTIPLE_SCATTERING if sky.sky_type == "MULTIPLE_SCATTERING" else SINGLE_SCATTERING
    scale = strength * float(numpy.interp(elevation, ELEVATIONS, scales))
    return ["--sky", f"sun={azimuth % 360.0:.6g},{elevation:.6g}, size={size:.4g}, intensity={scale:.6g}, ground=0"]


def has_volume(world):
    return world is not None and materials.at_output(world, "Volume") is not None


def _fog(world, notes):
    node = materials.at_output(world, "Volume")
    if node is None:
        return []
    medium = materials.medium_of(node, f"world '{world.name}'", notes)
    if medium is None:
        return []
    extinction, albedo, anisotropy = medium
    density = max(extinction)
    if density <= 0.0:
        return []
    if max(extinction) - min(extinction) > 1e-3 * density:
        notes.add(f"world '{world.name}'", "fog whose density depends on colour; its mean is taken")
        density = sum(extinction) / 3.0
    return ["--fog", f"{density:.9g},{','.join(f'{a:.6g}' for a in albedo)},{min(max(anisotropy, -0.99), 0.99):.4g}"]
