"""The clay figure as nodes of a file: its skeleton, its skinned body, and a face that smiles by a morph target."""

import math

import figure_body
import figure_motion
from figure_motion import INDEX, JOINTS
from glb import ARRAY_BUFFER, FLOAT, UNSIGNED_SHORT, pack, round_float
from shapes import merge, sphere, tube

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
    for name, values, more in (("JOINTS_0", joints, {}), ("WEIGHTS_0", shares, {"normalized": True})):
        view = glb.view(pack("B", values), target=ARRAY_BUFFER)
        primitive["attributes"][name] = glb.accessor(view, UNSIGNED_BYTE, len(weights), "VEC4", **more)
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


def joints(glb, pose, root):
    """The nodes of the skeleton in a pose, and their skin. The hips are at the root of the scene if `root` is true."""
    nodes = []
    for (name, parent, at), turn in zip(JOINTS, pose.rotations()):
        place = pose.at["hips"] if parent is None else figure_motion.sub(at, JOINTS[parent][2])
        nodes.append(glb.node(name, at=place, root=root and parent is None, rotation=[round_float(v) for v in turn]))
        if parent is not None:
            glb.doc["nodes"][nodes[parent]].setdefault("children", []).append(nodes[-1])
    inverse = [v for _, _, (x, y, z) in JOINTS for v in (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -x, -y, -z, 1)]
    glb.append("skins", {"name": "figure", "joints": nodes, "skeleton": nodes[0],
                         "inverseBindMatrices": glb.floats(inverse, "MAT4")})
    return nodes


def parts(smile=1.0):
    """(name, mesh, weights) of the body and of the face."""
    body, calm = figure_body.body(), face(smile)
    return [("body", body, [figure_body.weights_of(p) for p in body.positions]),
            ("face", calm, [[(INDEX["head"], 255)]] * len(calm.positions))]


def clay_figure(glb, pose, root=True):
    """Adds the figure, smiling, in a pose. Returns the nodes of its joints; without `root` the first of them needs a
    parent."""
    clay = glb.material("clay", (0.72, 0.40, 0.06), roughness=0.55)
    ink = glb.material("ink", (0.03, 0.02, 0.02), roughness=0.35)
    nodes = joints(glb, pose, root)
    for (name, mesh, weights), material, target in zip(parts(0.0), (clay, ink), (None, face(1.0))):
        item = {"name": name, "primitives": [skinned(glb, mesh, material, weights, target)]}
        if target:
            item["weights"] = [1.0]
            item["extras"] = {"targetNames": ["smile"]}
        glb.node(name, glb.append("meshes", item), skin=0)
    return nodes
