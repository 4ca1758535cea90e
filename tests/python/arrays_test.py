"""Arrays are views without a copy, and keep what they belong to."""

import gc
import os
import unittest

import numpy
from support import DATA, SMALL, gatelight, lit_square, main, square


class Arrays(unittest.TestCase):
    def test_pictures_are_not_copied(self):
        picture = gatelight.render(lit_square(), aov="albedo,depth", **SMALL)
        array = numpy.asarray(picture)
        self.assertEqual((array.shape, array.dtype), ((32, 48, 3), numpy.float32))
        self.assertTrue(numpy.shares_memory(array, numpy.asarray(picture)))
        self.assertTrue(numpy.shares_memory(array, picture["beauty"]))
        self.assertEqual(picture["albedo"].__array_interface__["data"], picture.layers["albedo"].__array_interface__["data"])
        self.assertEqual(picture["depth"].shape, (32, 48))
        with self.assertRaisesRegex(KeyError, "did you mean 'albedo'"):
            picture["albdo"]

    def test_arrays_outlive_picture_and_scene(self):
        scene = lit_square()
        picture = gatelight.render(scene, **SMALL)
        array, positions = numpy.asarray(picture), scene.meshes[0].positions
        sums = array.sum(), positions.sum()
        del picture, scene
        gc.collect()
        self.assertEqual((array.sum(), positions.sum()), sums)

    def test_positions_are_views(self):
        scene = lit_square()
        mesh = scene.meshes[0]
        before = mesh.positions
        mesh.positions = before * 2
        self.assertTrue(numpy.shares_memory(before, mesh.positions))
        self.assertEqual(before.max(), 2)
        with self.assertRaises(ValueError):
            before[0] = 1

    def test_colors_multiply_the_base_color(self):
        pictures = []
        for color, base in (((0.5, 0.25, 1.0), (1, 1, 1)), (None, (0.5, 0.25, 1.0))):
            scene = gatelight.Scene()
            colors = None if color is None else numpy.tile(numpy.array(color, numpy.float32), (4, 1))
            scene.add_instance(square(scene, scene.add_material(base_color=base, metallic=0, roughness=1), colors=colors))
            pictures.append(numpy.asarray(gatelight.render(scene, eye=(0, 2, 3), target=(0, 0, 0), environment=(1, 1, 1), **SMALL)))
            self.assertGreater(pictures[-1].sum(), 0)
        numpy.testing.assert_allclose(pictures[0], pictures[1], rtol=1e-5)
        mesh = square(gatelight.Scene(), colors=numpy.ones((4, 4), numpy.float32))
        view = mesh.colors
        mesh.colors = numpy.full((4, 3), 0.5)
        self.assertEqual(view.tolist(), [[0.5, 0.5, 0.5, 1]] * 4)
        for wrong in (-numpy.ones((4, 3)), numpy.ones((3, 3)), numpy.ones((4, 2)), None):
            with self.assertRaises(gatelight.Error) as caught:
                mesh.colors = wrong
            self.assertEqual(caught.exception.option, "colors")

    def test_wrong_arrays(self):
        scene = gatelight.Scene()
        corners, triangle = numpy.eye(3, dtype=numpy.float32), [[0, 1, 2]]
        for positions, triangles, option, text in (
            (corners, [[0, 1, 3]], "triangles", "index 3 in triangle 0, expected less than 3"),
            (corners, [[0, 1, -1]], "triangles", "'-1' is not from 0"),
            (corners, [[0.0, 1, 2]], "triangles", "expected integers"),
            (corners * numpy.nan, triangle, "positions", "position 0 is"),
            (corners[:, :2], triangle, "positions", "expected (n, 3)"),
            (corners, numpy.zeros((0, 3), int), "triangles", "expected a triangle"),
        ):
            with self.assertRaises(gatelight.Error) as caught:
                scene.add_mesh(positions, triangles)
            self.assertEqual(caught.exception.option, option)
            self.assertIn(text, str(caught.exception))

    def test_no_leak(self):
        scene, sizes = lit_square(), {}
        more = int(os.environ.get("GATELIGHT_LEAK_RENDERS", 200))
        for i in range(more + 1):
            gatelight.render(scene, size=(16, 16), preset=None, spp=1)
            if i in (50, more):
                with open("/proc/self/statm") as file:
                    sizes[i] = int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
        self.assertLess(sizes[more] - sizes[50], 16 << 20)

    def test_changes_count(self):
        scene = lit_square()
        renderer = gatelight.Renderer(scene, **SMALL)
        first = numpy.array(renderer.render())
        self.assertTrue((first == numpy.asarray(renderer.render())).all())
        scene.lights[0].intensity = 20
        numpy.testing.assert_allclose(numpy.asarray(renderer.render()), 2 * first, rtol=1e-4)
        scene.materials[0].base_color = (0.1, 0.8, 0.1)
        self.assertGreater(numpy.asarray(renderer.render())[..., 1].sum(), first[..., 1].sum())

    def test_textures(self):
        scene = gatelight.Scene()
        texture = scene.add_texture(numpy.full((2, 2, 3), 255, numpy.uint8))
        material = scene.add_material(base_color_texture=texture, metallic=0)
        self.assertEqual(material.base_color_texture.index, 0)
        scene.add_instance(square(scene, material, uvs=[[0, 0], [1, 0], [1, 1], [0, 1]]))
        gatelight.render(scene, **SMALL)
        self.assertEqual(scene.warnings, [])


class Files(unittest.TestCase):
    def test_loaded_scene_changes(self):
        scene = gatelight.load(DATA / "cornell-box.glb")
        first = numpy.array(gatelight.render(scene, **SMALL))
        for material in scene.materials:
            material.base_color = (0, 0, 0)
        self.assertLess(numpy.asarray(gatelight.render(scene, **SMALL)).sum(), first.sum())


if __name__ == "__main__":
    main()
