"""Light inside things: a candle, a glass of milk, a marble pawn and a leaf in front of a lamp. All lengths are metres, because
the mean free paths are those of the materials."""

import math

from glb import Glb, glass
from shapes import catmull_rom, lathe, merge, quad, surface, tube

PIECES = 96


def scattering(colour, path, anisotropy, door, ior=1.5):
    """Extensions of a body that scatters: `path` is the mean free path of each channel, and `colour` its reflectance."""
    distance = max(path)
    return {door: {("transmission" if door == "transmission" else "diffuseTransmission") + "Factor": 1.0}, "ior": {"ior": ior},
            "volume": {"thicknessFactor": 0.01, "attenuationDistance": distance,
                       "attenuationColor": [round(math.exp(-distance / p), 6) for p in path]},
            "volume_scatter": {"multiscatterColorFactor": list(colour), "scatterAnisotropy": anisotropy}}


def candle():
    """With a hollow where the flame has melted the wax."""
    return lathe([(0.0, 0.0), (0.035, 0.0), (0.036, 0.002), (0.036, 0.108), (0.034, 0.112), (0.030, 0.113), (0.022, 0.107),
                  (0.010, 0.104), (0.0, 0.103)], PIECES, 70.0)


def flame():
    return lathe(catmull_rom([(0.0, 0.0), (0.004, 0.003), (0.006, 0.010), (0.004, 0.022), (0.0, 0.034)], 8), 32, 180.0)


def tumbler():
    return lathe([(0.0, 0.0), (0.030, 0.0), (0.032, 0.002), (0.036, 0.118), (0.035, 0.120), (0.034, 0.118), (0.0305, 0.008),
                  (0.028, 0.006), (0.0, 0.006)], PIECES)


def milk():
    """It reaches into the wall of the glass."""
    return lathe([(0.0, 0.005), (0.028, 0.005), (0.031, 0.008), (0.034, 0.085), (0.0, 0.085)], PIECES)


def pawn():
    profile = [(0.0, 0.0), (0.027, 0.0), (0.028, 0.006), (0.024, 0.012), (0.025, 0.018), (0.017, 0.026), (0.011, 0.048),
               (0.010, 0.058), (0.016, 0.062), (0.011, 0.066)]
    head = [(0.018 * math.sin(a), 0.082 - 0.018 * math.cos(a)) for a in (math.pi * (0.22 + 0.78 * k / 24) for k in range(25))]
    return lathe(profile + head[:-1] + [(0.0, 0.100)], PIECES)


def leaf():
    """A sheet with a fold along its middle."""
    def at(u, v):
        width = 0.030 * math.sin(math.pi * v ** 0.8) * (1.0 - 0.15 * v)
        side = 2.0 * u - 1.0
        return side * width, 0.11 * v, 0.010 * abs(side) * math.sin(math.pi * v) + 0.02 * v * v
    return surface(24, 48, at)


def build(path):
    glb = Glb("wax-and-milk")
    wax = glb.material("wax", (1.0, 1.0, 1.0), roughness=0.35,
                       extensions=scattering((0.95, 0.82, 0.62), (0.0030, 0.0019, 0.0009), 0.0, "diffuse_transmission", 1.45))
    drink = glb.material("milk", (1.0, 1.0, 1.0), roughness=0.0,
                         extensions=scattering((0.97, 0.94, 0.86), (0.0020, 0.0014, 0.0009), 0.7, "transmission", 1.35))
    marble = glb.material("marble", (1.0, 1.0, 1.0), roughness=0.15,
                          extensions=scattering((0.83, 0.79, 0.75), (0.0045, 0.0039, 0.0032), 0.0, "diffuse_transmission"))
    green = glb.material("leaf", (0.10, 0.22, 0.04), roughness=0.5, double_sided=True,
                         extensions={"transmission": {"transmissionFactor": 0.75},
                                     "scatter": {"scatterStrengthFactor": 1.0, "multiscatterColorFactor": [0.25, 0.50, 0.07],
                                                 "scatterAnisotropy": 0.4}})
    stem = glb.material("stem", (0.16, 0.22, 0.06), roughness=0.6)
    pot = glb.material("pot", (0.55, 0.30, 0.20), roughness=0.7)
    clear = glb.material("glass", (1.0, 1.0, 1.0), roughness=0.0, extensions=glass(1.5, 0.002))
    fire = glb.material("flame", (0.0, 0.0, 0.0), emission=(1.0, 0.55, 0.18), strength=60.0)
    wick = glb.material("wick", (0.05, 0.04, 0.04), roughness=0.9)
    table = glb.material("table", (0.36, 0.24, 0.15), roughness=0.45)
    wall = glb.material("wall", (0.50, 0.52, 0.55), roughness=0.9)
    lamp = glb.material("lamp", (0.0, 0.0, 0.0), emission=(1.0, 0.96, 0.90), strength=16.0)

    low, size = (-0.8, 0.0, -0.5), (1.6, 1.0, 2.0)
    x, y, z = ((size[0], 0.0, 0.0), (0.0, size[1], 0.0), (0.0, 0.0, size[2]))
    high = [a + b for a, b in zip(low, size)]
    glb.place("table", quad((low[0], 0.0, high[2]), x, [-c for c in z]), table)
    glb.place("room", merge(quad(low, x, y), quad((high[0], 0.0, high[2]), [-c for c in x], y),
                            quad((low[0], 0.0, high[2]), [-c for c in z], y), quad((high[0], 0.0, low[2]), z, y),
                            quad((low[0], high[1], low[2]), x, z)), wall)
    glb.place("lamp", quad((0.15, 0.50, -0.42), (0.30, 0.0, -0.02), (0.0, 0.06, 0.28)), lamp)
    glb.place("candle", candle(), wax, at=(-0.150, 0.0005, 0.0))
    glb.place("wick", tube([(0.0, 0.102, 0.0), (0.001, 0.112, 0.0), (0.003, 0.119, 0.001)], 0.0009), wick, at=(-0.150, 0.0, 0.0))
    glb.place("flame", flame(), fire, at=(-0.147, 0.117, 0.0))
    glb.place("glass", tumbler(), clear, at=(-0.045, 0.0005, 0.02), extras={"dielectric_priority": 1})
    glb.place("milk", milk(), drink, at=(-0.045, 0.0005, 0.02))
    glb.place("pawn", pawn(), marble, at=(0.050, 0.0005, 0.03))
    glb.place("pot", lathe([(0.0, 0.0), (0.022, 0.0), (0.030, 0.05), (0.027, 0.05), (0.024, 0.044), (0.0, 0.044)], PIECES), pot,
              at=(0.150, 0.0005, 0.0))
    glb.place("stem", tube([(0.0, 0.04, 0.0), (0.002, 0.06, 0.0), (0.0, 0.08, 0.0)], 0.0015), stem, at=(0.150, 0.0, 0.0))
    for turn, tilt in ((10.0, 8.0), (130.0, 40.0), (-110.0, 45.0)):
        glb.place("leaf", leaf(), green, at=(0.150, 0.078, 0.0), turn=turn, tilt=tilt)
    glb.camera("camera", (0.0, 0.17, 0.62), (0.0, 0.062, 0.0), 22.0)
    glb.write(path)
