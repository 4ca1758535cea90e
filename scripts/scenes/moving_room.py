"""A room for watching animations, each of two seconds and of things of its own: a door that lets in light, a lamp that
swings, the same lamp switched off, a mirror that turns, a flag, the clay figure that walks, and a second camera."""

import math

import figure_motion
from animations import Animation, times, turn_key
from clay_figure import clay_figure
from figure_motion import JOINTS, STANCE
from glb import Glb, quaternion
from moving_room_shell import BACK, DOORWAY, HEIGHT, corridor, planks, shell, table
from shapes import lathe, merge, quad, rounded_box, sphere, tube
from waving_flag import waving_flag, weights

SECONDS, FPS = 2.0, 24
BULB = 320.0  # radiance
WALK = (-1.3, 0.3, -1.0)  # from x to x, and z
CYCLES = 2
STEP = (-0.9, 2.9, 1.4)  # of the second camera: x, and from z to z


def materials(glb):
    new = glb.material
    wood = glb.texture("planks", planks())
    return {
        "floor": new("planks", (1.0, 1.0, 1.0), roughness=0.6, base_texture=wood),
        "white": new("white plaster", (0.78, 0.75, 0.70), roughness=0.9),
        "red": new("red plaster", (0.60, 0.13, 0.07), roughness=0.9),
        "blue": new("blue plaster", (0.07, 0.24, 0.42), roughness=0.9),
        "corridor": new("yellow plaster", (0.66, 0.52, 0.28), roughness=0.9),
        "frame": new("white wood", (0.75, 0.74, 0.71), roughness=0.5),
        "door": new("green wood", (0.16, 0.34, 0.22), roughness=0.5),
        "brass": new("brass", (0.90, 0.68, 0.34), metallic=1.0, roughness=0.5),
        "wood": new("walnut", (0.25, 0.13, 0.07), roughness=0.5),
        "blue glaze": new("blue glaze", (0.06, 0.16, 0.45), roughness=0.5),
        "yellow": new("yellow", (0.80, 0.55, 0.06), roughness=0.55),
        "green": new("green", (0.20, 0.50, 0.12), roughness=0.7),
        "shade": new("teal lacquer", (0.05, 0.28, 0.28), roughness=0.5),
        "lining": new("white lining", (0.85, 0.83, 0.78), roughness=0.8),
        "cord": new("cord", (0.03, 0.03, 0.03), roughness=0.8),
        "mirror": new("mirror", (1.0, 1.0, 1.0), metallic=1.0, roughness=0.0),
        "cream cloth": new("cream cloth", (0.80, 0.74, 0.60), roughness=0.9, double_sided=True),
        "red cloth": new("red cloth", (0.62, 0.04, 0.05), roughness=0.9, double_sided=True),
        "bulb": new("bulb", (0.0, 0.0, 0.0), emission=(1.0, 0.74, 0.44), strength=BULB),
        "panel": new("ceiling panel", (0.0, 0.0, 0.0), emission=(0.88, 0.95, 1.0), strength=170.0),
        "fill": new("fill panel", (0.0, 0.0, 0.0), emission=(0.85, 0.90, 1.0), strength=3.6),
    }


def eased(animation, keys, node, start, end):
    """A turn about y by a cubic spline of five keys, that begins and ends at rest."""
    values = []
    for k in range(5):
        t = k / 4
        values += turn_key(start + (end - start) * figure_motion.smooth_step(t),
                           (end - start) * 6.0 * t * (1.0 - t) / SECONDS)
    animation.move(node, "rotation", keys, values, "CUBICSPLINE")


def door(glb, paint):
    """A door with its hinge at the origin of its node; it opens into the room."""
    a, b, top = DOORWAY
    width, height = b - a - 0.006, top - 0.010
    slab = rounded_box((width, height, 0.04), 0.003, 1, 3).moved(-width / 2 - 0.003, height / 2 + 0.006, -0.02)
    panels = [rounded_box((0.66, h, 0.056), 0.008, 1).moved(-width / 2 - 0.003, y, -0.02)
              for y, h in ((0.62, 0.80), (1.54, 0.76))]
    knob = merge(*(sphere(0.028, 20, 12).moved(-width + 0.06, 1.04, z) for z in (-0.085, 0.045)),
                 tube([(-width + 0.06, 1.04, -0.08), (-width + 0.06, 1.04, 0.04)], 0.010, 12))
    mesh = glb.mesh("door", (merge(slab, *panels), paint["door"]), (knob, paint["brass"]))
    return glb.node("door", mesh, at=(b, 0.0, BACK + 0.014), rotation=[0.0, 0.0, 0.0, 1.0])


