"""Ice in a glass of water: bodies that overlap. The water reaches into the glass, whose priority is higher; the ice floats in
the water and contains bubbles of air, which are smaller than the ice and need no priority."""

from glb import Glb, glass
from shapes import lathe, merge, quad, rounded_box, sphere

# Radii and heights of the inside of the glass.
INNER, BOTTOM, RIM = 0.40, 0.14, 1.25
SURFACE = 0.98
PIECES = 144


def glassy(glb, name, ior, *absorption):
    return glb.material(name, (1.0, 1.0, 1.0), roughness=0.0, extensions=glass(ior, 0.1, *absorption))


def tumbler():
    return lathe([(0.0, 0.0), (0.42, 0.0), (0.46, 0.03), (0.46, RIM - 0.02), (0.44, RIM), (0.42, RIM), (INNER, RIM - 0.02),
                  (INNER, BOTTOM + 0.05), (INNER - 0.05, BOTTOM), (0.0, BOTTOM)], PIECES)


def water():
    """Water that fills the glass and half of its wall."""
    wall = 0.5 * (INNER + 0.46)
    return lathe([(0.0, BOTTOM - 0.05), (wall - 0.05, BOTTOM - 0.05), (wall, BOTTOM), (wall, SURFACE), (0.0, SURFACE)], PIECES)


def build(path):
    glb = Glb("iced-water")
    of_glass = glassy(glb, "glass", 1.52, (0.75, 0.92, 0.85), 1.5)
    of_water = glassy(glb, "water", 1.333, (0.55, 0.80, 0.85), 1.2)
    of_ice = glassy(glb, "ice", 1.31)
    of_air = glassy(glb, "air", 1.0)
    table = glb.material("table", (0.62, 0.58, 0.52), roughness=0.6)
    wall = glb.material("wall", (0.70, 0.71, 0.74), roughness=0.9)
    straw = glb.material("straw", (0.75, 0.12, 0.10), roughness=0.35)
    lamp = glb.material("lamp", (0.0, 0.0, 0.0), emission=(1.0, 0.95, 0.88), strength=14.0)
    low, size = (-3.0, 0.0, -2.2), (6.0, 3.6, 7.0)
    x, y, z = ((size[0], 0.0, 0.0), (0.0, size[1], 0.0), (0.0, 0.0, size[2]))
    high = [a + b for a, b in zip(low, size)]
    glb.place("table", quad((low[0], 0.0, high[2]), x, [-c for c in z]), table)
    glb.place("room", merge(quad(low, x, y), quad((high[0], 0.0, high[2]), [-c for c in x], y), quad((low[0], 0.0, high[2]), [-c for c in z], y),
                            quad((high[0], 0.0, low[2]), z, y), quad((low[0], high[1], low[2]), x, z)), wall)
    glb.place("lamp", quad((-2.2, 2.6, -1.2), (1.6, 0.4, 0.0), (0.0, 0.3, 1.6)), lamp)
    glb.place("water", water(), of_water, at=(0.0, 0.001, 0.0))
    glb.place("glass", tumbler(), of_glass, at=(0.0, 0.001, 0.0), extras={"dielectric_priority": 1})
    cubes = [((-0.14, 0.90, 0.10), 25, 12), ((0.16, 0.86, -0.12), -20, -16), ((0.05, 0.56, 0.12), 60, 30)]
    for k, (at, turn, tilt) in enumerate(cubes):
        glb.place(f"ice {k}", rounded_box((0.27, 0.24, 0.25), 0.03), of_ice, at=at, turn=turn, tilt=tilt)
        glb.place(f"bubble {k}", sphere(0.035 + 0.01 * k, 24, 12), of_air, at=(at[0] + 0.03, at[1] - 0.02, at[2] + 0.02))
    glb.place("straw", lathe([(0.0, 0.0), (0.03, 0.0), (0.03, 1.55), (0.0, 1.55)], 24), straw, at=(0.16, 0.2, -0.02), tilt=-14)
    glb.camera("camera", (0.0, 1.55, 3.4), (0.02, 0.66, 0.0), 30.0, aspect=None)
    glb.write(path)
