"""Triangle meshes: y up, metres, counter-clockwise fronts."""

import math

from glb import cross, unit


class Mesh:
    """Parallel lists of positions and, where not empty, normals and uvs; triangles are index triples."""

    def __init__(self, positions=None, triangles=None, normals=None, uvs=None):
        self.positions = positions or []
        self.triangles = triangles or []
        self.normals = normals or []
        self.uvs = uvs or []

    def map(self, place, turn=None):
        """Positions through `place`, normals through `turn` (or left as they are)."""
        return Mesh([place(p) for p in self.positions], list(self.triangles),
                    [turn(n) for n in self.normals] if turn else list(self.normals), list(self.uvs))

    def moved(self, x, y, z):
        return self.map(lambda p: (p[0] + x, p[1] + y, p[2] + z))

    def scaled(self, s):
        return self.map(lambda p: (p[0] * s, p[1] * s, p[2] * s))

    def turned(self, axis, degrees):
        """Rotated about an axis, "x", "y" or "z", counter-clockwise as seen from its tip."""
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        a, b = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]

        def turn(p):
            q = list(p)
            q[a], q[b] = c * p[a] - s * p[b], s * p[a] + c * p[b]
            return tuple(q)

        return self.map(turn, turn)

    def flipped(self):
        return Mesh(list(self.positions), [(a, c, b) for a, b, c in self.triangles],
                    [(-n[0], -n[1], -n[2]) for n in self.normals], list(self.uvs))

    def planar_uvs(self, axes="xz", repeats_per_metre=1.0):
        """Texture coordinates from two coordinates of the position; v runs down as in the picture."""
        a, b = ("xyz".index(axis) for axis in axes)
        self.uvs = [(p[a] * repeats_per_metre, -p[b] * repeats_per_metre) for p in self.positions]
        return self

    def flat(self):
        """Without normals."""
        return Mesh(self.positions, self.triangles, [], self.uvs)

    def smooth(self):
        """Normals averaged over the faces that meet at a position, weighted by area; seams are bridged."""
        sums = {}
        keys = [tuple(round(c * 1e5) for c in p) for p in self.positions]
        for a, b, c in self.triangles:
            n = face_normal(self.positions[a], self.positions[b], self.positions[c])
            for key in {keys[a], keys[b], keys[c]}:
                old = sums.get(key, (0.0, 0.0, 0.0))
                sums[key] = (old[0] + n[0], old[1] + n[1], old[2] + n[2])
        self.normals = [unit_or_up(sums.get(key, (0.0, 0.0, 0.0))) for key in keys]
        return self


def face_normal(a, b, c):
    return cross([b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)])


def unit_or_up(v):
    length = math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    return (v[0] / length, v[1] / length, v[2] / length) if length > 1e-12 else (0.0, 1.0, 0.0)


def merge(*meshes):
    """One mesh of several. It has normals or uvs only if all of them have."""
    result = Mesh()
    for mesh in meshes:
        first = len(result.positions)
        result.positions += mesh.positions
        result.triangles += [(a + first, b + first, c + first) for a, b, c in mesh.triangles]
    for kind in ("normals", "uvs"):
        if all(getattr(mesh, kind) for mesh in meshes):
            setattr(result, kind, [value for mesh in meshes for value in getattr(mesh, kind)])
    return result


def polygon(*corners):
    """A flat convex polygon, counter-clockwise, without normals."""
    return Mesh([tuple(c) for c in corners], [(0, k, k + 1) for k in range(1, len(corners) - 1)])


def upright(low, height):
    """A prism without normals on a level polygon, which is counter-clockwise as seen from above."""
    high = [(x, y + height, z) for x, y, z in low]
    ahead = [*range(1, len(low)), 0]
    return merge(polygon(*high), polygon(*reversed(low)),
                 *(polygon(low[k], low[n], high[n], high[k]) for k, n in enumerate(ahead)))


