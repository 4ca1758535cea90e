"""Scenes of Blender that are rendered in two engines: lights, worlds, cameras, materials, and what else a scene may have."""

import math

import bpy
import numpy

LIGHTS, PRINCIPLED = 0.02, 0.05  # how far the means may differ


def material(name, color=(0.8, 0.8, 0.8), kind="ShaderNodeBsdfDiffuse", **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes = made.node_tree.nodes
    nodes.clear()
    shader, output = nodes.new(kind), nodes.new("ShaderNodeOutputMaterial")
    socket = next((shader.inputs[n] for n in ("Base Color", "Color") if n in shader.inputs), None)
    if socket is not None:
        socket.default_value = (*color, 1.0)
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    made.node_tree.links.new(shader.outputs[0], output.inputs["Volume" if "Volume" in kind else "Surface"])
    return made


def principled(name, color=(0.8, 0.8, 0.8), **inputs):
    return material(name, color, "ShaderNodeBsdfPrincipled", **inputs)


def thing(data, at=(0.0, 0.0, 0.0), turn=(0.0, 0.0, 0.0)):
    made = bpy.data.objects.new(data.name, data)
    made.location, made.rotation_euler = at, [math.radians(angle) for angle in turn]
    bpy.context.scene.collection.objects.link(made)
    return made


def place(made, shader, smooth=False):
    """The object that an operator has just made, with a material."""
    made.data.materials.append(shader)
    if smooth:
        for polygon in made.data.polygons:
            polygon.use_smooth = True
    return made


def ball(shader, at, radius=0.8):
    bpy.ops.mesh.primitive_uv_sphere_add(radius=radius, location=at, segments=48, ring_count=24)
    return place(bpy.context.object, shader, True)


def box(shader, at, size=1.4):
    bpy.ops.mesh.primitive_cube_add(size=size, location=at)
    return place(bpy.context.object, shader)


def floor(shader=None):
    bpy.ops.mesh.primitive_plane_add(size=10.0)
    return place(bpy.context.object, shader or material("floor"))


def stage(first=None, second=None):
    """A floor, a box and a ball, and the camera."""
    floor()
    camera()
    cube = box(first or material("red", (0.7, 0.2, 0.1)), (-1.1, 0.0, 0.72))
    return cube, ball(second or material("blue", (0.1, 0.3, 0.7)), (1.1, 0.0, 0.8))


def camera(**values):
    data = bpy.data.cameras.new("camera")
    for name, value in values.items():
        setattr(data, name, value)
    made = thing(data, (0.0, -7.0, 4.0), (62.0, 0.0, 0.0))
    bpy.context.scene.camera = made
    return made


def lamp(kind, at, turn=(0.0, 0.0, 0.0), hidden=False, **values):
    data = bpy.data.lights.new(kind.lower(), kind)
    for name, value in values.items():
        setattr(data, name, value)
    made = thing(data, at, turn)
    made.visible_camera = not hidden
    return made


def world(color=(0.0, 0.0, 0.0), strength=1.0):
    made = bpy.data.worlds.new("world")
    bpy.context.scene.world = made
    made.use_nodes = True
    background = made.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*color, 1.0)
    background.inputs["Strength"].default_value = strength
    return made, background


def point_lights():
    stage()
    lamp("POINT", (-2.0, -1.0, 3.0), energy=200.0, shadow_soft_size=0.0, color=(1.0, 0.8, 0.6))
    lamp("POINT", (2.5, -1.0, 1.0), energy=100.0, shadow_soft_size=0.3, use_soft_falloff=False)


def hidden_point_lights():
    stage()
    lamp("POINT", (0.0, 0.5, 1.6), hidden=True, energy=200.0, shadow_soft_size=0.2, use_soft_falloff=False)


def spot_lights():
    stage()
    lamp("SPOT", (-2.0, -2.0, 4.0), (25.0, -25.0, 0.0), energy=800.0, spot_size=1.0, spot_blend=0.7, shadow_soft_size=0.0)
    lamp("SPOT", (2.0, -1.0, 4.0), (10.0, 20.0, 0.0), energy=400.0, spot_size=0.8, spot_blend=0.1, shadow_soft_size=0.2)


def suns():
    stage()
    lamp("SUN", (0.0, 0.0, 3.0), (40.0, 20.0, 0.0), energy=3.0, angle=0.0)
    lamp("SUN", (0.0, 0.0, 3.0), (30.0, -40.0, 0.0), energy=2.0, angle=0.2, color=(0.5, 0.7, 1.0))


def area_lights():
    stage()
    lamp("AREA", (-3.0, 0.0, 3.0), (0.0, -40.0, 0.0), energy=150.0, shape="RECTANGLE", size=2.0, size_y=0.5)
    lamp("AREA", (3.0, -1.0, 3.0), (0.0, 40.0, 0.0), energy=100.0, shape="DISK", size=1.0)
    lamp("AREA", (0.0, 2.5, 3.0), (-50.0, 0.0, 0.0), hidden=True, energy=100.0, shape="ELLIPSE", size=1.0, size_y=0.5)


