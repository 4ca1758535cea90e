"""A clay figure with a skeleton: it stands and waves, smiles by a morph target, and has a walk as an animation."""

import math

import figure_body
import figure_motion
from figure_motion import FRAMES, INDEX, JOINTS, REST
from glb import ARRAY_BUFFER, FLOAT, UNSIGNED_SHORT, Glb, pack, quaternion, round_float
from shapes import merge, quad, sphere, surface, tube

UNSIGNED_BYTE = 5121


def face(smile):
    """Eyes, brows and mouth. `smile` from 0 to 1 raises the corners of the mouth and the brows."""
    def line(points, radius):
        last = len(points) - 1
        radii = [radius * math.sqrt(max(0.15, 1.0 - abs(2 * k / last - 1.0) ** 3)) for k in range(last + 1)]
        return tube([(x, y, z - 0.25 * radius) for x, y, z in (figure_body.surface_point(*p) for p in points)], radii, 8)

    def mouth(t):
        return (0.032 + 0.006 * smile) * t, 1.566 + smile * (0.017 * t * t - 0.007)

    pieces = [line([mouth(k / 6.0 - 1.0) for k in range(13)], 0.0055)]
    for sign in (-1.0, 1.0):
        x, y, z = figure_body.surface_point(sign * 0.037, 1.640)
        pieces.append(sphere(0.0125, 14, 10).map(lambda p: (p[0], 1.25 * p[1], 0.6 * p[2]), lambda n: n).moved(x, y, z - 0.001))
        brow = [(sign * (0.020 + 0.034 * k / 6), 1.668 + 0.006 * math.sin(math.pi * k / 6) + 0.007 * smile) for k in range(7)]
        pieces.append(line(brow if sign > 0 else brow[::-1], 0.004))
    return merge(*pieces)


def skinned(glb, mesh, material, weights, target=None):
    """A primitive that is bound to the joints. `target` is the same mesh with other positions and normals."""
    primitive = {**glb.geometry(mesh, material), "material": material}
    primitive["attributes"] = dict(primitive["attributes"])
    joints, shares = [], []
    for pairs in weights:
        padded = list(pairs) + [(0, 0)] * (4 - len(pairs))
        joints += [joint for joint, _ in padded]
        shares += [weight for _, weight in padded]
    for name, values, normalized in (("JOINTS_0", joints, False), ("WEIGHTS_0", shares, True)):
        accessor = {"bufferView": glb.view(pack("B", values), target=ARRAY_BUFFER), "componentType": UNSIGNED_BYTE,
                    "count": len(weights), "type": "VEC4"}
        if normalized:
            accessor["normalized"] = True
        primitive["attributes"][name] = glb.append("accessors", accessor)
    if target:
        primitive["targets"] = [{"POSITION": sparse(glb, mesh.positions, target.positions),
                                 "NORMAL": sparse(glb, mesh.normals, target.normals)}]
    return primitive


def sparse(glb, old, new):
    """The differences of vectors, only where they are not zero."""
    deltas = [[round_float(b - a) for a, b in zip(p, q)] for p, q in zip(old, new)]
    moved = [k for k, d in enumerate(deltas) if any(d)]
    values = [v for k in moved for v in deltas[k]]
    bounds = {"min": [min(0.0, *values[k::3]) for k in range(3)], "max": [max(0.0, *values[k::3]) for k in range(3)]}
    return glb.append("accessors", {
        "componentType": FLOAT, "count": len(deltas), "type": "VEC3", **bounds,
        "sparse": {"count": len(moved), "indices": {"bufferView": glb.view(pack("H", moved)), "componentType": UNSIGNED_SHORT},
                   "values": {"bufferView": glb.view(pack("f", values))}}})


