"""The skeleton of the figure: its joints at rest, a standing pose, and a walk on the spot. y is up, the figure looks
along +z, its left is +x. At rest all joints have the world's axes, so a rotation says how a joint turns its part."""

import math

from glb import cross, unit

ARM = (0.76, -0.649923)  # direction of the left arm at rest, downwards from the shoulder
FRAMES, STRIDE, STANCE = 24, 0.25, 0.6  # stride: half the way of a foot; stance: share of the time on the ground


def along_arm(length, z=-0.01):
    return 0.18 + ARM[0] * length, 1.40 + ARM[1] * length, z


LEFT = [("upper arm", "chest", along_arm(0.0)), ("forearm", "upper arm", along_arm(0.27)), ("hand", "forearm", along_arm(0.51)),
        ("thigh", "hips", (0.095, 0.92, 0.0)), ("shin", "thigh", (0.102, 0.50, 0.012)), ("foot", "shin", (0.108, 0.085, -0.02)),
        ("toes", "foot", (0.113, 0.03, 0.115))]
SIDES = (("left", 1.0), ("right", -1.0))


def skeleton():
    """(name, index of the parent, position at rest); parents come first."""
    rows = [("hips", None, (0.0, 0.95, 0.0)), ("spine", "hips", (0.0, 1.06, 0.0)), ("chest", "spine", (0.0, 1.21, -0.005)),
            ("neck", "chest", (0.0, 1.45, -0.015)), ("head", "neck", (0.0, 1.55, 0.0))]
    for side, sign in SIDES:
        for name, parent, (x, y, z) in LEFT:
            rows.append((f"{side} {name}", parent if parent in ("hips", "chest") else f"{side} {parent}", (sign * x, y, z)))
    index = {name: k for k, (name, _, _) in enumerate(rows)}
    return [(name, index.get(parent), at) for name, parent, at in rows]


JOINTS = skeleton()
INDEX = {name: k for k, (name, _, _) in enumerate(JOINTS)}
REST = {name: at for name, _, at in JOINTS}


# Rotations are matrices of three rows.

