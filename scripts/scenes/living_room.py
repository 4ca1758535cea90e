"""A living room late in the afternoon: the cold light of a window, low sun through a door behind the viewer's left,
and warm lamps."""

import furniture
import ornaments
from glb import Glb
from living_room_materials import materials
from living_room_shell import SUN_DIRECTION, build_shell
from shapes import sphere


def build(path):
    glb = Glb("living room")
    paint = materials(glb)
    build_shell(glb, paint)
    sideboard(glb, paint, (-0.15, 0.0, -2.34))
    armchairs(glb, paint, [((-1.62, 0.0, -0.75), 52.0), ((1.70, 0.0, -0.95), -46.0)])
    coffee_table(glb, paint, (0.50, 0.0, 0.50))
    lantern(glb, paint, (1.36, 0.0, -2.15))
    plant(glb, paint, (-2.30, 0.0, -1.98))
    glb.light("sun", "directional", (1.0, 0.76, 0.50), 9.0, (0.0, 0.0, 0.0), SUN_DIRECTION)
    glb.camera("camera", (2.05, 1.22, 2.85), (-0.36, 0.97, -1.0), 37.0)
    glb.write(path)


def sideboard(glb, paint, at):
    """A sideboard of black lacquer on brass legs, and the things on it."""
    x, y, z = at
    glb.place("sideboard", furniture.sideboard_body(), paint["lacquer"], at=at)
    doors = glb.mesh("sideboard door", (furniture.sideboard_door(0.605, 0.53), paint["lacquer"]))
    knobs = glb.mesh("knob", (furniture.knob(), paint["brass"]))
    for k in (-1, 0, 1):
        glb.node("sideboard door", doors, at=(x + 0.62 * k, y + 0.49, z + 0.232))
        glb.node("knob", knobs, at=(x + 0.62 * k + (0.26 if k < 1 else -0.26), y + 0.52, z + 0.243))
    legs = glb.mesh("sideboard leg", (furniture.tapered_leg(0.21, 0.018, 0.011), paint["satin brass"]))
    for dx in (-0.86, 0.86):
        for dz in (-0.17, 0.17):
            glb.node("sideboard leg", legs, at=(x + dx, y, z + dz))

    top = y + 0.781
    table_lamp(glb, paint, (x - 0.66, top, z))
    glb.place("vase", ornaments.vase(), paint["vase glass"], at=(x + 0.60, top, z - 0.02))
    twigs, buds = ornaments.branches(3)
    glb.place("branches", twigs, paint["twig"], at=(x + 0.60, top, z - 0.02))
    bud = glb.mesh("bud", (sphere(0.0068, 8, 6), paint["bud"]))
    for bx, by, bz in buds:
        glb.node("bud", bud, at=(x + 0.60 + bx, top + by, z - 0.02 + bz), scale=(1.0, 1.5, 1.0))
    glb.place("gold bowl", ornaments.bowl(0.13, 0.075), paint["gold"], at=(x + 0.16, top, z + 0.06))
    books = book_shapes(glb, paint, 0.16, 0.026, 0.23)
    for k, (cloth, turn) in enumerate((("cloth blue", 4), ("cloth cream", -7), ("cloth red", 11))):
        glb.node("book", books[cloth], at=(x - 0.24, top + 0.027 * k, z + 0.02), turn=turn)
    glb.place("lacquer ball", sphere(0.052, 40, 24), paint["red lacquer"],
              at=(x - 0.24, top + 0.081 + 0.052, z + 0.02))


def table_lamp(glb, paint, at):
    x, y, z = at
    glb.place("lamp", furniture.table_lamp_base(), paint["brass"], at=at)
    glb.place("lampshade", furniture.shade(), paint["shade"], at=(x, y + 0.36, z))
    rims = glb.mesh("lampshade rim", (furniture.ring(1.0, 0.02), paint["satin brass"]))
    glb.node("lower rim", rims, at=(x, y + 0.36, z), scale=0.165)
    glb.node("upper rim", rims, at=(x, y + 0.57, z), scale=0.105)
    glb.place("bulb", sphere(0.045, 20, 12), paint["bulb"], at=(x, y + 0.455, z))


