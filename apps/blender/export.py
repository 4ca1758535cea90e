"""A scene of Blender as a glTF file and flags of the program."""

import contextlib
import dataclasses
import math
import os

import bpy
from mathutils import Matrix, Vector

from . import camera, exporter_hooks, gltf_document, lights, materials, passes, visibility, world

SOLID = {"MESH", "CURVE", "SURFACE", "META", "FONT"}
SILENT = {"EMPTY", "CAMERA", "LIGHT", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE"}  # nothing of them is lost


class Unusable(Exception):
    """The scene cannot be rendered; the message is for the user."""


@dataclasses.dataclass
class Placed:
    """A node of the file, its object in Blender, what places that (visibility.holder_of), and whether the render shows it."""
    node: dict
    thing: bpy.types.Object
    holder: bpy.types.Object
    shown: bool
    indices: list  # of the node, and of those of its geometry nodes


@dataclasses.dataclass
class Exported:
    path: str
    flags: list
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
        _call_exporter(scene, depsgraph.view_layer, path, animated)
    document = gltf_document.Document(path)
    placed = _placed(document, depsgraph)
    document.drop_lights()
    materials.add_default(document)
    materials.patch(document, notes, {m.name_full: m for m in bpy.data.materials}, exporter_hooks.MATERIAL)
    corners = _corners(depsgraph)
    node = next((place.node for place in placed if place.thing == view), None) or _own_node(document, view)
    flags, lens = camera.add(document, node, view, scene.render, corners, notes)
    used_world = scene.world if depsgraph.view_layer.use_sky else None
    made = lights.Lights(document, folder, notes, _radius(corners), world.has_volume(used_world))
    _add_objects(document, placed, made, depsgraph.view_layer, notes)
    flags += made.flags + world.flags_of(used_world, folder, notes) + passes.flags(depsgraph.view_layer)
    document.extend(document.scene, visibility.VISIBILITY, visibility.of_world(used_world))
    if scene.render.film_transparent:
        flags += ["--background", "transparent"]
    passes.complain(depsgraph.view_layer, notes)
    document.save()
    return Exported(path, flags, lens, materials.has_only_clear_media(document))


def _call_exporter(scene, view_layer, path, animated):
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
    if bpy.context.view_layer != view_layer:
        override.update(scene=view_layer.id_data, view_layer=view_layer)
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
    """The exporter sees the viewport's objects and modifiers; for its time they are those of the render."""
    changed = []

    def change(owner, name, value):
        before = getattr(owner, name)
        if before != value:
            changed.append((owner, name, before))
            setattr(owner, name, value)

    try:
        for hidden in (*scene.collection.children_recursive, *scene.objects):
            if hidden.library is None and not hidden.hide_render:
                change(hidden, "hide_viewport", False)
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


def _placed(document, depsgraph):
    """All nodes of objects. Those that the render does not show lose their meshes; their children stay."""
    pairs = {(thing, visibility.holder_of(thing, [holder])) for thing, holder in
             ((instance.object.original, (instance.parent or instance.object).original) for instance in depsgraph.object_instances)}
    objects = {thing.name_full: thing for thing in bpy.data.objects}
    nodes = document.list_of("nodes")
    things = [objects.get(node.get("extras", {}).get(exporter_hooks.OBJECT)) for node in nodes]
    parents = {child: index for index, node in enumerate(nodes) for child in node.get("children", ())}

    def above(index):
        while (index := parents.get(index)) is not None:
            if things[index]:
                yield things[index]

    found = []
    for index, (node, thing) in enumerate(zip(nodes, things)):
        if thing:
            holder = visibility.holder_of(thing, above(index))
            shown = (thing, holder) in pairs
            found.append(Placed(node, thing, holder, shown, [index, *(child for child in node.get("children", ()) if not things[child])]))
            if not shown:
                node.pop("mesh", None)
    return found


def _corners(depsgraph):
    """Those of the bounds of what is rendered."""
    return [instance.matrix_world @ Vector(corner) for instance in depsgraph.object_instances
            if instance.object.type in SOLID for corner in instance.object.bound_box]


def _radius(corners):
    """Half of their largest extent, in metres."""
    if not corners:
        return 1.0
    return max(0.5 * max(max(c[i] for c in corners) - min(c[i] for c in corners) for i in range(3)), 1e-3)


def _own_node(document, view):
    """A camera that is hidden itself has no node of the exporter."""
    matrix = Matrix.Rotation(-0.5 * math.pi, 4, "X") @ view.matrix_world.normalized()
    index = document.add("nodes", {"name": view.name, "matrix": [matrix[row][column] for column in range(4) for row in range(4)]})
    document.scene.setdefault("nodes", []).append(index)
    return document.json["nodes"][index]


def _add_objects(document, placed, made, view_layer, notes):
    """Lights, and what the exporter leaves out of objects."""
    indices = {}
    for place in placed:
        for name in (place.thing.name_full, place.holder.name_full):
            indices.setdefault(name, set()).update(place.indices)
    for place in placed:
        thing, links = place.thing, visibility.links_of(place.thing, indices)
        if thing.type == "LIGHT" and place.shown:
            made.add(place.node, thing, {visibility.VISIBILITY: visibility.of_lamp(thing), visibility.LINKS: links})
        if thing.type in SILENT:
            continue
        seen = visibility.of_object(thing, place.holder, view_layer)
        for index in place.indices:
            document.extend(document.json["nodes"][index], visibility.VISIBILITY, seen)
            document.extend(document.json["nodes"][index], visibility.LINKS, links)
        if place.shown and thing.type not in SOLID:
            notes.add(f"object '{thing.name}'", f"objects of the type {thing.type}")
        for system in thing.particle_systems if place.shown else ():
            notes.add(f"object '{thing.name}'", "hair" if system.settings.type == "HAIR" else "particles")
