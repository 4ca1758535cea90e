"""Whether a scene's animation can be one run of the program, and which frames that run has."""

import sys

import bpy

# Modifiers whose result stays the same while nothing else changes, and those that glTF has itself.
STEADY = {"ARMATURE", "ARRAY", "BEVEL", "BOOLEAN", "DECIMATE", "EDGE_SPLIT", "MASK", "MIRROR", "MULTIRES", "REMESH", "SCREW", "SKIN",
          "SMOOTH", "SOLIDIFY", "SUBSURF", "TRIANGULATE", "UV_PROJECT", "UV_WARP", "WEIGHTED_NORMAL", "WELD", "WIREFRAME"}
MOVING = ("location", "rotation", "scale", "delta_", "pose.bones", "key_blocks")


def frames(scene):
    return range(scene.frame_start, scene.frame_end + 1, scene.frame_step)


def is_whole(engine, scene):
    """Whether Blender renders the frames of the scene one after the other, and this is the first. -f on a command line names
    single frames."""
    single = bpy.app.background and any(word in ("-f", "--render-frame") for word in sys.argv)
    return engine.is_animation and not single and scene.frame_current == scene.frame_start and len(frames(scene)) > 1


def obstacle(scene):
    """What of the scene's animation glTF cannot hold, in a few words; None if all can be one file."""
    if scene.camera is None or scene.camera.type != "CAMERA":
        return "a scene without a camera"
    if scene.frame_start < 0:
        return "frames below zero"
    if scene.render.frame_map_old != scene.render.frame_map_new:
        return "stretched time"
    if any(marker.camera for marker in scene.timeline_markers):
        return "cameras that change at markers"
    if scene.camera.data.dof.use_dof and scene.camera.data.dof.focus_object:
        return "a focus that follows an object"
    for owner in (scene, scene.world, scene.world.node_tree if scene.world else None):
        if owner is not None and _paths(owner):
            return f"the animation of '{owner.name}'"
    for thing in scene.objects:
        found = _obstacle_of(thing)
        if found:
            return f"{found} of object '{thing.name}'"
    return None


def _obstacle_of(thing):
    for path in _paths(thing):
        if not path.startswith(MOVING):
            return f"the animated property '{path}'"
    if thing.particle_systems or thing.rigid_body or thing.soft_body:
        return "the simulation"
    for modifier in thing.modifiers:
        if modifier.show_render and modifier.type not in STEADY:
            return f"the modifier '{modifier.name}'"
    data = thing.data
    for owner in (data, getattr(data, "node_tree", None), *(slot.material.node_tree for slot in thing.material_slots if slot.material)):
        paths = _paths(owner)
        if paths:
            return f"the animated property '{paths[0]}'"
    return None


def _paths(owner):
    """The animated properties of a data block, by keys and by drivers."""
    data = getattr(owner, "animation_data", None)
    if data is None:
        return []
    actions = [data.action, *(strip.action for track in data.nla_tracks for strip in track.strips)]
    curves = [curve for action in actions if action for curve in _curves(action)]
    return [curve.data_path for curve in [*curves, *data.drivers]]


def _curves(action):
    """All curves of an action; those of other slots count too."""
    layers = getattr(action, "layers", None)
    if not layers:
        return action.fcurves
    return [curve for layer in layers for strip in layer.strips for bag in strip.channelbags for curve in bag.fcurves]
