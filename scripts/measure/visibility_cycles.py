"""Of compare-visibility, for a Python that has the package bpy.

python3 visibility_cycles.py render JOBS.json   renders glTF files with Cycles: a list of jobs, each with "scene" and "out" (an
                                                .exr in 32-bit float), and with "pixels", "spp", "depth", "environment",
                                                "fog", "transparent" and "blender" of visibility_stage.Scene
python3 visibility_cycles.py means JOBS.json    prints means of pictures as JSON: a list of [file, rectangle or null, channels]
"""

import json
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))


def render(job):
    import bpy  # noqa: PLC0415  slow, and not needed for means

    bpy.ops.wm.read_factory_settings(use_empty=True)
    # COMPAT: the intensity of a sun is its irradiance, that of a lamp W/sr.
    bpy.ops.import_scene.gltf(filepath=job["scene"], export_import_convert_lighting_mode="COMPAT", loglevel=40)
    scene, settings = bpy.context.scene, job["blender"]
    scene.camera = bpy.data.objects["camera"]
    for light in bpy.data.lights:
        if light.type == "SUN":
            light.angle = 0.0
        else:
            light.shadow_soft_size = 0.0
    world = set_world(bpy, scene, job["environment"], job["fog"])
    set_sampling(scene, job)
    for name, values in settings.get("objects", {}).items():
        for key, value in values.items():
            setattr(bpy.data.objects[name], key, value)
    for key, value in settings.get("world", {}).items():
        setattr(world.cycles_visibility, key, value)
    for kind in ("receiver", "blocker"):
        for name, states in settings.get(kind + "s", {}).items():
            setattr(bpy.data.objects[name].light_linking, kind + "_collection", linked(bpy, f"{kind}s of {name}", states))
    if "indirect_only" in settings:
        make_indirect_only(bpy, scene, settings["indirect_only"])
    camera = scene.camera.data
    camera.clip_start, camera.clip_end = settings.get("clip", (0.001, 1e4))
    bpy.ops.render.render()
    image = scene.render.image_settings
    image.file_format, image.color_depth, image.color_mode, image.exr_codec = "OPEN_EXR", "32", "RGBA", "ZIP"
    bpy.data.images["Render Result"].save_render(job["out"])


def set_world(bpy, scene, radiance, fog):
    world = scene.world = bpy.data.worlds.new("world")
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    nodes.clear()
    background, output = nodes.new("ShaderNodeBackground"), nodes.new("ShaderNodeOutputWorld")
    background.inputs["Color"].default_value = (radiance, radiance, radiance, 1.0)
    links.new(background.outputs[0], output.inputs["Surface"])
    if fog:
        scatter = nodes.new("ShaderNodeVolumeScatter")
        scatter.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
        scatter.inputs["Density"].default_value = fog
        links.new(scatter.outputs[0], output.inputs["Volume"])
    return world


def set_sampling(scene, job):
    view, cycles = scene.render, scene.cycles
    view.engine = "CYCLES"
    view.resolution_x = view.resolution_y = job["pixels"]
    view.resolution_percentage = 100
    view.film_transparent = job["transparent"]
    view.use_persistent_data = False
    cycles.device, cycles.samples, cycles.seed = "CPU", job["spp"], 1
    cycles.use_denoising = cycles.use_adaptive_sampling = False
    cycles.pixel_filter_type = "BOX"
    # 0 bounces is direct light only.
    for kind in ("max", "diffuse", "glossy", "transmission", "volume"):
        setattr(cycles, f"{kind}_bounces", job["depth"] - 1)
    cycles.transparent_max_bounces = 64
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.blur_glossy = cycles.light_sampling_threshold = 0.0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.use_fast_gi = False


def linked(bpy, name, states):
    collection = bpy.data.collections.new(name)
    for member, state in states.items():
        collection.objects.link(bpy.data.objects[member])
    for member, link in zip(collection.objects, collection.collection_objects):
        link.light_linking.link_state = states[member.name]
    return collection


def make_indirect_only(bpy, scene, names):
    collection = bpy.data.collections.new("indirect only")
    scene.collection.children.link(collection)
    for name in names:
        thing = bpy.data.objects[name]
        for other in thing.users_collection:
            other.objects.unlink(thing)
        collection.objects.link(thing)
    bpy.context.view_layer.layer_collection.children[collection.name].indirect_only = True


def means(requests):
    sys.path.insert(0, os.path.join(HERE, "..", "..", "apps", "blender"))
    import exr  # noqa: PLC0415  the extension's own reader

    found = []
    for path, rectangle, channels in requests:
        pixels = exr.read(path).layers[""]
        x0, y0, x1, y1 = rectangle or (0, 0, pixels.shape[1], pixels.shape[0])
        chosen = pixels[y0:y1, x0:x1, :3] if channels == "RGB" else pixels[y0:y1, x0:x1, 3]
        found.append(float(chosen.mean(dtype=float)))
    return found


def main():
    sys.dont_write_bytecode = True
    what, file = sys.argv[1:3]
    with open(file, encoding="utf-8") as stream:
        jobs = json.load(stream)
    if what == "means":
        print("RESULT " + json.dumps(means(jobs)), flush=True)
        return
    for job in jobs:
        print("RENDER " + job["out"], flush=True)
        render(job)


main()
