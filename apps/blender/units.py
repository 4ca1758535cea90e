"""Light in watts as radiance and intensity. Each formula was measured against Cycles: scripts/check/blender prints the ratios."""

import math


def point_intensity(watts):
    """W/sr of a point or spot light; a spot only cuts a cone out of it."""
    return watts / (4.0 * math.pi)


def surface_radiance(watts, area):
    """Radiance of a surface of `area` m2 that emits `watts` evenly to one side."""
    return watts / (math.pi * area)


def sun_radiance(irradiance, angle):
    """Radiance of a disc that is seen under `angle` (radians) and gives this irradiance to a surface that faces it."""
    return irradiance / (math.pi * math.sin(0.5 * angle) ** 2)


def not_normalized(kind, radius, area, angle):
    """What multiplies the strength of a light whose strength is per area (Blender's "Normalize" is off)."""
    if kind == "AREA":
        return area
    if kind == "SUN":
        return math.pi * math.tan(0.5 * angle) ** 2 if angle > 0.0 else 1.0
    return 4.0 * math.pi * radius * radius if radius > 0.0 else 1.0


def spot_falloff(angle, size, blend):
    """The part of a spot's intensity at `angle` from its axis; `size` is the full angle of its cone, both in radians."""
    edge = math.cos(0.5 * size)
    width = (1.0 - edge) * blend
    inside = math.cos(angle) - edge
    if width <= 0.0:
        return 1.0 if inside > 0.0 else 0.0
    t = min(max(inside / width, 0.0), 1.0)
    return t * t * (3.0 - 2.0 * t)


def vertical_fov(lens, sensor_width, sensor_height, sensor_fit, width, height):
    """Radians, for a picture of width x height pixels; lens and sensor in millimetres."""
    if sensor_fit == "VERTICAL":
        return 2.0 * math.atan(0.5 * sensor_height / lens)
    across = sensor_width / lens
    if sensor_fit == "HORIZONTAL" or width >= height:
        across *= height / width
    return 2.0 * math.atan(0.5 * across)


def shifted_frame(width, height, shift_x, shift_y, fit):
    """A camera's shift as a part of a larger picture around the same axis: its size in pixels, and where the picture begins in it
    (x to the right, y down). `fit` is the number of pixels of a shift of 1."""
    right, up = round(shift_x * fit), round(shift_y * fit)
    size = (width + 2 * abs(right), height + 2 * abs(up))
    return size, (abs(right) + right, abs(up) - up)