def world_color():
    stage()
    world((0.3, 0.5, 0.8), 1.5)


def world_picture():
    """A picture with a bright spot off its middle, turned."""
    stage()
    made, background = world(strength=0.8)
    pixels = numpy.full((64, 128, 4), 0.2, numpy.float32)
    pixels[40:52, 20:40, :3] = (20.0, 15.0, 5.0)
    pixels[44:56, 90:96, :3] = (2.0, 15.0, 30.0)
    image = bpy.data.images.new("sky", 128, 64, float_buffer=True)
    image.pixels.foreach_set(pixels.reshape(-1))
    nodes, links = made.node_tree.nodes, made.node_tree.links
    texture, mapping, place_of = (nodes.new(f"ShaderNode{kind}") for kind in ("TexEnvironment", "Mapping", "TexCoord"))
    texture.image = image
    mapping.inputs["Rotation"].default_value = (0.0, 0.0, math.radians(70.0))
    links.new(place_of.outputs["Generated"], mapping.inputs["Vector"])
    links.new(mapping.outputs[0], texture.inputs["Vector"])
    links.new(texture.outputs[0], background.inputs["Color"])


def world_sky(elevation=35.0):
    stage()
    made, background = world(strength=0.1)
    sky = made.node_tree.nodes.new("ShaderNodeTexSky")
    sky.sun_elevation, sky.sun_rotation = math.radians(elevation), math.radians(130.0)
    made.node_tree.links.new(sky.outputs[0], background.inputs["Color"])


def _lit_stage(*shaders):
    stage(*shaders)
    world((0.4, 0.4, 0.4))
    lamp("AREA", (-3.0, -2.0, 4.0), (30.0, -30.0, 0.0), energy=200.0, size=1.5)


def shifted_camera():
    _lit_stage()
    data = bpy.context.scene.camera.data
    data.lens, data.shift_x, data.shift_y = 40.0, 0.15, -0.1


def orthographic_camera():
    _lit_stage()
    data = bpy.context.scene.camera.data
    data.type, data.ortho_scale, data.shift_x = "ORTHO", 5.0, 0.1


def blurred_camera():
    _lit_stage()
    lens = bpy.context.scene.camera.data.dof
    lens.use_dof, lens.aperture_fstop, lens.focus_distance = True, 0.1, 5.0


def panorama_camera():
    _lit_stage()
    bpy.context.scene.camera.location = (0.0, -2.5, 1.5)
    data = bpy.context.scene.camera.data
    data.type = "PANO"
    (data if hasattr(data, "panorama_type") else data.cycles).panorama_type = "EQUIRECTANGULAR"
    bpy.context.scene.render.resolution_x = 2 * bpy.context.scene.render.resolution_y


def principled_rough():
    _lit_stage(principled("red", (0.7, 0.2, 0.1), Roughness=0.4), principled("blue", (0.1, 0.3, 0.7), Roughness=0.8))


def principled_metal():
    _lit_stage(principled("gold", (0.9, 0.6, 0.2), Metallic=1.0, Roughness=0.3),
               principled("steel", (0.6, 0.6, 0.6), Metallic=1.0, Roughness=0.1))


def principled_coat():
    _lit_stage(principled("coat", (0.5, 0.1, 0.1), Coat_Weight=1.0, Coat_Roughness=0.05),
               principled("sheen", (0.2, 0.2, 0.3), Sheen_Weight=0.8))


def principled_glass():
    _lit_stage(principled("green", (0.3, 0.7, 0.3), Transmission_Weight=1.0, Roughness=0.0), principled(
        "frost", (0.1, 0.3, 0.7), Transmission_Weight=0.75, Roughness=0.3))


def principled_subsurface():
    skin = dict(Subsurface_Weight=1.0, Subsurface_Radius=(1.0, 0.4, 0.2), Roughness=0.6)
    _lit_stage(principled("wax", (0.8, 0.7, 0.5), Subsurface_Scale=0.1, **skin),
               principled("skin", (0.8, 0.5, 0.4), Subsurface_Scale=0.03, **skin))


def emitters():
    _lit_stage(principled("lamp", (0.2, 0.2, 0.2), Emission_Color=(1.0, 0.5, 0.2, 1.0), Emission_Strength=3.0),
               material("glow", (0.3, 0.6, 1.0), "ShaderNodeEmission", Strength=2.0))


def volumes():
    _lit_stage(material("smoke", (0.9, 0.8, 0.6), "ShaderNodeVolumePrincipled", Density=1.5), material("blue", (0.1, 0.3, 0.7)))


def world_fog():
    """In a closed room, since the fog of Cycles has no end."""
    stage()
    box(material("walls", (0.4, 0.4, 0.4)), (0.0, -2.0, 2.9), 12.0).scale.z = 0.5
    lamp("AREA", (0.0, -1.0, 5.0), energy=500.0, size=2.0)
    made, _ = world()
    fog = made.node_tree.nodes.new("ShaderNodeVolumeScatter")
    fog.inputs["Density"].default_value = 0.05
    made.node_tree.links.new(fog.outputs[0], made.node_tree.nodes["World Output"].inputs["Volume"])


