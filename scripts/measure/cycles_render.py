"""Renders a glTF file with Blender's Cycles without any of its extras: run by compare-cycles and compare-finished.

blender -b --factory-startup -P cycles_render.py -- '{"scene": ..., "camera": ..., ...}'
python3 cycles_render.py -- '{...}', where the package bpy is installed

Renders one picture for each entry of "spp" and prints their seconds (with the synchronisation of the scene) as one line of
JSON with the prefix "cycles: ". "out" is a path for the pictures (.exr in 32-bit float), in which {spp} stands for their samples.
"denoise": by Open Image Denoise with prefiltered albedo and normal, within the seconds. "environment" is a colour."""

import json
import sys
import time

import numpy

# The importer of Blender 3.4 uses a name that numpy has dropped.
if not hasattr(numpy, "bool"):
    numpy.bool = bool

import bpy  # noqa: E402


def main():
    job = json.loads(sys.argv[sys.argv.index("--") + 1])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # COMPAT: the intensity of a sun is not divided by 683.
    importer = bpy.ops.import_scene.gltf
    lighting = next(name for name in importer.get_rna_type().properties.keys() if name.endswith("convert_lighting_mode"))
    importer(filepath=job["scene"], **{lighting: "COMPAT"})
    scene = bpy.context.scene
    set_camera(scene, job.get("camera"))
    set_sky(scene, job.get("environment"))
    set_sampling(scene, job)
    seconds = {}
    for spp in job["spp"]:
        scene.cycles.samples = spp
        begin = time.perf_counter()
        bpy.ops.render.render()
        seconds[spp] = time.perf_counter() - begin
        save(job["out"].format(spp=spp))
    print("cycles: " + json.dumps({"version": bpy.app.version_string, "seconds": seconds}), flush=True)


def set_camera(scene, name):
    cameras = {item.name: item for item in bpy.data.objects if item.type == "CAMERA"}
    if not cameras:
        sys.exit("the file has no camera")
    if name and name not in cameras:
        sys.exit(f"no camera is called '{name}'; there are: {', '.join(cameras)}")
    scene.camera = cameras[name] if name else next(iter(cameras.values()))


def set_sky(scene, environment):
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    nodes = world.node_tree.nodes
    background = nodes.get("Background") or nodes.new("ShaderNodeBackground")
    output = next((node for node in nodes if node.type == "OUTPUT_WORLD"), None) or nodes.new("ShaderNodeOutputWorld")
    world.node_tree.links.new(background.outputs["Background"], output.inputs["Surface"])
    background.inputs["Color"].default_value = (*(environment or (0.0, 0.0, 0.0)), 1.0)
    background.inputs["Strength"].default_value = 1.0
    scene.world = world


def set_sampling(scene, job):
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = job["size"]
    render.resolution_percentage = 100
    render.threads_mode, render.threads = "FIXED", job["threads"]
    render.use_persistent_data = False
    render.film_transparent = False
    cycles.device = "CPU"
    cycles.use_denoising = job.get("denoise", False)
    if cycles.use_denoising:
        cycles.denoiser, cycles.denoising_prefilter = "OPENIMAGEDENOISE", "ACCURATE"
        cycles.denoising_input_passes = "RGB_ALBEDO_NORMAL"
        if hasattr(cycles, "denoising_quality"):
            cycles.denoising_quality = "HIGH"
    cycles.use_adaptive_sampling = False
    cycles.seed = job.get("seed", 0)
    cycles.time_limit = 0.0
    # 0 bounces is direct light only. Every kind of bounce may use all of them.
    for kind in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces", "volume_bounces"):
        setattr(cycles, kind, job["bounces"])
    cycles.transparent_max_bounces = 64
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.blur_glossy = 0.0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.use_fast_gi = False


def save(path):
    settings = bpy.context.scene.render.image_settings
    settings.file_format, settings.color_depth, settings.color_mode = "OPEN_EXR", "32", "RGB"
    bpy.data.images["Render Result"].save_render(path)


main()
