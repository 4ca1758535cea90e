"""Profiles of lights as IES files (LM-63, type C), for falloffs that glTF's spot lights do not have."""

import math

from . import units

STEP = 0.25  # degrees: that of the program's tables


def text_of(falloff, last=90.0):
    """A file of `falloff(radians)`, which is 1 in the brightest direction, from the axis to `last` degrees."""
    count = round(last / STEP) + 1
    angles = [index * STEP for index in range(count)]
    values = [falloff(math.radians(angle)) for angle in angles]
    lines = ["IESNA:LM-63-2002", "TILT=NONE", f"1 -1 1 {count} 1 1 2 0 0 0", "1 1 0",
             " ".join(f"{angle:g}" for angle in angles), "0", " ".join(f"{value:.7g}" for value in values)]
    return "\n".join(lines) + "\n"


def spot(size, blend):
    """The cone of a spot light; both angles are full ones, in radians."""
    last = min(math.ceil(0.5 * math.degrees(size) / STEP) * STEP, 180.0)
    return text_of(lambda angle: units.spot_falloff(angle, size, blend), last)
