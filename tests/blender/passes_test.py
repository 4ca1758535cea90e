"""Layers become Blender's passes."""

import types
import unittest

import numpy
from support import main, module

exr, passes = module("exr"), module("passes")


def by_name(name):
    return next(made for made in passes.PASSES if made.name == name)


def picture(**layers):
    return exr.Picture({name.replace("_", "-"): numpy.asarray(value, numpy.float32) for name, value in layers.items()}, {}, (0, 0))


class Passes(unittest.TestCase):
    def test_rows_begin_at_the_bottom(self):
        rows = passes.pixels_of(passes.COMBINED, exr.Picture({"": numpy.arange(6, dtype=numpy.float32).reshape(2, 1, 3)}, {}, (0, 0)))
        self.assertEqual(rows.tolist(), [[[3, 4, 5, 1]], [[0, 1, 2, 1]]])

    def test_normals_have_z_up(self):
        self.assertEqual(passes.pixels_of(by_name("Normal"), picture(normal=[[[0.0, 1.0, 0.0]]])).tolist(), [[[0.0, 0.0, 1.0]]])

    def test_motion_looks_back_and_ahead(self):
        made = passes.pixels_of(by_name("Vector"), picture(motion=[[[1.0, 2.0]]], motion_next=[[[3.0, 4.0]]]))
        self.assertEqual(made.tolist(), [[[-1.0, -2.0, -3.0, -4.0]]])

    def test_missing_layers_are_no_pass(self):
        self.assertIsNone(passes.pixels_of(by_name("Vector"), picture(motion=[[[1.0, 2.0]]])))

    def test_depth_is_along_the_view(self):
        """A wall at right angles to the view has one depth, also in a part of the picture."""
        slope, size = 0.05, (12, 8)
        x, y = numpy.meshgrid(numpy.arange(12) + 0.5 - 6.0, numpy.arange(8) + 0.5 - 4.0)
        distance = 3.0 * numpy.sqrt(1.0 + (slope * x) ** 2 + (slope * y) ** 2)
        part = exr.Picture({"depth": distance[2:7, 3:9, None]}, {}, (3, 2))
        passes.flatten_depth(part, types.SimpleNamespace(size=size, slope=slope))
        self.assertTrue(numpy.allclose(part.layers["depth"], 3.0))

    def test_nothing_is_far_away(self):
        made = passes.pixels_of(by_name("Depth"), picture(depth=[[[numpy.inf], [2.0]]]))
        self.assertEqual(made.tolist(), [[[numpy.float32(1e10)], [2.0]]])

    def test_a_layer_asks_for_what_it_shows(self):
        layer = types.SimpleNamespace(use_pass_z=True, use_pass_vector=True, use_pass_cryptomatte_material=True, pass_cryptomatte_depth=2)
        self.assertEqual(passes.flags(layer), ["--aov", "depth,motion,motion-next", "--cryptomatte", "material"])
        self.assertEqual([made.name for made in passes.mask_passes(layer)], ["CryptoMaterial00"])


if __name__ == "__main__":
    main()
