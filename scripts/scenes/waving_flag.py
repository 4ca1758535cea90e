"""A chequered cloth that waves by four morph targets: the sine and the cosine of two waves that run along it."""

import math

from shapes import Mesh, part_of_grid, surface

COLUMNS, ROWS, CHECK = 24, 16, 4
LENGTH, HEIGHT = 0.95, 0.64
# (wavelength, tilt: metres by which the crest lags at the lower edge, amplitude in metres, periods in a second)
WAVES = ((0.70, 0.10, 0.075, 1.0), (0.37, -0.22, 0.020, 1.5))


def at(u, v):
    """The cloth without waves: it hangs a little at its free end."""
    return LENGTH * u, HEIGHT * (v - 1.0) - 0.07 * u * u, 0.0


def crest(target, u, v):
    """Height of a wave above the cloth."""
    wavelength, tilt, amplitude, _ = WAVES[target // 2]
    phase = 2.0 * math.pi * (LENGTH * u + tilt * (1.0 - v)) / wavelength
    grip = u * (1.7 - 0.7 * u)
    return amplitude * grip * (math.cos(phase) if target % 2 else math.sin(phase))


def weights(seconds):
    """The crests run away from the pole: sin(phase - turn) as a sum of the targets."""
    result = []
    for *_, frequency in WAVES:
        turn = 2.0 * math.pi * frequency * seconds
        result += [math.cos(turn), -math.sin(turn)]
    return result


def slope(target, u, v, step=1e-4):
    """What the wave adds to a normal of (0, 0, 1), before it is made one long."""
    def along(du, dv):
        p, q = at(u - du, v - dv), at(u + du, v + dv)
        return [b - a for a, b in zip(p, q)], crest(target, u + du, v + dv) - crest(target, u - du, v - dv)

    (ax, ay, _), a = along(step, 0.0)
    (bx, by, _), b = along(0.0, step)
    area = ax * by - ay * bx
    return -(a * by - ay * b) / area, -(ax * b - a * bx) / area, 0.0


def primitive(glb, material, odd):
    """The checks of one colour, with their targets."""
    whole = surface(COLUMNS, ROWS, at)
    used, triangles = part_of_grid(COLUMNS, ROWS, lambda i, j: (i // CHECK + j // CHECK) % 2 == odd)
    mesh = Mesh([whole.positions[k] for k in used], triangles, [(0.0, 0.0, 1.0)] * len(used))
    places = [(k % (COLUMNS + 1) / COLUMNS, k // (COLUMNS + 1) / ROWS) for k in used]
    targets = []
    for target in range(2 * len(WAVES)):
        crests = [crest(target, u, v) for u, v in places]
        targets.append({
            "POSITION": glb.floats([c for h in crests for c in (0.0, 0.0, h)], "VEC3",
                                   min=[0.0, 0.0, round(min(crests), 6)], max=[0.0, 0.0, round(max(crests), 6)]),
            "NORMAL": glb.floats([c for u, v in places for c in slope(target, u, v)], "VEC3")})
    return {**glb.geometry(mesh, material), "material": material, "targets": targets}


def waving_flag(glb, materials, **where):
    """The node of a cloth that is fixed along x = 0, with its upper corner at the origin; it faces +z."""
    mesh = glb.append("meshes", {
        "name": "flag", "primitives": [primitive(glb, material, odd) for odd, material in enumerate(materials)],
        "weights": [round(w, 6) + 0.0 for w in weights(0.0)],
        "extras": {"targetNames": [f"{kind} of wave {k + 1}" for k in range(len(WAVES)) for kind in ("sine", "cosine")]}})
    return glb.node("flag", mesh, **where)
