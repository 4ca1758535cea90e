"""A scene of Blender as a glTF file and flags of the program."""

import contextlib
import dataclasses
import math
import os

import bpy
from mathutils import Matrix, Vector

from . import camera, exporter_hooks, gltf_document, lights, materials, passes, world

SOLID = {"MESH", "CURVE", "SURFACE", "META", "FONT"}
SILENT = {"EMPTY", "CAMERA", "LIGHT", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE"}  # nothing of them is lost


class Unusable(Exception):
    """The scene cannot be rendered; the message is for the user."""


@dataclasses.dataclass
class Exported:
    path: str
    flags: list
    holdouts: list  # names of nodes that are cut out
    lens: camera.Lens
    only_clear_media: bool


def export(scene, depsgraph, folder, notes, animated):
    """Writes the scene of a render's depsgraph into the folder. With `animated`, the file has the frames of the scene."""
    view = scene.camera
    if view is None:
        raise Unusable(f"scene '{scene.name}' has no camera: expected one to render from")
    if view.type != "CAMERA":
        raise Unusable(f"'{view.name}' is no camera: expected one to render from")
    path = os.path.join(folder, "scene.gltf")
    with render_levels(scene), exporter_hooks.Tagging():
        _call_exporter(scene, path, animated)
    document = gltf_document.Document(path)
    shown = {instance.object.original.name_full for instance in depsgraph.object_instances}
    nodes = _tagged(document)
    _hide(document, nodes, shown)
    materials.add_default(document)
    materials.patch(document, notes, {m.name_full: m for m in bpy.data.materials}, exporter_hooks.MATERIAL)
    flags, lens = _add_view_and_lights(document, nodes, scene, depsgraph, folder, notes, animated, shown)
    flags += world.flags_of(scene.world, folder, notes)
    if scene.render.film_transparent:
        flags += ["--background", "transparent"]
    holdouts = _objects(nodes, shown, notes, flags, depsgraph)
    flags += passes.flags(depsgraph.view_layer, holdouts)
    passes.complain(depsgraph.view_layer, notes)
    document.save()
    return Exported(path, flags, holdouts, lens, materials.has_only_clear_media(document))


def _call_exporter(scene, path, animated):
    wanted = {"filepath": path, "export_format": "GLTF_SEPARATE", "use_active_scene": True, "use_renderable": True,
              "export_cameras": True, "export_lights": True, "export_apply": True, "export_yup": True, "export_extras": False,
              "export_gn_mesh": True, "export_current_frame": True, "export_animations": animated, "export_frame_range": True,
              "export_animation_mode": "SCENE", "export_force_sampling": True, "export_anim_scene_split_object": False,
              "export_rest_position_armature": False, "export_image_format": "AUTO", "export_keep_originals": False}
    frame = scene.frame_current, scene.frame_subframe  # which the exporter changes where it samples animations
    if not hasattr(bpy.types, "EXPORT_SCENE_OT_gltf"):
        raise Unusable("Blender's glTF exporter is not there: expected the add-on 'glTF 2.0 format' to be enabled")
    known = bpy.ops.export_scene.gltf.get_rna_type().properties.keys()
    windows = bpy.data.window_managers[0].windows  # renders of a command line and timers have none, but the exporter needs one
    override = {"window": bpy.context.window or windows[0]} if len(windows) else {}
    if bpy.context.scene != scene:
        override["scene"] = scene
    try:
        with bpy.context.temp_override(**override):
            bpy.ops.export_scene.gltf(**{name: value for name, value in wanted.items() if name in known})
    except RuntimeError as error:
        lines = [line for line in str(error).strip().splitlines() if not line.startswith((" ", "Location:"))]
        raise Unusable(f"Blender's glTF exporter: {lines[-1]}; expected it to write the scene") from error
    finally:
        if (scene.frame_current, scene.frame_subframe) != frame:
            scene.frame_set(frame[0], subframe=frame[1])
    if not os.path.exists(path):
        raise Unusable("Blender's glTF exporter wrote no file: expected the reason in the console")


@contextlib.contextmanager
def render_levels(scene):
    """The exporter sees the viewport's modifiers; for its time they are those of the render."""
    changed = []

    def change(owner, name, value):
        before = getattr(owner, name)
        if before != value:
            changed.append((owner, name, before))
            setattr(owner, name, value)

    try:
        for thing in scene.objects:
            if thing.library is not None:
                continue
            for modifier in thing.modifiers:
                change(modifier, "show_viewport", modifier.show_render)
                if modifier.type in ("SUBSURF", "MULTIRES"):
                    change(modifier, "levels", modifier.render_levels)
        yield
    finally:
        for owner, name, before in reversed(changed):
            setattr(owner, name, before)


def _tagged(document):
    """Pairs of a node and its object in Blender."""
    objects = {thing.name_full: thing for thing in bpy.data.objects}
    return [(node, objects[name]) for node, name in document.tagged("nodes", exporter_hooks.OBJECT) if name in objects]


def _hide(document, nodes, shown):
    """Objects that the render does not show lose their meshes; their children stay."""
    for node, thing in nodes:
        if thing.name_full not in shown:
            node.pop("mesh", None)
    document.drop_lights()


def _radius(depsgraph):
    """Half of the largest extent of what is rendered, in metres."""
    corners = [instance.matrix_world @ Vector(corner) for instance in depsgraph.object_instances
               if instance.object.type in SOLID for corner in instance.object.bound_box]
    if not corners:
        return 1.0
    return max(0.5 * max(max(c[i] for c in corners) - min(c[i] for c in corners) for i in range(3)), 1e-3)


def _add_view_and_lights(document, nodes, scene, depsgraph, folder, notes, animated, shown):
    view = scene.camera
    node = next((node for node, thing in nodes if thing == view), None) or _own_node(document, view)
    flags, lens = camera.add(document, node, view, scene.render, notes)
    made = lights.Lights(document, folder, notes, lambda thing: lights.in_view(view, thing), _radius(depsgraph), animated)
    foggy = scene.world is not None and world.has_volume(scene.world)
    for node, thing in nodes:
        if thing.type == "LIGHT" and thing.name_full in shown:
            made.add(node, thing, foggy)
    return flags + made.flags, lens


def _own_node(document, view):
    """A camera that is hidden itself has no node of the exporter."""
    matrix = Matrix.Rotation(-0.5 * math.pi, 4, "X") @ view.matrix_world.normalized()
    index = document.add("nodes", {"name": view.name, "matrix": [matrix[row][column] for column in range(4) for row in range(4)]})
    document.json["scenes"][document.json.get("scene", 0)].setdefault("nodes", []).append(index)
    return document.json["nodes"][index]


def _objects(nodes, shown, notes, flags, depsgraph):
    """Catchers of shadows as flags, what the program cannot hide, and the names of the nodes that are cut out."""
    catchers, holdouts = [], []
    for node, thing in nodes:
        if thing.name_full not in shown or thing.type in SILENT:
            continue
        if thing.type not in SOLID:
            notes.add(f"object '{thing.name}'", f"objects of the type {thing.type}")
        if thing.is_shadow_catcher:
            catchers.append(node["name"])
        if thing.is_holdout or thing.evaluated_get(depsgraph).holdout_get(view_layer=depsgraph.view_layer):
            holdouts.append(node["name"])
        for ray in ("camera", "diffuse", "glossy", "transmission", "shadow"):
            if not getattr(thing, f"visible_{ray}", True):
                notes.add(f"object '{thing.name}'", f"being hidden from {ray} rays")
        for system in thing.particle_systems:
            notes.add(f"object '{thing.name}'", "hair" if system.settings.type == "HAIR" else "particles")
    if catchers:
        flags += ["--shadow-catcher", catchers[0]]
        for other in catchers[1:]:
            notes.add(f"object '{other}'", "a second shadow catcher")
    return holdouts
