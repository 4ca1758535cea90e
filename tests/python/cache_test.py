"""Neural fields by hand."""

import pathlib
import tempfile
import unittest

import numpy
from support import gatelight, main, square


def function(p):
    return numpy.stack([numpy.sin(3 * p[:, 0]), numpy.cos(2 * p[:, 2])], axis=1)


class Fields(unittest.TestCase):
    def test_learns_and_saves(self):
        for encoding in ("gate", "hashgrid"):
            scene = gatelight.Scene()
            mesh = square(scene)
            field = gatelight.Cache(mesh, encoding=encoding, outputs=2, cache_memory=1)
            points, test = gatelight.sample_points(mesh, 4096, seed=1), gatelight.sample_points(mesh, 1000, seed=2)
            losses = field.train(points, function(points.positions), steps=200)
            self.assertEqual(losses.shape, (200,))
            self.assertLess(losses[-1], 0.05 * losses[0])
            answers = field.query(test)
            self.assertEqual((answers.shape, answers.dtype), ((1000, 2), numpy.float32))
            self.assertLess(numpy.sqrt(numpy.mean((answers - function(test.positions)) ** 2)), 0.1)
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder, "field.safetensors")
                field.save(path)
                again = gatelight.Cache.load(path, mesh)
                self.assertTrue((again.query(test) == answers).all())
                self.assertEqual(again.steps, 200)
                mesh.positions = 2 * mesh.positions
                with self.assertRaises(gatelight.Error):
                    gatelight.Cache.load(path, mesh)

    def test_points_are_uniform_and_checked(self):
        scene = gatelight.Scene()
        mesh = square(scene)
        points = gatelight.sample_points(mesh, 4000, seed=3)
        self.assertLess(abs(points.positions[:, 0].mean()), 0.05)
        self.assertTrue((points.positions == gatelight.sample_points(mesh, 4000, seed=3).positions).all())
        with self.assertRaises(gatelight.Error) as caught:
            gatelight.Cache(mesh, direction_input=True)
        self.assertEqual(caught.exception.option, "direction_input")
        field = gatelight.Cache(mesh, outputs=1)
        points.triangles[5] = 9
        with self.assertRaisesRegex(gatelight.Error, "index 9 of point 5"):
            field.query(points)


if __name__ == "__main__":
    main()
