"""A neural field on a mesh: it learns a pattern on a sphere, without any light."""

import numpy

from common import arguments, gatelight, pyplot, sphere

chosen = arguments(__doc__)
positions, _, triangles = sphere()
scene = gatelight.Scene()
mesh = scene.add_mesh(positions, triangles)


def pattern(p):
    """Three numbers for each position."""
    return numpy.stack([numpy.sin(12 * p[:, 0]), numpy.cos(9 * p[:, 1]), p[:, 0] * p[:, 2] * 4], axis=1)


points = gatelight.sample_points(mesh, 20000, seed=1)
test = gatelight.sample_points(mesh, 5000, seed=2)
steps = 128 if chosen.small else 1024
figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 4))
for encoding in ("gate", "hashgrid"):
    field = gatelight.Cache(mesh, encoding=encoding, outputs=3, batch=4096)
    losses = field.train(points, pattern(points.positions), steps=steps)
    error = numpy.sqrt(numpy.mean((field.query(test) - pattern(test.positions)) ** 2))
    left.semilogy(losses, label=encoding)
    print(f"{encoding}: error {error:.4f} after {steps} steps, {field.bytes} bytes")
left.set(xlabel="step", ylabel="loss")
left.legend()
front = points.positions[:, 2] > 0
right.scatter(points.positions[front, 0], points.positions[front, 1], c=field.query(points)[front, 0], s=3)
right.set(aspect="equal", title="the first output, from +z")
figure.savefig(chosen.folder / "field_on_mesh.png")
