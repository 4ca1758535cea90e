"""The room itself: floor, walls, window, door, curtains, mouldings, rug and painting."""

import math

import furniture
from shapes import merge, quad, rounded_box, surface, tube

LEFT, RIGHT, BACK, FRONT, HEIGHT = -3.0, 3.0, -2.6, 3.3, 2.75
# (z from, z to, y from, y to)
WINDOW = (-1.60, 0.60, 0.42, 2.38)
DOOR = (1.25, 2.45, 0.03, 2.36)
REVEAL = 0.20
SUN_DIRECTION = (0.62, -0.42, -0.66)


def build_shell(glb, paint):
    width, depth = RIGHT - LEFT, FRONT - BACK
    glb.place("floor", quad((LEFT - REVEAL, 0, FRONT), (width + REVEAL, 0, 0), (0, 0, -depth),
                            ((width + REVEAL) / 0.8, depth / 0.8)), paint["floor"])
    glb.place("ceiling", quad((LEFT, HEIGHT, BACK), (width, 0, 0), (0, 0, depth)), paint["ceiling"])
    glb.place("back wall", quad((LEFT, 0, BACK), (width, 0, 0), (0, HEIGHT, 0), (width / 1.2, HEIGHT / 1.2)),
              paint["teal"])
    glb.place("right wall", quad((RIGHT, 0, BACK), (0, 0, depth), (0, HEIGHT, 0), (depth / 1.2, HEIGHT / 1.2)),
              paint["white wall"])
    glb.place("front wall", quad((RIGHT, 0, FRONT), (-width, 0, 0), (0, HEIGHT, 0), (width / 1.2, HEIGHT / 1.2)),
              paint["white wall"])
    glb.place("left wall", left_wall(), paint["white wall"])
    glb.place("reveals", merge(reveal(WINDOW), reveal(DOOR)), paint["white wood"])
    glb.place("window frame", window_frame(WINDOW, 3, (0.72,)), paint["white wood"])
    glb.place("door frame", window_frame(DOOR, 2, (0.12, 0.42, 0.72)), paint["white wood"])
    z0, z1, y0, y1 = WINDOW
    glb.place("sill", rounded_box((0.30, 0.035, z1 - z0 + 0.12), 0.012, 3)
              .moved(LEFT - 0.04, y0 - 0.017, (z0 + z1) / 2), paint["white wood"])
    glb.place("sky", quad((LEFT - 0.75, y0 - 0.45, z1 + 0.75), (0, 0, z0 - z1 - 1.5), (0, y1 - y0 + 1.30, 0)),
              paint["sky"])
    # A window behind the viewer: the photographer's fill light.
    glb.place("fill", quad((1.5, 0.85, FRONT - 0.01), (-2.8, 0, 0), (0, 1.55, 0)), paint["fill"])
    curtains(glb, paint)
    mouldings(glb, paint)
    rug = rounded_box((2.75, 0.012, 1.83), 0.005, 1)
    rug.uvs = [(p[0] / 2.75 + 0.5, p[2] / 1.83 + 0.5) for p in rug.positions]
    glb.place("rug", rug, paint["rug"], at=(-0.15, 0.0065, 0.10))


def left_wall():
    """The wall with its two openings, facing +x."""
    zs = [BACK, WINDOW[0], WINDOW[1], DOOR[0], DOOR[1], FRONT]
    pieces = []

    def piece(z0, z1, y0, y1):
        pieces.append(quad((LEFT, y0, z1), (0, 0, z0 - z1), (0, y1 - y0, 0), ((z1 - z0) / 1.2, (y1 - y0) / 1.2)))

    for k in range(5):
        opening = {1: WINDOW, 3: DOOR}.get(k)
        if opening is None:
            piece(zs[k], zs[k + 1], 0.0, HEIGHT)
        else:
            piece(zs[k], zs[k + 1], 0.0, opening[2])
            piece(zs[k], zs[k + 1], opening[3], HEIGHT)
    return merge(*pieces)


def reveal(opening):
    """The four sides of an opening in the thickness of the wall, facing inwards."""
    z0, z1, y0, y1 = opening
    x = LEFT - REVEAL
    return merge(
        quad((x, y0, z1), (REVEAL, 0, 0), (0, 0, z0 - z1)), quad((x, y1, z0), (REVEAL, 0, 0), (0, 0, z1 - z0)),
        quad((x, y0, z0), (REVEAL, 0, 0), (0, y1 - y0, 0)), quad((LEFT, y0, z1), (-REVEAL, 0, 0), (0, y1 - y0, 0)))


