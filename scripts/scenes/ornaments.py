"""Small things of the living room, each standing on y = 0 about the origin."""

import math
import random

from shapes import catmull_rom, lathe, merge, rounded_box, sphere, surface, tube


def vessel(outer, thickness, floor, steps=5, segments=56):
    """A closed wall of glass: the profile of its outside from the foot to the rim, and an inside that follows it."""
    curve = catmull_rom(outer, steps)
    inside = [(r - thickness, max(y, curve[0][1] + floor)) for r, y in curve if r > thickness * 1.5]
    rim_r, rim_y = curve[-1]
    rim = [(rim_r - thickness / 2 + thickness / 2 * math.cos(a), rim_y + thickness / 2 * math.sin(a))
           for a in (math.pi * k / 6 for k in range(1, 6))]
    inner = [p for k, p in enumerate(reversed(inside)) if k == 0 or p[1] > curve[0][1] + floor]
    bottom = (inner[-1][0] * 0.96, curve[0][1] + floor)
    return lathe([(0.0, curve[0][1]), *curve, *rim, *inner, bottom, (0.0, bottom[1])], segments, 50)


def carafe():
    return vessel([(0.05, 0.0), (0.062, 0.012), (0.072, 0.05), (0.066, 0.10), (0.038, 0.16), (0.024, 0.20),
                   (0.023, 0.235), (0.033, 0.265)], 0.0035, 0.012)


def carafe_wine():
    """The wine in the carafe, with a small gap to the glass."""
    curve = [(r - 0.0041, y) for r, y in catmull_rom(
        [(0.062, 0.0126), (0.072, 0.05), (0.066, 0.10), (0.0605, 0.112)], 5)]
    return lathe([(0.0, curve[0][1]), *curve, (0.0, curve[-1][1])], 48, 50)


def tumbler():
    return vessel([(0.030, 0.0), (0.033, 0.006), (0.036, 0.05), (0.039, 0.095)], 0.0025, 0.011, 3, 48)


def vase():
    return vessel([(0.055, 0.0), (0.075, 0.02), (0.098, 0.09), (0.085, 0.17), (0.045, 0.235), (0.040, 0.265),
                   (0.062, 0.30)], 0.005, 0.016)


def bowl(radius=0.15, height=0.085):
    """A metal bowl with a thin wall and a foot."""
    return vessel([(0.3 * radius, 0.0), (0.34 * radius, 0.008), (0.62 * radius, 0.02), (0.9 * radius, 0.6 * height),
                   (radius, height)], 0.004, 0.010, 5, 64)


def plant_pot(radius=0.21, height=0.36):
    return lathe(catmull_rom([(0.62 * radius, 0.0), (0.7 * radius, 0.006), (0.98 * radius, 0.55 * height),
                              (radius, 0.88 * height), (0.93 * radius, height), (0.86 * radius, 0.97 * height),
                              (0.84 * radius, 0.85 * height)], 5) + [(0.0, 0.84 * height)], 56, 60)


def book(width, height, depth):
    """A book lying flat, its spine towards +x: the cover, and the pages that stand back in it."""
    cover = merge(
        rounded_box((width, 0.003, depth), 0.0012, 1).moved(0, height - 0.0015, 0),
        rounded_box((width, 0.003, depth), 0.0012, 1).moved(0, 0.0015, 0),
        rounded_box((0.006, height, depth), 0.0025, 2).moved(width / 2 - 0.002, height / 2, 0))
    pages = rounded_box((width - 0.008, height - 0.006, depth - 0.010), 0.0005, 1).moved(-0.002, height / 2, 0)
    return cover, pages


def orange():
    """A fruit: a dented sphere."""
    ball = sphere(0.037, 28, 18)

    def dent(p):
        top = max(0.0, p[1] / 0.037)
        return p[0], p[1] * (0.94 - 0.12 * top ** 12), p[2]

    return ball.map(dent).smooth().moved(0, 0.035, 0)


def cushion(size=0.44, thickness=0.15):
    """A square scatter cushion standing on edge, its corners drawn out."""
    def puff(x, y, z):
        u, v = 2 * x / size, 2 * y / size
        pinch = 1 - 0.075 * (1 - u * u) * (v * v) - 0.075 * (1 - v * v) * (u * u)
        bulge = max(0.0, (1 - u * u) * (1 - v * v)) ** 0.42
        crease = 1 + 0.03 * math.sin(7 * u + 2 * v) * math.sin(5 * v - 3 * u)
        return x * pinch, y * pinch + size / 2, z * (0.10 + 0.90 * bulge) * crease
    mesh = rounded_box((size, size, thickness), 0.012, 1, 18, puff)
    return mesh


def leaf_blade():
    """A leaf from its stalk at the origin along +z, arched and folded along its rib; front is up."""
    def at(u, v):
        side = 2 * u - 1
        return (0.5 * 0.82 * side, 0.10 * math.sin(2.2 * v) + 0.10 * abs(side) ** 1.4 - 0.20 * v * v,
                v - 0.18)
    return surface(6, 8, at).flipped()


def plant_stalks(seed, count, height):
    """Stalks from the pot: their tubes as one mesh, and the end, heading and leaf droop of each."""
    generator = random.Random(seed)
    tubes, tips = [], []
    for k in range(count):
        heading = 2 * math.pi * (k * 0.382 + 0.06 * generator.random())
        rise = height * (0.38 + 0.62 * (k + 0.6 * generator.random()) / count)
        reach = 0.20 + 0.24 * generator.random() * (1.25 - rise / height)
        tip = (reach * math.sin(heading), rise, reach * math.cos(heading))
        root = (0.05 * math.sin(heading + 1.0), 0.0, 0.05 * math.cos(heading + 1.0))
        middle = (0.35 * tip[0] + 0.65 * root[0], 0.62 * tip[1], 0.35 * tip[2] + 0.65 * root[2])
        tubes.append(tube(catmull_rom([root, middle, tip], 5), 0.0065, 6))
        tips.append((tip, math.degrees(heading), 8 + 34 * generator.random(), 0.27 + 0.15 * generator.random()))
    return merge(*tubes), tips


def branches(seed, count=7, height=0.62):
    """Dry branches for a vase: the twigs as one mesh, and where their buds sit."""
    generator = random.Random(seed)
    twigs, buds = [], []
    for k in range(count):
        heading = 2 * math.pi * k / count + 0.6 * generator.random()
        lean, tall = 0.10 + 0.20 * generator.random(), height * (0.75 + 0.5 * generator.random())
        path = catmull_rom([(-0.025 * math.sin(heading), 0.03, -0.025 * math.cos(heading)),
                            (0.02 * math.sin(heading), 0.27, 0.02 * math.cos(heading)),
                            (lean * 0.6 * math.sin(heading + 0.3), 0.66 * tall, lean * 0.6 * math.cos(heading + 0.3)),
                            (lean * 1.2 * math.sin(heading), tall, lean * 1.2 * math.cos(heading))], 6)
        twigs.append(tube(path, [0.0035 - 0.0024 * i / (len(path) - 1) for i in range(len(path))], 5))
        for i in range(8, len(path)):
            for _ in range(2):
                angle = 2 * math.pi * generator.random()
                buds.append((path[i][0] + 0.009 * math.sin(angle), path[i][1] + 0.012 * generator.random(),
                             path[i][2] + 0.009 * math.cos(angle)))
    return merge(*twigs), buds
