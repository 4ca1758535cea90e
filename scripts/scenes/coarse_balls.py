"""Three balls of few triangles with smooth normals under a sun, a spot and a lamp: the shadow terminator."""

import math

from glb import Glb
from shapes import quad, sphere

SEGMENTS = (12, 24, 48)
RADIUS = 0.5


def build(path):
    glb = Glb("coarse-balls")
    grey = glb.material("clay", (0.7, 0.7, 0.7), roughness=0.8)
    for k, segments in enumerate(SEGMENTS):
        glb.place(f"ball {segments}x{segments // 2}", sphere(RADIUS, segments, segments // 2), grey,
                  at=(1.2 * (k - 1), RADIUS, 0.0))
    glb.place("floor", quad((-8, 0, 8), (16, 0, 0), (0, 0, -16)), glb.material("floor", (0.4, 0.4, 0.4), roughness=0.9))
    glb.light("sun", "directional", (1.0, 0.95, 0.85), 3.0, (-1.5, 1.8, -1.5), (0, 0, 0))
    glb.light("spot", "spot", (0.85, 0.92, 1.0), 32.0, (-1.4, 2.6, -1.8), (0, 0.4, 0),
              spot={"innerConeAngle": 0.5, "outerConeAngle": round(math.pi / 4, 6)})
    # It is a square that faces down towards the balls.
    glow = glb.material("lamp", (0.0, 0.0, 0.0), roughness=1.0, emission=(1.0, 0.9, 0.75), strength=14.0)
    glb.place("lamp", quad((-1.5, 2.0, -1.6), (2.0, 0.0, 0.0), (0.0, 0.3, 0.3)), glow)
    glb.camera("camera", (0.0, 0.9, 4.6), (0.0, 0.47, 0.0), 16.0, aspect=None)
    glb.write(path)
