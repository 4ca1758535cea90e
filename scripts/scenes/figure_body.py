"""The body of the figure: cones with round ends, blended, as a mesh with the weights of the joints."""

import functools
import math

from figure_motion import INDEX, JOINTS, SIDES, along_arm
from glb import unit
from shapes import Mesh

CELL = 0.0275
LOW, SIZE = (-0.7425, -0.0275, -0.1925), (54, 67, 15)  # corner and cells of the grid
BLEND = 0.035  # metres over which parts blend
SOFT, SOFT_FOOT = 0.10, 0.04  # metres over which weights fade; a sole follows its foot alone
FAR = 0.15


class Part:
    """A cone with round ends, of radius `ra` at `a` and `rb` at `b`; `flat` stretches the distance along z."""

    def __init__(self, joint, a, ra, b=None, rb=None, flat=1.0):
        self.joint, self.a, self.ra, self.flat = INDEX[joint], a, ra, flat
        b = b or a
        self.step = tuple(q - p for p, q in zip(a, b))
        self.widening = (ra if rb is None else rb) - ra
        x, y, z = self.step
        self.squared = x * x + y * y + z * z * flat * flat
        most = max(ra, ra + self.widening)
        self.low = tuple(min(p, q) - most - FAR for p, q in zip(a, b))
        self.high = tuple(max(p, q) + most + FAR for p, q in zip(a, b))

    def distance(self, x, y, z):
        (ax, ay, az), (sx, sy, sz) = self.a, self.step
        px, py, pz = x - ax, y - ay, (z - az) * self.flat
        sz *= self.flat
        t = 0.0
        if self.squared > 0.0:
            t = min(1.0, max(0.0, (px * sx + py * sy + pz * sz) / self.squared))
        dx, dy, dz = px - t * sx, py - t * sy, pz - t * sz
        return math.sqrt(dx * dx + dy * dy + dz * dz) - self.ra - t * self.widening

    def is_near(self, x, y, z):
        low, high = self.low, self.high
        return low[0] < x < high[0] and low[1] < y < high[1] and low[2] < z < high[2]


def parts():
    result = [
        Part("hips", (-0.062, 0.935, -0.005), 0.108, (0.062, 0.935, -0.005), flat=1.1),
        Part("spine", (-0.042, 1.02, 0.0), 0.108, (-0.044, 1.16, 0.0), 0.104, flat=1.15),
        Part("spine", (0.042, 1.02, 0.0), 0.108, (0.044, 1.16, 0.0), 0.104, flat=1.15),
        Part("hips", (-0.035, 0.865, -0.01), 0.062, (0.035, 0.865, -0.01)),
        Part("chest", (-0.066, 1.29, -0.005), 0.115, (0.066, 1.29, -0.005), flat=1.15),
        Part("chest", (0.0, 1.20, 0.0), 0.115, (0.0, 1.36, -0.01), 0.10, flat=1.2),
        Part("neck", (0.0, 1.43, -0.015), 0.056, (0.0, 1.55, -0.003), 0.050),
        Part("head", (0.0, 1.665, -0.012), 0.102, (0.0, 1.595, 0.018), 0.078),
        Part("head", (0.0, 1.632, 0.088), 0.012, (0.0, 1.607, 0.104), 0.017),
    ]
    for side, sign in SIDES:
        def new(joint, a, ra, b=None, rb=None, side=side, sign=sign, **more):
            mirrored = [p and (sign * p[0], p[1], p[2]) for p in (a, b)]
            result.append(Part(joint.format(side), mirrored[0], ra, mirrored[1], rb, **more))
        new("head", (0.097, 1.628, -0.012), 0.024, (0.094, 1.612, -0.008), 0.020)
        new("chest", (0.07, 1.395, -0.012), 0.060, (0.155, 1.40, -0.01), 0.056)
        new("{} upper arm", along_arm(0.0), 0.056, along_arm(0.26), 0.037)
        new("{} forearm", along_arm(0.27), 0.038, along_arm(0.49), 0.029)
        for z in (-0.030, 0.010):
            new("{} hand", along_arm(0.52, z), 0.027, along_arm(0.64, z * 0.8), 0.020)
        new("{} hand", along_arm(0.535, 0.020), 0.025, along_arm(0.590, 0.064), 0.023)
        new("{} thigh", (0.093, 0.90, -0.008), 0.096, (0.102, 0.53, 0.006), 0.056)
        new("{} shin", (0.102, 0.49, 0.008), 0.054, (0.108, 0.11, -0.018), 0.040)
        new("{} shin", (0.104, 0.39, -0.022), 0.048, (0.107, 0.27, -0.028), 0.042)
        new("{} foot", (0.108, 0.075, -0.025), 0.042, (0.112, 0.040, 0.06), 0.042)
        new("{} foot", (0.109, 0.036, -0.045), 0.042, (0.112, 0.030, 0.11), 0.042)
        for x in (-0.014, 0.014):
            new("{} toes", (0.114 + x, 0.026, 0.115), 0.037, (0.117 + 1.2 * x, 0.022, 0.150), 0.028)
    return result


