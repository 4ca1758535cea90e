"""Meshes and points for lights that have a size. Surfaces shine along -z, as lights of glTF do."""

import math

SEGMENTS = 48
GOLDEN = math.pi * (3.0 - math.sqrt(5.0))


def rectangle():
    """One metre wide and high."""
    return [(-0.5, -0.5, 0.0), (0.5, -0.5, 0.0), (0.5, 0.5, 0.0), (-0.5, 0.5, 0.0)], [(0, 2, 1), (0, 3, 2)]


def disc():
    """A polygon of the area of a disc of one metre across."""
    radius = 0.5 * math.sqrt(2.0 * math.pi / (SEGMENTS * math.sin(2.0 * math.pi / SEGMENTS)))
    rim = [(radius * math.cos(a), radius * math.sin(a), 0.0) for a in (2.0 * math.pi * k / SEGMENTS for k in range(SEGMENTS))]
    return [(0.0, 0.0, 0.0), *rim], [(0, 1 + (k + 1) % SEGMENTS, 1 + k) for k in range(SEGMENTS)]


def sphere(rows=12, columns=24):
    """A polyhedron of the surface of a sphere of radius 1; it shines outwards."""
    points = [(0.0, 0.0, 1.0)]
    for row in range(1, rows):
        polar = math.pi * row / rows
        points += [(math.sin(polar) * math.cos(a), math.sin(polar) * math.sin(a), math.cos(polar))
                   for a in (2.0 * math.pi * column / columns for column in range(columns))]
    points.append((0.0, 0.0, -1.0))
    last, triangles = len(points) - 1, []
    for column in range(columns):
        after = (column + 1) % columns
        triangles.append((0, 1 + column, 1 + after))
        for row in range(rows - 2):
            upper, lower = 1 + row * columns, 1 + (row + 1) * columns
            triangles += [(upper + column, lower + column, lower + after), (upper + column, lower + after, upper + after)]
        base = 1 + (rows - 2) * columns
        triangles.append((last, base + after, base + column))
    scale = math.sqrt(4.0 * math.pi / area(points, triangles))
    return [tuple(scale * x for x in point) for point in points], triangles


def area(points, triangles):
    total = 0.0
    for a, b, c in triangles:
        u, v = ([points[k][i] - points[a][i] for i in range(3)] for k in (b, c))
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        total += 0.5 * math.sqrt(sum(x * x for x in n))
    return total


def points_in_disc(count):
    """Evenly in a disc of radius 1."""
    return [(r * math.cos(GOLDEN * k), r * math.sin(GOLDEN * k), 0.0)
            for k, r in ((k, math.sqrt((k + 0.5) / count)) for k in range(count))]
