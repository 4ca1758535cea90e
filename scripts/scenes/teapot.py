"""Martin Newell's teapot (University of Utah, 1975): 32 bicubic Bezier patches, in the author's units, z up.

Rim, body, lid and bottom are turned: each quarter has the same profile, and its circle is the cubic whose middle points
stand at 0.56 of the radius. Handle and spout are given by half and mirrored at y = 0."""

from shapes import Mesh, cells, merge

# Control points (radius, height) of the profiles, inside to outside seen from the axis.
TURNED = (
    ((1.4, 2.4), (1.3375, 2.53125), (1.4375, 2.53125), (1.5, 2.4)),  # rim
    ((1.5, 2.4), (1.75, 1.875), (2.0, 1.35), (2.0, 0.9)),  # body, above
    ((2.0, 0.9), (2.0, 0.45), (1.5, 0.225), (1.5, 0.15)),  # body, below
    ((0.0, 3.15), (0.8, 3.15), (0.0, 2.85), (0.2, 2.7)),  # knob of the lid
    ((0.2, 2.7), (0.4, 2.55), (1.3, 2.55), (1.3, 2.4)),  # lid
    ((1.5, 0.15), (1.5, 0.075), (1.425, 0.0), (0.0, 0.0)),  # bottom
)
# Rows of four control points each; the first and the last of a row lie in the plane of symmetry.
MIRRORED = (
    (((-1.6, 0.0, 2.025), (-1.6, -0.3, 2.025), (-1.5, -0.3, 2.25), (-1.5, 0.0, 2.25)),  # handle, above
     ((-2.3, 0.0, 2.025), (-2.3, -0.3, 2.025), (-2.5, -0.3, 2.25), (-2.5, 0.0, 2.25)),
     ((-2.7, 0.0, 2.025), (-2.7, -0.3, 2.025), (-3.0, -0.3, 2.25), (-3.0, 0.0, 2.25)),
     ((-2.7, 0.0, 1.8), (-2.7, -0.3, 1.8), (-3.0, -0.3, 1.8), (-3.0, 0.0, 1.8))),
    (((-2.7, 0.0, 1.8), (-2.7, -0.3, 1.8), (-3.0, -0.3, 1.8), (-3.0, 0.0, 1.8)),  # handle, below
     ((-2.7, 0.0, 1.575), (-2.7, -0.3, 1.575), (-3.0, -0.3, 1.35), (-3.0, 0.0, 1.35)),
     ((-2.5, 0.0, 1.125), (-2.5, -0.3, 1.125), (-2.65, -0.3, 0.9375), (-2.65, 0.0, 0.9375)),
     ((-2.0, 0.0, 0.9), (-2.0, -0.3, 0.9), (-1.9, -0.3, 0.6), (-1.9, 0.0, 0.6))),
    (((1.7, 0.0, 1.425), (1.7, -0.66, 1.425), (1.7, -0.66, 0.6), (1.7, 0.0, 0.6)),  # spout
     ((2.6, 0.0, 1.425), (2.6, -0.66, 1.425), (3.1, -0.66, 0.825), (3.1, 0.0, 0.825)),
     ((2.3, 0.0, 2.1), (2.3, -0.25, 2.1), (2.4, -0.25, 2.025), (2.4, 0.0, 2.025)),
     ((2.7, 0.0, 2.4), (2.7, -0.25, 2.4), (3.3, -0.25, 2.4), (3.3, 0.0, 2.4))),
    (((2.7, 0.0, 2.4), (2.7, -0.25, 2.4), (3.3, -0.25, 2.4), (3.3, 0.0, 2.4)),  # mouth of the spout
     ((2.8, 0.0, 2.475), (2.8, -0.25, 2.475), (3.525, -0.25, 2.49375), (3.525, 0.0, 2.49375)),
     ((2.9, 0.0, 2.475), (2.9, -0.15, 2.475), (3.45, -0.15, 2.5125), (3.45, 0.0, 2.5125)),
     ((2.8, 0.0, 2.4), (2.8, -0.15, 2.4), (3.2, -0.15, 2.4), (3.2, 0.0, 2.4))),
)


def patches():
    """All 32, each four rows of four points."""
    for profile in TURNED:
        for cos, sin in ((1, 0), (0, -1), (-1, 0), (0, 1)):
            # The quarter from (cos, sin) a quarter turn on, clockwise as seen from above.
            yield tuple(tuple((r * (a * cos + b * sin), r * (a * sin - b * cos), z)
                              for a, b in ((1, 0), (1, 0.56), (0.56, 1), (0, 1))) for r, z in profile)
    for half in MIRRORED:
        yield half
        yield tuple(tuple((x, -y, z) for x, y, z in reversed(row)) for row in half)


def mixed(weights, values):
    """The sum of weighted values from the first to the last. sum() rounds otherwise since Python 3.12."""
    total = 0.0
    for weight, value in zip(weights, values):
        total += weight * value
    return total


def tessellate(pieces, height):
    """A mesh of `pieces` times `pieces` quadrilaterals a patch, y up, standing on y = 0, `height` metres high."""
    weights = [((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t ** 3)
               for t in (k / pieces for k in range(pieces + 1))]
    parts = []
    for patch in patches():
        mesh = Mesh()
        for bv in weights:
            row = [[mixed(bv, (patch[j][i][k] for j in range(4))) for k in range(3)] for i in range(4)]
            for bu in weights:
                x, y, z = (mixed(bu, (row[i][k] for i in range(4))) for k in range(3))
                mesh.positions.append((x, z, -y))
        for a, b, c, d in cells(pieces, pieces):
            mesh.triangles += [(a, c, d), (a, b, c)]
        parts.append(mesh)
    whole = merge(*parts)
    # At the poles one side of a patch is a point, and a triangle there has no area.
    places = [tuple(round(c, 7) for c in p) for p in whole.positions]
    whole.triangles = [t for t in whole.triangles if len({places[k] for k in t}) == 3]
    return whole.smooth().scaled(height / 3.15)