def window_frame(opening, panes, bars):
    """A sash with upright bars between `panes` and level bars at parts of its height."""
    z0, z1, y0, y1 = opening
    x = LEFT - REVEAL + 0.05
    parts = []

    def bar(za, zb, ya, yb):
        parts.append(rounded_box((0.05, yb - ya, zb - za), 0.009, 2).moved(x, (ya + yb) / 2, (za + zb) / 2))

    bar(z0, z1, y0, y0 + 0.06)
    bar(z0, z1, y1 - 0.06, y1)
    for k in range(panes + 1):
        z = z0 + (z1 - z0) * k / panes
        thick = 0.055 if k in (0, panes) else 0.04
        bar(max(z0, z - thick), min(z1, z + thick), y0, y1)
    for part in bars:
        y = y0 + (y1 - y0) * part
        bar(z0, z1, y - 0.018, y + 0.018)
    return merge(*parts)


def curtains(glb, paint):
    z0, z1, _, y1 = WINDOW
    drape = glb.mesh("drape", (furniture.drape(0.46, y1 + 0.12, 5, 0.055), paint["drape"]))
    net = furniture.drape(0.62, y1 + 0.12, 6, 0.026, 8, 4)
    net.uvs = [(u * 6, v * 10) for u, v in net.uvs]
    lace = glb.mesh("lace curtain", (net, paint["lace"]))
    for name, mesh, z, x in (("drape", drape, z0 - 0.17, 0.11), ("drape", drape, z1 + 0.17, 0.11),
                             ("lace curtain", lace, z0 + 0.22, 0.035), ("lace curtain", lace, z1 - 0.20, 0.035)):
        glb.node(name, mesh, at=(LEFT + x, 0.012, z), turn=90)
    rod = tube([(LEFT + 0.11, y1 + 0.15, z0 - 0.5), (LEFT + 0.11, y1 + 0.15, z1 + 0.5)], 0.013, 16)
    glb.place("curtain rod", rod, paint["satin brass"])


def mouldings(glb, paint):
    """Skirting and cornice on the walls in view, panels and the painting on the back wall."""
    width = RIGHT - LEFT

    def skirting(length):
        return rounded_box((length, 0.13, 0.02), 0.007, 2).moved(0, 0.065, 0.01)

    glb.place("skirting", skirting(width), paint["teal wood"], at=(0, 0, BACK))
    glb.place("skirting", skirting(FRONT - BACK), paint["white wood"], at=(RIGHT, 0, (BACK + FRONT) / 2), turn=-90)
    long = DOOR[0] - BACK
    glb.place("skirting", skirting(long), paint["white wood"], at=(LEFT, 0, BACK + long / 2), turn=90)

    def cove(length):
        # A quarter round from the wall to the ceiling.
        return surface(1, 8, lambda u, v: (length * (u - 0.5), HEIGHT - 0.10 * (1 - math.sin(math.pi / 2 * v)),
                                           0.10 * (1 - math.cos(math.pi / 2 * v))))

    for name, length, at, turn in (("cornice", width, (0, 0, BACK), 0),
                                   ("cornice", FRONT - BACK, (RIGHT, 0, (BACK + FRONT) / 2), -90),
                                   ("cornice", FRONT - BACK, (LEFT, 0, (BACK + FRONT) / 2), 90)):
        glb.place(name, cove(length), paint["ceiling"], at=at, turn=turn)

    panel = glb.mesh("panel", (furniture.picture_frame(1.62, 1.86, 0.035, 0.018), paint["teal wood"]))
    for x in (-2.0, 0.0, 2.0):
        glb.node("panel", panel, at=(x - 0.0, 1.42, BACK))
    glb.place("painting", quad((-0.52, -0.36, 0.012), (1.04, 0, 0), (0, 0.72, 0)), paint["painting"],
              at=(0.0, 1.68, BACK))
    glb.place("picture frame", furniture.picture_frame(1.04, 0.72, 0.05, 0.04), paint["gold"], at=(0.0, 1.68, BACK))
