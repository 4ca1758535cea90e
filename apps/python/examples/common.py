"""A small scene of arrays, and plots, for the other examples."""

import argparse
import pathlib

import matplotlib
import numpy

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot  # noqa: E402,F401: the examples use it

import gatelight  # noqa: E402


def arguments(text, **more):
    """The arguments of an example: a folder for its pictures, and --small for a quick run."""
    parser = argparse.ArgumentParser(description=text)
    parser.add_argument("folder", type=pathlib.Path, help="folder for the pictures")
    parser.add_argument("--small", action="store_true", help="a small and quick run")
    for name, help_text in more.items():
        parser.add_argument(f"--{name}", help=help_text)
    chosen = parser.parse_args()
    chosen.folder.mkdir(parents=True, exist_ok=True)
    return chosen


def sphere(rows=24, columns=48, radius=0.5):
    """Positions, normals and triangles of a sphere."""
    theta = numpy.linspace(0, numpy.pi, rows + 1)[:, None]
    phi = numpy.linspace(0, 2 * numpy.pi, columns, endpoint=False)[None, :]
    normals = numpy.stack(
        [numpy.sin(theta) * numpy.cos(phi), numpy.cos(theta) + 0 * phi, numpy.sin(theta) * numpy.sin(phi)], axis=-1
    ).reshape(-1, 3)
    i, j = numpy.meshgrid(numpy.arange(rows), numpy.arange(columns), indexing="ij")
    a, b = i * columns + j, i * columns + (j + 1) % columns
    c, d = a + columns, b + columns
    triangles = numpy.concatenate([numpy.stack([a, b, c], -1).reshape(-1, 3), numpy.stack([b, d, c], -1).reshape(-1, 3)])
    return radius * normals, normals, triangles.astype(numpy.uint32)


def stage():
    """A sphere on a floor, with three lights and a camera."""
    scene = gatelight.Scene()
    floor = scene.add_material(name="floor", base_color=(0.6, 0.6, 0.6), metallic=0, roughness=0.9)
    clay = scene.add_material(name="clay", base_color=(0.7, 0.3, 0.2), metallic=0, roughness=0.5)
    corners = 30 * numpy.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]], numpy.float32)
    ground = scene.add_mesh(corners, numpy.array([[0, 2, 1], [0, 3, 2]], numpy.uint32), material=floor, name="floor")
    positions, normals, triangles = sphere()
    ball = scene.add_mesh(positions, triangles, normals=normals, material=clay, name="ball")
    scene.add_instance(ground)
    raised = numpy.eye(4)
    raised[1, 3] = 0.5
    scene.add_instance(ball, raised, name="ball")
    for name, position, color in (
        ("key", (2, 3, 2), (1, 0.9, 0.8)), ("fill", (-3, 2, 1), (0.6, 0.8, 1)), ("rim", (0, 3, -3), (1, 1, 1))
    ):
        scene.add_light("point", name=name, position=position, intensity=tuple(8 * c for c in color))
    scene.add_camera(name="front", eye=(0, 2.3, 3.4), target=(0, 0.45, 0), fov=36)
    return scene