def floats(glb, values, kind, **bounds):
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[kind]
    rounded = [round_float(v) for v in values]
    return glb.append("accessors", {"bufferView": glb.view(pack("f", rounded)), "componentType": FLOAT,
                                    "count": len(rounded) // width, "type": kind, **bounds})


def joints(glb, pose):
    """The nodes of the skeleton in a pose, and their skin."""
    nodes = []
    for (name, parent, at), turn in zip(JOINTS, pose.rotations()):
        place = pose.at["hips"] if parent is None else figure_motion.sub(at, JOINTS[parent][2])
        nodes.append(glb.node(name, at=place, root=parent is None, rotation=[round_float(v) for v in turn]))
        if parent is not None:
            glb.doc["nodes"][nodes[parent]].setdefault("children", []).append(nodes[-1])
    inverse = [v for _, _, (x, y, z) in JOINTS for v in (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -x, -y, -z, 1)]
    glb.append("skins", {"name": "figure", "joints": nodes, "skeleton": nodes[0],
                         "inverseBindMatrices": floats(glb, inverse, "MAT4")})
    return nodes


def walk(glb, nodes):
    """24 frames of a second: rotations at each frame, but a cubic spline of five keys for the spine."""
    def times(count):
        return floats(glb, [k / count for k in range(count + 1)], "SCALAR", min=[0.0], max=[1.0])

    every, quarters = times(FRAMES), times(4)
    poses = [figure_motion.walking(k / FRAMES) for k in range(FRAMES + 1)]
    rotations = [pose.rotations() for pose in poses]
    samplers, channels = [], []

    def add(node, path, keys, values, kind, interpolation):
        channels.append({"sampler": len(samplers), "target": {"node": node, "path": path}})
        samplers.append({"input": keys, "interpolation": interpolation, "output": floats(glb, values, kind)})

    add(nodes[0], "translation", every, [v for pose in poses for v in pose.at["hips"]], "VEC3", "LINEAR")
    for k, (name, _, _) in enumerate(JOINTS):
        if name != "spine":
            add(nodes[k], "rotation", every, [v for frame in rotations for v in frame[k]], "VEC4", "LINEAR")
    keys = []
    for t in (0.0, 0.25, 0.5, 0.75, 1.0):
        half, speed = math.radians(figure_motion.spine_yaw(t)) / 2, math.radians(figure_motion.spine_speed(t)) / 2
        tangent = [0.0, speed * math.cos(half), 0.0, -speed * math.sin(half)]
        keys += [*tangent, *quaternion(figure_motion.spine_yaw(t), 0.0), *tangent]
    add(nodes[INDEX["spine"]], "rotation", quarters, keys, "VEC4", "CUBICSPLINE")
    glb.append("animations", {"name": "walk", "samplers": samplers, "channels": channels})


def posed_bounds(pose, mesh, weights):
    """The corners of the posed vertices, by the same sums as a renderer's, in double precision."""
    corners = []
    for p, pairs in zip(mesh.positions, weights):
        moved = [0.0, 0.0, 0.0]
        for joint, weight in pairs:
            name = JOINTS[joint][0]
            at = figure_motion.add(figure_motion.apply(pose.turn[name], figure_motion.sub(p, REST[name])), pose.at[name])
            moved = [m + weight / 255.0 * v for m, v in zip(moved, at)]
        corners.append(moved)
    return [[round(limit(c[k] for c in corners), 4) for k in range(3)] for limit in (min, max)]


def stage(glb):
    """A floor that bends up to a wall, two soft lamps in front and one behind."""
    def wall(u, v):
        bend, radius, depth = 0.5 * math.pi, 1.2, 2.6
        length = depth + 1.6, radius * bend, 3.0
        s = v * sum(length)
        if s < length[0]:
            return 7.0 - 14.0 * u, 0.0, 1.6 - s
        s -= length[0]
        if s < length[1]:
            return 7.0 - 14.0 * u, radius * (1.0 - math.cos(s / radius)), -depth - radius * math.sin(s / radius)
        return 7.0 - 14.0 * u, radius + s - length[1], -depth - radius
    glb.place("stage", surface(1, 60, lambda u, v: wall(1.0 - u, v)), glb.material("stage", (0.50, 0.58, 0.62), roughness=0.9))
    for name, corner, u, v, color, strength in (
            ("key", (-2.6, 1.3, 2.2), (0.25, 1.3, -0.35), (1.1, 0.0, 0.8), (1.0, 0.93, 0.84), 20.0),
            ("fill", (2.2, 0.6, 2.4), (0.7, 0.0, -1.3), (0.0, 1.6, 0.0), (0.80, 0.90, 1.0), 3.5),
            ("rim", (2.1, 3.3, -1.6), (-0.9, 0.0, -0.6), (0.25, -0.5, 0.5), (1.0, 0.95, 0.9), 30.0)):
        lamp = glb.material(f"{name} lamp", (0.0, 0.0, 0.0), emission=color, strength=strength)
        glb.place(f"{name} lamp", quad(corner, u, v), lamp)


def build(path, pose=None):
    """`pose` is that of the nodes."""
    pose = pose or figure_motion.standing()
    glb = Glb("figure")
    stage(glb)
    clay = glb.material("clay", (0.72, 0.40, 0.06), roughness=0.55)
    ink = glb.material("ink", (0.03, 0.02, 0.02), roughness=0.35)
    body, calm, smiling = figure_body.body(), face(0.0), face(1.0)
    weights = [figure_body.weights_of(p) for p in body.positions]
    on_head = [[(INDEX["head"], 255)]] * len(calm.positions)
    nodes = joints(glb, pose)
    for name, primitive in (("body", skinned(glb, body, clay, weights)), ("face", skinned(glb, calm, ink, on_head, smiling))):
        mesh = {"name": name, "primitives": [primitive]}
        if "targets" in primitive:
            mesh["weights"] = [1.0]
            mesh["extras"] = {"targetNames": ["smile"]}
        glb.node(name, glb.append("meshes", mesh), skin=0)
    walk(glb, nodes)
    glb.doc["asset"]["extras"]["posed_bounds"] = {
        "body": posed_bounds(pose, body, weights), "face": posed_bounds(pose, smiling, on_head)}
    glb.camera("camera", (0.25, 1.15, 4.6), (-0.02, 0.90, 0.0), 25.5, aspect=None)
    glb.write(path)