def lamp(glb, paint, at):
    """A pendant lamp. Its node is where the cord begins."""
    low, high = -0.74, -0.57
    outer = [(0.205 - 0.15 * (k / 6) ** 1.6, low + (high - low) * k / 6) for k in range(7)]
    inner = [(r - 0.004, y) for r, y in reversed(outer)]
    cord = tube([(0.0, 0.0, 0.0), (0.0, -0.25, 0.0), (0.0, low + 0.075, 0.0)], 0.006, 8)
    struts = merge(*(tube([(0.0, high + 0.02, 0.0), (0.054 * s, high - 0.003, 0.054 * c)], 0.003, 6)
                     for s, c in ((0.0, 1.0), (0.866, -0.5), (-0.866, -0.5))))
    socket = lathe([(0.0, low + 0.06), (0.022, low + 0.06), (0.022, low + 0.11), (0.0, low + 0.11)], 20)
    bulb = sphere(0.055, 20, 12).moved(0.0, low + 0.015, 0.0)
    mesh = glb.mesh("lamp", (lathe(outer, 40), paint["shade"]), (lathe(inner, 40), paint["lining"]),
                    (merge(cord, struts, socket), paint["cord"]), (bulb, paint["bulb"]))
    return glb.node("lamp", mesh, at=at, rotation=[0.0, 0.0, 0.0, 1.0])


def mirror(glb, paint, at, turn):
    width, height, low = 0.68, 1.55, 0.16
    back = rounded_box((width + 0.06, height + 0.06, 0.035), 0.006, 2).moved(0.0, low + height / 2, 0.0)
    foot = lathe([(0.0, 0.0), (0.26, 0.0), (0.26, 0.018), (0.03, 0.04), (0.03, 0.16), (0.0, 0.16)], 40)
    glass = quad((-width / 2, low, 0.0185), (width, 0.0, 0.0), (0.0, height, 0.0))
    return glb.node("mirror", glb.mesh("mirror", (merge(back, foot), paint["wood"]), (glass, paint["mirror"])),
                    at=at, turn=turn)


def flag(glb, paint, at, turn):
    x, y, z = at
    pole = merge(lathe([(0.0, 0.0), (0.19, 0.0), (0.19, 0.015), (0.03, 0.05), (0.014, 0.07), (0.014, 2.06), (0.0, 2.06)], 32),
                 sphere(0.03, 20, 12).moved(0.0, 2.08, 0.0))
    glb.place("flag pole", pole, paint["wood"], at=at)
    return waving_flag(glb, (paint["cream cloth"], paint["red cloth"]), at=(x, y + 2.0, z), turn=turn)


def walk(glb, frames):
    """The figure crosses the room. Its stride is such that the foot on the ground stays where it is."""
    x0, x1, z = WALK
    stride = abs(x1 - x0) / CYCLES * STANCE / 2
    poses = [figure_motion.walking(k * CYCLES / (SECONDS * FPS) % 1.0, stride) for k in range(round(SECONDS * FPS) + 1)]
    nodes = clay_figure(glb, poses[0], root=False)
    walker = glb.node("walker", at=(x0, 0.0, z), turn=90.0, children=[nodes[0]])
    animation = Animation(glb, "walk")
    animation.move(walker, "translation", times(glb, [0.0, SECONDS]), [x0, 0.0, z, x1, 0.0, z])
    animation.move(nodes[0], "translation", frames, [v for pose in poses for v in pose.at["hips"]])
    rotations = [pose.rotations() for pose in poses]
    for k in range(len(JOINTS)):
        animation.move(nodes[k], "rotation", frames, [v for turns in rotations for v in turns[k]])


def walk_camera(glb):
    """A camera that goes forward while it turns from the door to the flag."""
    x, z0, z1 = STEP
    turns = [quaternion(degrees, -4.0) for degrees in (-12.0, 8.0)]
    node = glb.node("walk-camera", camera=glb.perspective("walk-camera", 50.0), at=(x, 1.5, z0), turn=-12.0, tilt=-4.0)
    animation, ends = Animation(glb, "camera"), times(glb, [0.0, SECONDS])
    animation.move(node, "translation", ends, [x, 1.5, z0, x, 1.5, z1])
    animation.move(node, "rotation", ends, [v for turn in turns for v in turn])


def build(path):
    glb = Glb("moving room")
    paint = materials(glb)
    shell(glb, paint)
    corridor(glb, paint)
    table(glb, paint, (0.85, 0.0, 0.75))
    seconds = [k / FPS for k in range(round(SECONDS * FPS) + 1)]
    frames, quarters = times(glb, seconds), times(glb, [SECONDS * k / 4 for k in range(5)])

    eased(Animation(glb, "door"), quarters, door(glb, paint), 0.0, 100.0)
    swings = [math.radians(25.0) * math.sin(2.0 * math.pi * t) / 2 for t in seconds]
    Animation(glb, "lamp").move(lamp(glb, paint, (-0.75, HEIGHT, 0.0)), "rotation", frames,
                                [v for half in swings for v in (0.0, 0.0, math.sin(half), math.cos(half))])
    Animation(glb, "lamp-off").change(
        f"/materials/{paint['bulb']}/extensions/KHR_materials_emissive_strength/emissiveStrength",
        times(glb, [0.0, SECONDS / 2, SECONDS]), [BULB, 0.0, 0.0], "STEP")
    eased(Animation(glb, "mirror"), quarters, mirror(glb, paint, (2.1, 0.0, -1.05), -75.0), -75.0, -15.0)
    Animation(glb, "flag").move(flag(glb, paint, (-2.6, 0.0, -1.9), -35.0), "weights", frames,
                                [w for t in seconds for w in weights(t)])
    walk(glb, frames)
    glb.camera("camera", (0.2, 1.55, 3.1), (0.0, 1.12, -1.0), 47.0, aspect=None)
    walk_camera(glb)
    glb.write(path)
