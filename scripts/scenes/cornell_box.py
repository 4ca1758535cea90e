"""The Cornell box, in the measured size of the original (55 cm) and its usual linear sRGB colours."""

from glb import Glb
from shapes import merge, polygon


def mm(*points):
    """Polygon of the published coordinates in millimetres (there x runs left and z away: a half turn about y)."""
    return polygon(*((-x / 1000, y / 1000, -z / 1000) for x, y, z in points))


def block(top, height):
    low = [(x, 0.0, z) for x, z in top]
    high = [(x, height, z) for x, z in top]
    sides = [mm(low[k], high[k], high[(k + 1) % 4], low[(k + 1) % 4]) for k in range(4)]
    return merge(mm(*high[::-1]), *sides).flipped()


def build(path):
    glb = Glb("Cornell box")
    lambert = {"roughness": 1.0, "extensions": {"specular": {"specularFactor": 0.0}}}
    white = glb.material("white", (0.725, 0.71, 0.68), **lambert)
    red = glb.material("red", (0.63, 0.065, 0.05), **lambert)
    green = glb.material("green", (0.14, 0.45, 0.091), **lambert)
    light = glb.material("light", (0.78, 0.78, 0.78), emission=(1.0, 0.706, 0.235), strength=17.0, **lambert)

    shell = merge(
        mm((0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2), (552.8, 0, 0)),
        mm((0, 548.8, 0), (556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2)),
        mm((0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2), (549.6, 0, 559.2)))
    glb.place("shell", shell, white)
    glb.place("left wall", mm((552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)), red)
    glb.place("right wall", mm((0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)), green)
    glb.place("short block", block([(130, 65), (82, 225), (240, 272), (290, 114)], 165), white)
    glb.place("tall block", block([(423, 247), (265, 296), (314, 456), (472, 406)], 330), white)
    glb.place("light", mm((213, 548.7, 227), (343, 548.7, 227), (343, 548.7, 332), (213, 548.7, 332)), light)
    glb.camera("camera", (-0.278, 0.273, 0.8), (-0.278, 0.273, 0.0), 39.3077, aspect=None)
    glb.write(path)