def book_shapes(glb, paint, width, height, depth):
    """Books of one shape in four colours."""
    cover, pages = ornaments.book(width, height, depth)
    return {cloth: glb.mesh(f"book, {cloth}", (cover, paint[cloth]), (pages, paint["paper"]))
            for cloth in ("cloth red", "cloth blue", "cloth green", "cloth cream")}


def armchairs(glb, paint, places):
    shell = glb.mesh("armchair shell", (furniture.tub_chair_shell(), paint["ochre velvet"]))
    seat = glb.mesh("armchair seat", (furniture.seat_cushion(), paint["ochre velvet"]))
    base = glb.mesh("armchair base", (furniture.chair_base(), paint["ochre velvet"]))
    legs = glb.mesh("armchair legs", (furniture.splayed_legs(0.14, 0.21, 10), paint["satin brass"]))
    for k, (at, turn) in enumerate(places):
        parts = [glb.node(name, mesh, root=False)
                 for name, mesh in (("shell", shell), ("seat", seat), ("base", base), ("legs", legs))]
        if k == 0:
            cushion = glb.mesh("cushion", (ornaments.cushion(0.40, 0.14), paint["rust velvet"]))
            parts.append(glb.node("cushion", cushion, at=(0.05, 0.45, -0.16), tilt=-22, turn=8, root=False))
        glb.node(f"armchair {k + 1}", at=at, turn=turn, children=parts)


def coffee_table(glb, paint, at):
    x, y, z = at
    top = furniture.disc(0.46, 0.032, 0.014).planar_uvs("xz", 0.9)
    glb.place("coffee table", top, paint["marble"], at=(x, y + 0.37, z))
    glb.place("coffee table drum", furniture.fluted_drum(0.27, 0.36), paint["walnut"], at=(x, y + 0.01, z))
    glb.place("coffee table foot", furniture.ring(0.272, 0.012), paint["satin brass"], at=(x, y + 0.02, z))
    y += 0.4025
    glb.place("carafe", ornaments.carafe(), paint["glass"], at=(x + 0.13, y, z + 0.14))
    glb.place("cordial", ornaments.carafe_wine(), paint["wine"], at=(x + 0.13, y, z + 0.14))
    tumblers = glb.mesh("tumbler", (ornaments.tumbler(), paint["glass"]))
    glb.node("tumbler", tumblers, at=(x + 0.28, y, z + 0.03))
    glb.node("tumbler", tumblers, at=(x + 0.22, y, z - 0.12))
    glb.place("copper bowl", ornaments.bowl(0.125, 0.075), paint["copper"], at=(x - 0.12, y, z - 0.10))
    oranges = glb.mesh("orange", (ornaments.orange(), paint["orange"]))
    for k, (dx, dy, dz) in enumerate(((-0.040, 0.032, -0.03), (0.042, 0.032, -0.022), (0.0, 0.032, 0.046),
                                      (0.003, 0.088, 0.0))):
        glb.node("orange", oranges, at=(x - 0.12 + dx, y + dy, z - 0.10 + dz), turn=70 * k, tilt=25 * k)
    books = book_shapes(glb, paint, 0.19, 0.022, 0.26)
    glb.node("book", books["cloth green"], at=(x - 0.16, y, z + 0.17), turn=28)
    glb.node("book", books["cloth cream"], at=(x - 0.15, y + 0.0225, z + 0.17), turn=12)


def lantern(glb, paint, at):
    x, y, z = at
    glb.place("lantern tripod", furniture.tripod(0.62), paint["walnut"], at=at)
    glb.place("lantern", furniture.paper_lantern(), paint["lantern"], at=(x, y + 0.60, z))


def plant(glb, paint, at):
    x, y, z = at
    glb.place("pot", ornaments.plant_pot(), paint["glaze"], at=at)
    stalks, tips = ornaments.plant_stalks(8, 15, 1.15)
    glb.place("stalks", stalks, paint["stalk"], at=(x, y + 0.30, z))
    leaf = glb.mesh("leaf", (ornaments.leaf_blade(), paint["leaf"]))
    for (tx, ty, tz), heading, droop, size in tips:
        glb.node("leaf", leaf, at=(x + tx, y + 0.30 + ty, z + tz), turn=heading, tilt=droop, scale=size)