def cells(columns, rows, first=0):
    """The corners of each cell of a grid, counter-clockwise. The vertices begin at `first`, row by row."""
    for j in range(rows):
        for a in range(first + j * (columns + 1), first + j * (columns + 1) + columns):
            yield a, a + 1, a + columns + 2, a + columns + 1


def part_of_grid(columns, rows, keep):
    """Of a grid only the cells (i, j) that `keep` names: the vertices that these need, and triangles of their places in
    this list."""
    chosen = [corners for k, corners in enumerate(cells(columns, rows)) if keep(k % columns, k // columns)]
    used = sorted({k for corners in chosen for k in corners})
    place = {k: n for n, k in enumerate(used)}
    return used, [triangle for a, b, c, d in ([place[k] for k in corners] for corners in chosen)
                  for triangle in ((a, b, c), (a, c, d))]


def surface(columns, rows, function, wrap=False):
    """Grid over u, v in [0, 1]: `function(u, v)` gives the position. u to the right and v up see the front.
    Smooth normals; uvs are (u, 1 - v). `wrap` says that u = 0 and u = 1 meet (the seam is bridged either way)."""
    mesh = Mesh()
    for j in range(rows + 1):
        for i in range(columns + 1):
            u, v = i / columns, j / rows
            mesh.positions.append(tuple(function(0.0 if wrap and i == columns else u, v)))
            mesh.uvs.append((u, 1.0 - v))
    for a, b, c, d in cells(columns, rows):
        for triangle in ((a, b, c), (a, c, d)):
            corners = [mesh.positions[k] for k in triangle]
            # The poles of a sphere and the axis of a lathe have triangles without area.
            if sum(v * v for v in face_normal(*corners)) > 1e-24:
                mesh.triangles.append(triangle)
    return mesh.smooth()


def quad(corner, edge_u, edge_v, repeats=(1.0, 1.0)):
    """A parallelogram whose front is edge_u x edge_v, with uvs."""
    def at(u, v):
        return tuple(c + u * a + v * b for c, a, b in zip(corner, edge_u, edge_v))
    mesh = surface(1, 1, at)
    mesh.uvs = [(u * repeats[0], v * repeats[1]) for u, v in mesh.uvs]
    return mesh


def catmull_rom(points, steps):
    """A smooth curve through the points, any dimension, `steps` pieces between two of them."""
    result = []
    for k in range(len(points) - 1):
        p0, p1, p2 = points[max(k - 1, 0)], points[k], points[k + 1]
        p3 = points[min(k + 2, len(points) - 1)]
        for step in range(steps):
            t = step / steps
            result.append(tuple(
                0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t ** 3)
                for a, b, c, d in zip(p0, p1, p2, p3)))
    return result + [tuple(points[-1])]


def lathe(profile, segments=48, crease_degrees=50.0):
    """Surface of revolution about y. `profile` lists (radius, height); its right side, walking along it upwards at
    positive radius, is outside. Normals are sharp where the profile bends by more than the crease."""
    tangents = [unit((b[0] - a[0], b[1] - a[1])) for a, b in zip(profile, profile[1:])]
    rings = []  # (radius, height, normal r, normal y, length along the profile)
    length = 0.0
    for k, point in enumerate(profile):
        before = tangents[k - 1] if k > 0 else tangents[k]
        after = tangents[k] if k < len(tangents) else tangents[k - 1]
        if k > 0:
            length += math.dist(profile[k - 1], point)
        sharp = before[0] * after[0] + before[1] * after[1] < math.cos(math.radians(crease_degrees))
        for t in [before, after] if sharp else [unit((before[0] + after[0], before[1] + after[1]))]:
            rings.append((point[0], point[1], t[1], -t[0], length))
    mesh = Mesh()
    for r, y, nr, ny, along in rings:
        for i in range(segments + 1):
            angle = 2 * math.pi * (i % segments) / segments
            c, s = math.cos(angle), math.sin(angle)
            mesh.positions.append((r * s, y, r * c))
            mesh.normals.append((nr * s, ny, nr * c))
            mesh.uvs.append((i / segments, -along))
    for j, (low, high) in enumerate(zip(rings, rings[1:])):
        if low[:2] == high[:2]:
            continue
        for a, b, c, d in cells(segments, 1, j * (segments + 1)):
            if low[0] > 0:
                mesh.triangles.append((a, b, c))
            if high[0] > 0:
                mesh.triangles.append((a, c, d))
    return mesh


def tube(path, radius, segments=10):
    """A round rod along a list of points, with closed ends; `radius` is a number or one for each point."""
    radii = [radius] * len(path) if isinstance(radius, (int, float)) else radius
    rings, frame = [], None
    for k, point in enumerate(path):
        ahead = unit([b - a for a, b in zip(path[max(k - 1, 0)], path[min(k + 1, len(path) - 1)])])
        side = frame or ([1.0, 0.0, 0.0] if abs(ahead[0]) < 0.9 else [0.0, 0.0, 1.0])
        along = sum(a * s for a, s in zip(ahead, side))
        frame = unit([s - along * a for a, s in zip(ahead, side)])
        other = cross(ahead, frame)
        ring = []
        for i in range(segments):
            c, s = (radii[k] * f(2 * math.pi * i / segments) for f in (math.cos, math.sin))
            ring.append(tuple(p + c * f + s * o for p, f, o in zip(point, frame, other)))
        rings.append(ring)
    last = len(path) - 1
    side = surface(segments, last, lambda u, v: rings[round(v * last)][round(u * segments) % segments], wrap=True)
    ends = [polygon(*reversed(rings[0])), polygon(*rings[-1])]
    for end in ends:
        end.smooth()
        end.uvs = [(0.0, 0.0)] * len(end.positions)
    return merge(side, *ends)


def sphere(radius, segments=32, rings=16):
    def at(u, v):
        theta, phi = math.pi * (1 - v), 2 * math.pi * u
        r = 0.0 if v in (0.0, 1.0) else radius * math.sin(theta)
        return r * math.sin(phi), radius * math.cos(theta), r * math.cos(phi)
    mesh = surface(segments, rings, at, wrap=True)
    mesh.normals = [unit_or_up(p) for p in mesh.positions]
    return mesh


def rounded_box(size, radius, bevel=2, flat=1, shape=None):
    """A box about the origin with rounded edges. `flat` is the number of pieces of each flat side; `shape`, if given,
    moves every position afterwards (a cushion's bulge), and normals are then averaged."""
    half = [s / 2 for s in size]
    inner = [max(h - radius, 0.0) for h in half]

    def samples(axis):
        # Equal angles over the bevel: the box's point at tan(angle) is pulled back to the round edge.
        steps = [radius * math.tan(math.radians(45.0 * k / bevel)) for k in range(1, bevel + 1)]
        middle = [inner[axis] * (2 * k / flat - 1) for k in range(flat + 1)]
        return [-inner[axis] - s for s in reversed(steps)] + middle + [inner[axis] + s for s in steps]

    mesh = Mesh()
    for axis in range(3):
        for sign in (-1, 1):
            a, b = (axis + 1) % 3, (axis + 2) % 3
            us, vs = samples(a), samples(b)
            if sign < 0:
                us = us[::-1]
            first = len(mesh.positions)
            for v in vs:
                for u in us:
                    p = [0.0, 0.0, 0.0]
                    p[axis], p[a], p[b] = sign * half[axis], u, v
                    core = [max(-i, min(i, c)) for c, i in zip(p, inner)]
                    n = unit([c - q for c, q in zip(p, core)])
                    mesh.positions.append(tuple(q + radius * c for q, c in zip(core, n)))
                    mesh.normals.append(tuple(n))
            for k, m, n, o in cells(len(us) - 1, len(vs) - 1, first):
                mesh.triangles += [(k, m, n), (k, n, o)]
    if shape:
        mesh.positions = [tuple(shape(*p)) for p in mesh.positions]
        mesh.smooth()
    return mesh