def instances_and_modifiers():
    """A collection that is placed three times, and a box that is beveled, subdivided and repeated."""
    floor()
    camera()
    world((0.4, 0.4, 0.4))
    lamp("AREA", (-3.0, -2.0, 4.0), (30.0, -30.0, 0.0), energy=200.0, size=1.5)
    group = bpy.data.collections.new("group")
    made = ball(material("green", (0.1, 0.6, 0.2)), (0.0, 0.0, 0.3), 0.3)
    bpy.context.scene.collection.objects.unlink(made)
    group.objects.link(made)
    for x in (-2.0, -1.0, 0.0):
        empty = thing_of_collection(group)
        empty.location = (x, -1.0, 0.0)
    cube = box(material("red", (0.7, 0.2, 0.1)), (0.5, 1.0, 0.5), 0.8)
    cube.modifiers.new("round", "SUBSURF").render_levels = 3
    cube.modifiers["round"].levels = 0
    array = cube.modifiers.new("row", "ARRAY")
    array.count, array.relative_offset_displace = 3, (1.2, 0.0, 0.0)


def thing_of_collection(group):
    empty = bpy.data.objects.new("instance", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", group
    bpy.context.scene.collection.objects.link(empty)
    return empty


def partly_visible():
    """A ball that the camera does not see and a box that a mirror does not see, a lamp for the box alone, and a world that is seen as
    light only. Diffuse rays and shadow rays meet the same objects, since Cycles mixes their light."""
    cube, made = stage()
    mirror = box(material("mirror", (0.9, 0.9, 0.9), "ShaderNodeBsdfGlossy", Roughness=0.0), (0.0, 2.2, 0.8))
    mirror.scale = (3.0, 0.1, 1.0)
    made.visible_camera = cube.visible_glossy = False
    key = lamp("POINT", (-2.0, -2.0, 2.5), energy=200.0, shadow_soft_size=0.0, color=(0.2, 1.0, 0.4))
    key.light_linking.receiver_collection = bpy.data.collections.new("lit")
    key.light_linking.receiver_collection.objects.link(cube)
    lamp("POINT", (3.0, -2.0, 4.0), energy=300.0, shadow_soft_size=0.0)
    rays = world((0.4, 0.4, 0.4))[0].cycles_visibility
    rays.camera = rays.scatter = False


def transparent_film():
    """No background, and a ball that is cut out."""
    _, made = _plain_stage()
    bpy.context.scene.render.film_transparent = True
    made.is_holdout = True


def _plain_stage():
    pair = stage()
    world((0.4, 0.4, 0.4))
    lamp("AREA", (-3.0, -2.0, 4.0), (30.0, -30.0, 0.0), energy=200.0, size=1.5)
    return pair


def moving_ball():
    """Frame 6 of 12, with motion."""
    scene = bpy.context.scene
    _, made = _plain_stage()
    scene.frame_start, scene.frame_end = 1, 12
    for frame, x in ((1, 1.0), (12, 3.0)):
        made.location.x = x
        made.keyframe_insert("location", frame=frame)
    scene.frame_set(6)
    scene.view_layers[0].use_pass_vector = True


def passes():
    _plain_stage()
    layer = bpy.context.scene.view_layers[0]
    for name in ("z", "normal", "position", "diffuse_direct", "diffuse_indirect", "diffuse_color", "emit", "environment",
                 "cryptomatte_object"):
        setattr(layer, f"use_pass_{name}", True)


# Name, scene, the largest difference of the means (None: it is printed only), and why it may be larger.
SCENES = [
    ("point", point_lights, LIGHTS, ""),
    ("point, hidden", hidden_point_lights, LIGHTS, ""),
    ("spot", spot_lights, LIGHTS, ""),
    ("sun", suns, LIGHTS, ""),
    ("area", area_lights, LIGHTS, ""),
    ("world colour", world_color, LIGHTS, ""),
    ("world picture", world_picture, LIGHTS, ""),
    ("world sky", world_sky, None, "another model of the sky"),
    ("shift", shifted_camera, LIGHTS, ""),
    ("orthographic", orthographic_camera, LIGHTS, ""),
    ("depth of field", blurred_camera, LIGHTS, ""),
    ("panorama", panorama_camera, LIGHTS, ""),
    ("rough", principled_rough, PRINCIPLED, ""),
    ("metal", principled_metal, PRINCIPLED, ""),
    ("coat, sheen", principled_coat, PRINCIPLED, ""),
    ("glass", principled_glass, PRINCIPLED, ""),
    ("subsurface", principled_subsurface, PRINCIPLED, ""),
    ("emission", emitters, LIGHTS, ""),
    ("volume", volumes, PRINCIPLED, ""),
    ("fog", world_fog, PRINCIPLED, ""),
    ("instances", instances_and_modifiers, LIGHTS, ""),
    ("transparency", transparent_film, LIGHTS, ""),
    ("visibility", partly_visible, LIGHTS, ""),
    ("animation", moving_ball, LIGHTS, ""),
    ("passes", passes, LIGHTS, ""),
]
