"""What the tests of the module share."""

import os
import pathlib
import unittest

import numpy

import gatelight

SOURCE = pathlib.Path(__file__).parents[2]
DATA = SOURCE / "data"
PROGRAM = os.environ.get("GATELIGHT_PROGRAM", str(SOURCE / "build/release/bin/gatelight"))
SMALL = dict(size=(48, 32), preset=None, integrator="path", denoiser="none", spp=4)


def square(scene, material=None, **more):
    positions = numpy.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]], numpy.float32)
    return scene.add_mesh(positions, numpy.array([[0, 2, 1], [0, 3, 2]], numpy.uint32), material=material, **more)


def lit_square():
    """A red square below a point light."""
    scene = gatelight.Scene()
    red = scene.add_material(name="red", base_color=(0.8, 0.2, 0.1), metallic=0, roughness=0.5)
    scene.add_instance(square(scene, red), name="square")
    scene.add_light("point", name="lamp", intensity=10, position=(0, 2, 0))
    scene.add_camera(eye=(0, 2, 3), target=(0, 0, 0), fov=45)
    return scene


main = unittest.main
