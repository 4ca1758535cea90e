"""Subsurface scattering and volumes of Blender as media of glTF: an attenuation and the reflectance of a half space."""

import math

MINIMUM = 1e-4  # metres: a shorter mean free path looks the same


def reflectance_of(albedo, anisotropy=0.0):
    """The diffuse reflectance of a half space by its single-scattering albedo: the inverse of Kulla and Conty 2017, which the
    program uses."""
    low, high = 0.0, 1.0
    for _ in range(40):
        middle = 0.5 * (low + high)
        s = 4.09712 + 4.20863 * middle - math.sqrt(9.59217 + 41.6808 * middle + 17.7126 * middle * middle)
        if (1.0 - s * s) / (1.0 - anisotropy * s * s) < albedo:
            low = middle
        else:
            high = middle
    return high


def attenuation(extinction):
    """attenuationDistance and attenuationColor of three extinction coefficients (per metre)."""
    least = max(min(extinction), 1e-9)
    distance = 1.0 / least
    return {"attenuationDistance": distance, "attenuationColor": [math.exp(-value * distance) for value in extinction]}


def subsurface_paths(color, radius, ior):
    """Mean free paths of Blender's radius, as the random walk of Cycles takes it: shorter where little light is absorbed."""
    inverse = 1.0 / ior
    internal = inverse * (-1.440 * inverse + 0.710) + 0.668 + 0.0636 * ior
    boundary = 4.0 / 3.0 * (1.0 + internal) / (1.0 - internal)
    return [max(r * math.sqrt(3.0 * (1.0 - _reduced_albedo(c, boundary))), MINIMUM) for c, r in zip(color, radius)]


def _reduced_albedo(reflectance, boundary):
    """The reduced albedo of a half space of this reflectance in the dipole model (Jensen and others 2001)."""
    low, high = 0.0, 1.0
    for _ in range(40):
        middle = 0.5 * (low + high)
        root = math.sqrt(3.0 * (1.0 - middle))
        if 0.5 * middle * (1.0 + math.exp(-boundary * root)) * math.exp(-root) < reflectance:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def principled_volume(density, color, absorption):
    """Extinction and single-scattering albedo of Principled Volume, by channel."""
    scattering = [density * max(c, 0.0) for c in color]
    absorbing = [density * max(1.0 - c, 0.0) * max(1.0 - math.sqrt(max(a, 0.0)), 0.0) for c, a in zip(color, absorption)]
    extinction = [s + a for s, a in zip(scattering, absorbing)]
    return extinction, [s / e if e > 0.0 else 0.0 for s, e in zip(scattering, extinction)]