PARTS = parts()


def distance(x, y, z):
    """The blended distance to the surface, negative inside; FAR where no part is near."""
    d = FAR
    for part in PARTS:
        if not part.is_near(x, y, z):
            continue
        e = part.distance(x, y, z)
        h = max(BLEND - abs(d - e), 0.0)
        d = min(d, e) - h * h / (4.0 * BLEND)
    return max(d, -y)  # soles are flat


def slope(p, e=0.002):
    x, y, z = p
    return (distance(x + e, y, z) - distance(x - e, y, z), distance(x, y + e, z) - distance(x, y - e, z),
            distance(x, y, z + e) - distance(x, y, z - e))


def onto_surface(p):
    for _ in range(3):
        g = slope(p)
        length = math.sqrt(sum(c * c for c in g)) or 1.0
        d = distance(*p)
        p = tuple(c - d * s / length for c, s in zip(p, g))
    return p


def surface_point(x, y):
    """The foremost point of the surface."""
    z = 0.25
    while distance(x, y, z) > 1e-5:
        z -= max(0.5 * distance(x, y, z), 1e-5)
    return x, y, z


@functools.cache
def body():
    """A vertex for each cell of the grid that the surface crosses (surface nets), moved onto the surface."""
    nx, ny, nz = SIZE
    stride = (1, nx + 1, (nx + 1) * (ny + 1))
    values = [distance(*(low + CELL * n for low, n in zip(LOW, (i, j, k))))
              for k in range(nz + 1) for j in range(ny + 1) for i in range(nx + 1)]
    mesh, vertices = Mesh(), {}

    def corners(cell):
        return [(cell + sum(s * b for s, b in zip(stride, bits)), bits)
                for bits in ((i, j, k) for k in (0, 1) for j in (0, 1) for i in (0, 1))]

    for k in range(nz):
        for j in range(ny):
            for i in range(nx):
                cell = i + j * stride[1] + k * stride[2]
                around = corners(cell)
                if len({values[at] < 0.0 for at, _ in around}) == 1:
                    continue
                crossings = []
                for a, bits in around:
                    for axis in range(3):
                        b = a + stride[axis]
                        if bits[axis] == 0 and (values[a] < 0.0) != (values[b] < 0.0):
                            t = values[a] / (values[a] - values[b])
                            crossings.append([bits[c] + (t if c == axis else 0.0) for c in range(3)])
                mean = [sum(c) / len(crossings) for c in zip(*crossings)]
                vertices[cell] = len(mesh.positions)
                mesh.positions.append(onto_surface(tuple(
                    low + CELL * (n + m) for low, n, m in zip(LOW, (i, j, k), mean))))
    for cell in vertices:
        for axis in range(3):
            inside, ahead = values[cell] < 0.0, values[cell + stride[axis]] < 0.0
            if inside == ahead:
                continue
            u, v = stride[(axis + 1) % 3], stride[(axis + 2) % 3]
            a, b, c, d = (vertices[n] for n in (cell - u - v, cell - v, cell, cell - u))
            mesh.triangles += [(a, b, c), (a, c, d)] if inside else [(a, c, b), (a, d, c)]
    mesh.normals = [tuple(unit(slope(p))) for p in mesh.positions]
    return mesh


def weights_of(p):
    """Up to four (joint, weight) pairs, whose weights are bytes and add up to 255. Joints fade where another one's parts
    are nearer."""
    nearest = {}
    for part in PARTS:
        nearest[part.joint] = min(part.distance(*p), nearest.get(part.joint, 1.0))
    least, closest = min((d, joint) for joint, d in nearest.items())
    soft = SOFT_FOOT if JOINTS[closest][0].endswith(("foot", "toes")) else SOFT
    faded = [(max(0.0, 1.0 - (d - least) / soft) ** 2, -joint) for joint, d in nearest.items()]
    best = [(w, -j) for w, j in sorted(faded, reverse=True)[:4] if w > 0.0]
    total = sum(w for w, _ in best)
    rounded = [(j, math.floor(255.0 * w / total + 0.5)) for w, j in best]
    return [(rounded[0][0], rounded[0][1] + 255 - sum(w for _, w in rounded))] + rounded[1:]
