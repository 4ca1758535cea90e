"""The teapot in a stadium: an object of centimetres, finely tessellated, in a hall of 200 m of few huge triangles."""

import math

import furniture
from glb import Glb
from shapes import merge, polygon, quad, rounded_box, sphere, upright
from teapot import tessellate

LENGTH, WIDTH, EAVES, RIDGE = 200.0, 84.0, 17.0, 33.0
SKYLIGHT = 9.0
TEAPOT = (-6.0, 1.0, 62.0)
PIECES = 36


def build(path):
    glb = Glb("teapot in a stadium")
    lambert = {"roughness": 1.0}
    paint = {
        "floor": glb.material("polished floor", (0.17, 0.125, 0.085), roughness=0.28),
        "pitch": glb.material("pitch", (0.055, 0.17, 0.060), **lambert),
        "line": glb.material("lines", (0.80, 0.80, 0.78), **lambert),
        "wall": glb.material("wall", (0.55, 0.53, 0.50), **lambert),
        "roof": glb.material("roof", (0.62, 0.62, 0.62), **lambert),
        "terrace": glb.material("terrace", (0.42, 0.40, 0.38), **lambert),
        "seats": glb.material("seats", (0.06, 0.13, 0.30), roughness=0.5),
        "steel": glb.material("steel", (0.56, 0.57, 0.58), metallic=1.0, roughness=0.35),
        "stone": glb.material("stone", (0.72, 0.69, 0.64), roughness=0.35),
        "glaze": glb.material("persimmon glaze", (0.56, 0.085, 0.022), roughness=0.45, double_sided=True, extensions={
            "clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.03}}),
        "skylight": glb.material("skylight", (0.0, 0.0, 0.0), emission=(0.80, 0.91, 1.0), strength=3.2),
        "lamp": glb.material("lamp", (0.8, 0.8, 0.8), emission=(1.0, 0.72, 0.42), strength=60.0),
    }
    hall(glb, paint)
    stands(glb, paint)
    lamps(glb, paint)

    x, y, z = TEAPOT
    glb.place("teapot", tessellate(PIECES, 0.148), paint["glaze"], at=(x, y, z), turn=24)
    glb.place("pedestal", furniture.fluted_drum(0.145, 0.90, 24), paint["stone"], at=(x, 0.06, z))
    plinth = glb.mesh("plinth", (rounded_box((0.36, 0.06, 0.36), 0.008, 3), paint["stone"]))
    glb.node("base", plinth, at=(x, 0.03, z))
    glb.node("top", plinth, at=(x, 0.97, z))
    glb.camera("teapot", (x + 0.14, y + 0.165, z + 0.62), (x + 0.060, y + 0.088, z), 36.0)
    glb.camera("hall", (30.0, 9.5, 92.0), (-8.0, 5.0, 0.0), 52.0)
    glb.write(path)


def hall(glb, paint):
    """Floor, walls and a pitched roof with a long skylight: 30 triangles for 200 m."""
    w, l, s = WIDTH / 2, LENGTH / 2, SKYLIGHT / 2
    sill = RIDGE - (RIDGE - EAVES) * s / w
    glb.place("floor", quad((-w, 0, l), (WIDTH, 0, 0), (0, 0, -LENGTH)), paint["floor"])
    glb.place("pitch", quad((-26, 0.004, 50), (52, 0, 0), (0, 0, -140)), paint["pitch"])
    walls = merge(
        polygon((-w, 0, l), (-w, 0, -l), (-w, EAVES, -l), (-w, EAVES, l)),
        polygon((w, 0, -l), (w, 0, l), (w, EAVES, l), (w, EAVES, -l)),
        polygon((-w, 0, -l), (w, 0, -l), (w, EAVES, -l), (s, sill, -l), (-s, sill, -l), (-w, EAVES, -l)),
        polygon((w, 0, l), (-w, 0, l), (-w, EAVES, l), (-s, sill, l), (s, sill, l), (w, EAVES, l)))
    glb.place("walls", walls, paint["wall"])
    glb.place("roof", merge(
        polygon((-w, EAVES, l), (-w, EAVES, -l), (-s, sill, -l), (-s, sill, l)),
        polygon((s, sill, l), (s, sill, -l), (w, EAVES, -l), (w, EAVES, l))), paint["roof"])
    glb.place("skylight", polygon((-s, sill, l), (-s, sill, -l), (s, sill, -l), (s, sill, l)), paint["skylight"])

    lines = []
    for x0, x1, z0, z1 in ((-24, -23.8, -88, 48), (23.8, 24, -88, 48), (-24, 24, -88, -87.8), (-24, 24, 47.8, 48),
                           (-24, 24, -20.1, -19.9), (-10, 10, 36, 36.2), (-10, 10, -76.2, -76)):
        lines.append(polygon((x0, 0.008, z1), (x1, 0.008, z1), (x1, 0.008, z0), (x0, 0.008, z0)))
    glb.place("lines", merge(*lines), paint["line"])
    # Rafters: long thin triangles, one mesh shown in pairs.
    rise = math.degrees(math.atan2(RIDGE - EAVES, w))
    length = math.hypot(w - s, sill - EAVES)
    rafter = glb.mesh("rafter", (rounded_box((length, 0.9, 0.45), 0.02, 1), paint["steel"]))
    half = math.radians(rise) / 2
    for k in range(13):
        for side in (-1, 1):
            glb.node("rafter", rafter, at=(side * (w + s) / 2, (EAVES + sill) / 2 - 0.6, -96 + 16 * k),
                     rotation=[0.0, 0.0, round(-side * math.sin(half), 6), round(math.cos(half), 6)])


def stands(glb, paint):
    """Terraces of eight steps along both sides, with a bench on each: slivers 180 m long."""
    bench = merge(box((0.42, 0.06, 178.0), (0, 0.72, 0)), box((0.05, 0.40, 178.0), (0.23, 0.92, 0)))
    step = glb.mesh("step", (box((1.5, 0.62, 180.0)), paint["terrace"]), (bench, paint["seats"]))
    for row in range(8):
        for side in (-1, 1):
            glb.node("step", step, at=(side * (29.0 + 1.5 * row), 0.62 * row, 0.0), turn=0 if side > 0 else 180)


def box(size, at=(0, 0, 0)):
    """A plain box of 12 triangles whose underside is at `at`."""
    half_x, height, half_z = size[0] / 2, size[1], size[2] / 2
    x, y, z = at
    return upright([(x + sx * half_x, y, z + sz * half_z) for sx, sz in ((-1, 1), (1, 1), (1, -1), (-1, -1))], height)


def lamps(glb, paint):
    """Two rows of glowing spheres on rods."""
    globe = glb.mesh("lamp", (sphere(0.55, 16, 8), paint["lamp"]))
    rod = glb.mesh("lamp rod", (box((0.06, 11.0, 0.06)), paint["steel"]))
    for k in range(9):
        for side in (-1, 1):
            at = (side * 22.0, 12.0, -80.0 + 20.0 * k)
            glb.node("lamp", globe, at=at)
            glb.node("lamp rod", rod, at=(at[0], at[1] + 0.5, at[2]))
