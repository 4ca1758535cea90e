"""Points on the triangles of a scene."""

import numpy


class Points:
    """Points on triangles.

    instances     (n,) uint32: index in scene.instances; 0 for a mesh alone
    triangles     (n,) uint32: index in mesh.triangles
    barycentrics  (n, 2) float32: weights of the triangle's second and third corner
    positions     (n, 3) float32, metres in the world
    normals       (n, 3) float32, of the triangles in the world, unit
    """

    def __init__(self, instances, triangles, barycentrics, positions=None, normals=None):
        self.instances = instances
        self.triangles = triangles
        self.barycentrics = barycentrics
        self.positions = positions
        self.normals = normals

    def __len__(self):
        return len(self.triangles)


def _world_triangles(scene_or_mesh):
    """(positions (t, 3, 3) in the world, instance and triangle of each)."""
    if hasattr(scene_or_mesh, "instances"):
        placed = [(i.index, i.mesh, i.transform.astype(float)) for i in scene_or_mesh.instances]
    else:
        placed = [(0, scene_or_mesh, numpy.eye(4))]
    corners, instances, triangles = [], [], []
    for index, mesh, matrix in placed:
        world = mesh.positions @ matrix[:3, :3].T + matrix[:3, 3]
        corners.append(world[mesh.triangles])
        instances.append(numpy.full(len(mesh.triangles), index, numpy.uint32))
        triangles.append(numpy.arange(len(mesh.triangles), dtype=numpy.uint32))
    return numpy.concatenate(corners), numpy.concatenate(instances), numpy.concatenate(triangles)


def sample_points(scene_or_mesh, count, seed=None):
    """Points that are uniform by area over all triangles. `seed`: of numpy.random.default_rng. Returns Points."""
    random = numpy.random.default_rng(seed)
    corners, instances, triangles = _world_triangles(scene_or_mesh)
    cross = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    twice_area = numpy.linalg.norm(cross, axis=1)
    chosen = random.choice(len(corners), size=count, p=twice_area / twice_area.sum())
    weights = random.random((count, 2))
    outside = weights.sum(axis=1) > 1
    weights[outside] = 1 - weights[outside]
    a, b, c = (corners[chosen, k] for k in range(3))
    positions = a + weights[:, :1] * (b - a) + weights[:, 1:] * (c - a)
    normals = cross[chosen] / twice_area[chosen, None]
    return Points(
        instances[chosen], triangles[chosen], weights.astype(numpy.float32), positions.astype(numpy.float32),
        normals.astype(numpy.float32),
    )
