"""A clay figure with a skeleton: it stands and waves, smiles by a morph target, and has a walk as an animation."""

import math

import figure_motion
from animations import Animation, times, turn_key
from clay_figure import clay_figure, parts
from figure_motion import FRAMES, INDEX, JOINTS, REST
from glb import Glb
from shapes import quad, surface


def walk(glb, nodes):
    """24 frames of a second: rotations at each frame, but a cubic spline of five keys for the spine."""
    every, quarters = (times(glb, [k / count for k in range(count + 1)]) for count in (FRAMES, 4))
    poses = [figure_motion.walking(k / FRAMES) for k in range(FRAMES + 1)]
    rotations = [pose.rotations() for pose in poses]
    animation = Animation(glb, "walk")
    animation.move(nodes[0], "translation", every, [v for pose in poses for v in pose.at["hips"]])
    for k, (name, _, _) in enumerate(JOINTS):
        if name != "spine":
            animation.move(nodes[k], "rotation", every, [v for frame in rotations for v in frame[k]])
    keys = [turn_key(figure_motion.spine_yaw(t), figure_motion.spine_speed(t)) for t in (0.0, 0.25, 0.5, 0.75, 1.0)]
    animation.move(nodes[INDEX["spine"]], "rotation", quarters, [v for key in keys for v in key], "CUBICSPLINE")


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


def build(path):
    pose = figure_motion.standing()
    glb = Glb("figure")
    stage(glb)
    walk(glb, clay_figure(glb, pose))
    glb.doc["asset"]["extras"]["posed_bounds"] = {
        name: posed_bounds(pose, mesh, weights) for name, mesh, weights in parts()}
    glb.camera("camera", (0.25, 1.15, 4.6), (-0.02, 0.90, 0.0), 25.5, aspect=None)
    glb.write(path)