def multiply(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def transposed(a):
    return [list(row) for row in zip(*a)]


def apply(a, v):
    return [sum(a[i][k] * v[k] for k in range(3)) for i in range(3)]


def about(axis, degrees):
    """Counter-clockwise as seen from the tip of "x", "y" or "z"."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    m = [[float(r == k) for k in range(3)] for r in range(3)]
    m[i][i], m[i][j], m[j][i], m[j][j] = c, -s, s, c
    return m


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def add(a, b):
    return [x + y for x, y in zip(a, b)]


def frame(down, forward):
    """Columns: side, down and forward, which is made perpendicular to down."""
    down = unit(down)
    side = unit(cross(down, forward))
    return transposed([side, down, cross(side, down)])


def between(a, b):
    """The smallest rotation from one direction to another."""
    a, b = unit(a), unit(b)
    v, c = cross(a, b), sum(x * y for x, y in zip(a, b))
    k = [[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]]
    square = multiply(k, k)
    return [[float(i == j) + k[i][j] + square[i][j] / (1.0 + c) for j in range(3)] for i in range(3)]


def quaternion_of(m):
    """x, y, z, w of a rotation of less than half a turn."""
    w = math.sqrt(max(0.0, 1.0 + m[0][0] + m[1][1] + m[2][2])) / 2.0
    return [(m[2][1] - m[1][2]) / (4.0 * w), (m[0][2] - m[2][0]) / (4.0 * w), (m[1][0] - m[0][1]) / (4.0 * w), w]


class Pose:
    """World positions and rotations of the joints, set from the hips outwards."""

    def __init__(self, hips, turn):
        self.at = {"hips": list(hips)}
        self.turn = {"hips": turn}

    def place(self, name, world):
        parent = JOINTS[INDEX[name]][1]
        parent = JOINTS[parent][0]
        self.at[name] = add(self.at[parent], apply(self.turn[parent], sub(REST[name], REST[parent])))
        self.turn[name] = world

    def local(self, name, rotation):
        """Turned against its parent."""
        self.place(name, multiply(self.turn[JOINTS[JOINTS[INDEX[name]][1]][0]], rotation))

    def aim(self, name, tip, direction):
        """Turned as little as possible so that the joint `tip` lies in the direction."""
        parent = self.turn[JOINTS[JOINTS[INDEX[name]][1]][0]]
        self.place(name, multiply(between(apply(parent, sub(REST[tip], REST[name])), direction), parent))

    def arm(self, side, upper, lower, hand):
        self.aim(f"{side} upper arm", f"{side} forearm", upper)
        self.aim(f"{side} forearm", f"{side} hand", lower)
        self.local(f"{side} hand", hand)

    def leg(self, side, ankle, yaw, pitch, toes):
        """The knee bends so that the ankle is where it shall be. `pitch` lowers the tip of the foot, and `toes` that of the
        toes."""
        thigh, shin, foot = (f"{side} {part}" for part in ("thigh", "shin", "foot"))
        self.place(thigh, self.turn["hips"])
        hip = self.at[thigh]
        upper, lower = math.dist(REST[thigh], REST[shin]), math.dist(REST[shin], REST[foot])
        reach = min(math.dist(hip, ankle), 0.9995 * (upper + lower))
        to = unit(sub(ankle, hip))
        forward = apply(about("y", yaw), (0.0, 0.0, 1.0))
        lean = sum(a * b for a, b in zip(to, forward))
        pole = unit([f - lean * t for f, t in zip(forward, to)])
        a = (upper * upper - lower * lower + reach * reach) / (2.0 * reach)
        h = math.sqrt(max(0.0, upper * upper - a * a))
        knee = [o + a * t + h * p for o, t, p in zip(hip, to, pole)]
        end = [o + reach * t for o, t in zip(hip, to)]
        ahead = (0.0, 0.0, 1.0)
        self.place(thigh, multiply(frame(sub(knee, hip), forward), transposed(frame(sub(REST[shin], REST[thigh]), ahead))))
        self.place(shin, multiply(frame(sub(end, knee), forward), transposed(frame(sub(REST[foot], REST[shin]), ahead))))
        self.place(foot, multiply(about("y", yaw), about("x", pitch)))
        self.place(f"{side} toes", multiply(about("y", yaw), about("x", toes)))

    def rotations(self):
        """The quaternion of each joint against its parent."""
        result = []
        for name, parent, _ in JOINTS:
            turn = self.turn[name]
            result.append(quaternion_of(turn if parent is None else multiply(transposed(self.turn[JOINTS[parent][0]]), turn)))
        return result


def standing():
    """The weight on the left leg, the right one in front and bent, the right hand waving."""
    pose = Pose((0.035, 0.936, 0.0), multiply(about("y", 6.0), about("z", 3.5)))
    pose.local("spine", multiply(about("z", -4.5), about("x", 1.0)))
    pose.local("chest", multiply(about("z", -3.0), about("y", -9.0)))
    pose.local("neck", about("z", 3.0))
    pose.local("head", multiply(about("y", 8.0), about("z", 6.0)))
    pose.arm("left", (0.36, -0.92, -0.16), (0.08, -0.93, 0.34), about("z", -6.0))
    pose.arm("right", (-0.90, 0.05, 0.22), (-0.22, 0.95, 0.22), about("x", -6.0))
    pose.leg("left", (0.105, 0.085, -0.03), 8.0, 0.0, 0.0)
    pose.leg("right", (-0.155, 0.085, 0.13), -22.0, 0.0, 0.0)
    return pose


def smooth_step(t):
    return t * t * (3.0 - 2.0 * t)


def through(keys, t):
    """A value between (time, value) pairs, without a corner at them."""
    for (t0, a), (t1, b) in zip(keys, keys[1:]):
        if t <= t1:
            return a + (b - a) * smooth_step((t - t0) / (t1 - t0))
    return keys[-1][1]


PITCH = [(0.0, -16.0), (0.12, 0.0), (0.36, 0.0), (STANCE, 38.0), (0.8, 8.0), (1.0, -16.0)]


def step(phase, stride):
    """Ankle (y, z), pitch of the foot and of its toes, a time after the heel touches the ground."""
    pitch = through(PITCH, phase)
    ankle = (REST["left foot"][1], REST["left foot"][2])
    pivot = REST["left toes"][1:] if pitch > 0.0 else (0.0, -0.085)
    c, s = math.cos(math.radians(pitch)), math.sin(math.radians(pitch))
    dy, dz = ankle[0] - pivot[0], ankle[1] - pivot[1]
    y, z = pivot[0] + c * dy - s * dz, pivot[1] + s * dy + c * dz
    if phase < STANCE:
        return y, z + stride * (1.0 - 2.0 * phase / STANCE), pitch, min(pitch, 0.0)
    swing = (phase - STANCE) / (1.0 - STANCE)
    lift = 0.05 * math.sin(math.pi * swing) ** 2
    return y + lift, z - stride * (1.0 - 2.0 * smooth_step(swing)), pitch, min(pitch, pitch * smooth_step(swing))


def walking(t, stride=STRIDE):
    """The pose at a time in [0, 1], of a loop of two steps on the spot. The ground runs by 2 stride / STANCE in a loop."""
    swing = math.sin(2.0 * math.pi * t + 0.5 * math.pi)  # 1 where the left foot is in front
    pose = Pose((0.012 * math.sin(2.0 * math.pi * t), 0.906 - 0.012 * math.cos(4.0 * math.pi * t), 0.0), about("y", -5.0 * swing))
    pose.local("spine", about("y", spine_yaw(t)))
    pose.local("chest", multiply(about("x", 3.0), about("y", 4.0 * swing)))
    pose.local("neck", about("x", -1.0))
    pose.local("head", about("x", -2.0))
    for side, sign in SIDES:
        y, z, pitch, toes = step((t + (0.0 if sign > 0 else 0.5)) % 1.0, stride)
        pose.leg(side, (sign * 0.095, y, z), sign * 4.0, pitch, toes)
        forward = -sign * swing
        upper = math.radians(24.0 * forward - 2.0)
        lower = math.radians(24.0 * forward + 24.0 + 8.0 * forward)
        pose.arm(side, (sign * 0.24, -math.cos(upper), math.sin(upper)), (sign * 0.06, -math.cos(lower), math.sin(lower)),
                 about("z", -6.0 * sign))
    return pose


SPINE_DEGREES = 5.0


def spine_yaw(t):
    return SPINE_DEGREES * math.cos(2.0 * math.pi * t)


def spine_speed(t):
    """Degrees of spine_yaw() in a second."""
    return -SPINE_DEGREES * 2.0 * math.pi * math.sin(2.0 * math.pi * t)
