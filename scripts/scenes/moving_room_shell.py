"""The room of moving things without them: floor, walls, the corridor behind the back wall, and the table."""

import math

import furniture
import pictures
from shapes import Mesh, lathe, merge, part_of_grid, quad, rounded_box, sphere

LEFT, RIGHT, BACK, FRONT, HEIGHT = -3.0, 3.0, -2.4, 3.4, 2.6
WALL = 0.12  # thickness of the back wall
DOORWAY = (0.35, 1.30, 2.05)  # from x to x, and height
CORRIDOR = (-1.0, 2.6, -4.0, 2.35)  # from x to x, the far z, and height
PIECE = 0.5  # metres, about, of the quads of walls


def cuts(*ends):
    """Positions that divide each stretch between two ends into pieces of equal length."""
    result = [ends[0]]
    for a, b in zip(ends, ends[1:]):
        count = max(1, round(abs(b - a) / PIECE))
        result += [a + (b - a) * k / count for k in range(1, count + 1)]
    return result


def wall(us, vs, place, is_open=None):
    """Quads between positions in u and in v: `place(u, v)` gives the point, u to the right and v up see the front.
    `is_open(u, v)` tells of a quad's middle that it is left out."""
    def keep(i, j):
        return not is_open or not is_open((us[i] + us[i + 1]) / 2, (vs[j] + vs[j + 1]) / 2)

    used, triangles = part_of_grid(len(us) - 1, len(vs) - 1, keep)
    return Mesh([place(us[k % len(us)], vs[k // len(us)]) for k in used], triangles).smooth()


def planks(size=128, count=8):
    """Boards of three tones with dark joints."""
    tones = [(0.60, 0.45, 0.32), (0.70, 0.55, 0.41), (0.50, 0.36, 0.25)]
    grain = pictures.fractal(7, size, size, 4, 64, 2)

    def pixel(x, y):
        board = y * count // size
        across, along = y * count % size, (x + board * size * 3 // 8) % size
        tone = tones[(board * 2 + (x + board * size * 3 // 8) // size) % 3]
        shade = 0.93 + 0.14 * grain[y][x] if across >= count and along >= 2 else 0.45
        return tuple(min(1.0, c * shade) for c in tone)

    return pictures.encode(pictures.picture(size, size, pixel), 64)


def in_doorway(x, y):
    return DOORWAY[0] < x < DOORWAY[1] and y < DOORWAY[2]


def shell(glb, paint):
    across, deep, up = cuts(LEFT, RIGHT), cuts(FRONT, BACK), cuts(0.0, HEIGHT)
    floor = wall(across, deep, lambda x, z: (x, 0.0, z)).planar_uvs("xz", 1 / 1.2)
    glb.place("floor", floor, paint["floor"])
    glb.place("ceiling", wall(across, deep[::-1], lambda x, z: (x, HEIGHT, z)), paint["white"])
    glb.place("back wall", wall(cuts(LEFT, *DOORWAY[:2], RIGHT), cuts(0.0, DOORWAY[2], HEIGHT),
                                lambda x, y: (x, y, BACK), in_doorway), paint["white"])
    glb.place("front wall", wall(across[::-1], up, lambda x, y: (x, y, FRONT)), paint["white"])
    glb.place("left wall", wall(deep, up, lambda z, y: (LEFT, y, z)), paint["red"])
    glb.place("right wall", wall(deep[::-1], up, lambda z, y: (RIGHT, y, z)), paint["blue"])
    glb.place("fill panel", quad((0.9, 1.2, FRONT - 0.01), (-1.8, 0, 0), (0, 0.9, 0)), paint["fill"])
    glb.place("skirting", merge(*(
        rounded_box((b - a, 0.09, 0.016), 0.004, 1).moved((a + b) / 2, 0.045, BACK + 0.008)
        for a, b in ((LEFT, DOORWAY[0] - 0.07), (DOORWAY[1] + 0.07, RIGHT)))), paint["frame"])


def corridor(glb, paint):
    x0, x1, far, height = CORRIDOR
    near = BACK - WALL
    a, b, top = DOORWAY
    across, deep, up = cuts(x0, x1), cuts(near, far), cuts(0.0, height)
    whole = cuts(x0, a, b, x1)
    glb.place("corridor", merge(
        wall(whole[::-1], cuts(0.0, top, height), lambda x, y: (x, y, near), in_doorway),
        wall(across, up, lambda x, y: (x, y, far)),
        wall(deep, up, lambda z, y: (x0, y, z)),
        wall(deep[::-1], up, lambda z, y: (x1, y, z)),
        wall(across, deep[::-1], lambda x, z: (x, height, z))), paint["corridor"])
    floor = wall(cuts(x0, x1), cuts(BACK, far), lambda x, z: (x, 0.0, z)).planar_uvs("xz", 1 / 1.2)
    glb.place("corridor floor", floor, paint["floor"])
    glb.place("ceiling panel", quad((0.1, height - 0.01, -3.55), (1.5, 0, 0), (0, 0, 0.6)), paint["panel"])
    # The sides of the doorway, and stops behind the door that let no light through its gaps.
    deep, up = [near, BACK], cuts(0.0, top)
    stops = [rounded_box((0.024, top, 0.04), 0.002, 1).moved(x, top / 2, BACK - 0.055) for x in (a + 0.011, b - 0.011)]
    stops.append(rounded_box((b - a, 0.024, 0.04), 0.002, 1).moved((a + b) / 2, top - 0.011, BACK - 0.055))
    stops.append(rounded_box((b - a, 0.024, 0.04), 0.002, 1).moved((a + b) / 2, 0.008, BACK - 0.055))
    casing = [rounded_box((0.06, top + 0.06, 0.012), 0.003, 1).moved(x, (top + 0.06) / 2, BACK + 0.006)
              for x in (a - 0.03, b + 0.03)]
    casing.append(rounded_box((b - a, 0.06, 0.012), 0.003, 1).moved((a + b) / 2, top + 0.03, BACK + 0.006))
    glb.place("door frame", merge(
        wall(deep[::-1], up, lambda z, y: (a, y, z)), wall(deep, up, lambda z, y: (b, y, z)),
        wall(cuts(a, b), deep, lambda x, z: (x, top, z)), *stops, *casing), paint["frame"])


def table(glb, paint, at):
    """A round table with a vase, a ball and a box."""
    x, y, z = at
    foot = lathe([(0.0, 0.0), (0.22, 0.0), (0.22, 0.02), (0.035, 0.05), (0.03, 0.42), (0.10, 0.44), (0.0, 0.44)], 40)
    glb.place("table foot", foot, paint["wood"], at=at)
    glb.place("table top", furniture.disc(0.40, 0.03, 0.012, 56), paint["wood"], at=(x, y + 0.455, z))
    top = y + 0.471
    profile = [(0.055 + 0.030 * math.sin(5.2 * k / 10 + 0.2) - 0.012 * k / 10, 0.24 * k / 10) for k in range(11)]
    inner = [(r - 0.006, h) for r, h in reversed(profile[1:])]
    glb.place("vase", lathe([(0.0, 0.0), *profile, *inner, (0.0, 0.03)], 40), paint["blue glaze"],
              at=(x - 0.14, top, z - 0.10))
    glb.place("ball", sphere(0.075, 32, 18), paint["yellow"], at=(x + 0.16, top + 0.075, z - 0.05))
    glb.place("box", rounded_box((0.16, 0.10, 0.12), 0.008, 2), paint["green"], at=(x, top + 0.05, z + 0.17),
              turn=28)
