"""The panels of the render properties, and the button that takes over the values of Cycles."""

import bpy

from . import flags

ENGINE = "GATELIGHT"
# Panels of Blender that say something to this engine too.
SHARED = ("RENDER_PT_output", "RENDER_PT_format", "RENDER_PT_frame_range", "RENDER_PT_color_management", "RENDER_PT_post_processing",
          "RENDER_PT_stamp", "VIEWLAYER_PT_layer", "VIEWLAYER_PT_layer_passes", "DATA_PT_light", "DATA_PT_lens", "DATA_PT_camera",
          "DATA_PT_camera_dof", "DATA_PT_camera_dof_aperture", "WORLD_PT_context_world", "MATERIAL_PT_preview", "EEVEE_MATERIAL_PT_surface",
          "EEVEE_MATERIAL_PT_context_material", "EEVEE_WORLD_PT_surface", "CYCLES_RENDER_PT_passes_data")


class GATELIGHT_OT_from_cycles(bpy.types.Operator):
    bl_idname = "gatelight.from_cycles"
    bl_label = "Take Over Values of Cycles"
    bl_description = "Samples, bounces, time limit, seed and denoiser as Cycles has them, with plain path tracing"

    @classmethod
    def poll(cls, context):
        return getattr(context.scene, "cycles", None) is not None

    def execute(self, context):
        cycles, settings = context.scene.cycles, context.scene.gatelight
        names = ("samples", "use_denoising", "max_bounces", "transmission_bounces", "time_limit", "seed")
        for name, value in flags.from_cycles({name: getattr(cycles, name) for name in names}).items():
            setattr(settings, name, value)
        return {"FINISHED"}


class _Panel(bpy.types.Panel):
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    COMPAT_ENGINES = {ENGINE}
    rows = ()

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        for name in self.rows:
            self.layout.prop(context.scene.gatelight, name)


class GATELIGHT_PT_sampling(_Panel):
    bl_label = "Sampling"
    rows = ("preset", "spp", "time_limit", "max_error", "denoiser", "integrator")

    def draw(self, context):
        super().draw(context)
        self.layout.operator("gatelight.from_cycles")
        self.layout.operator("gatelight.view")


class GATELIGHT_PT_paths(_Panel):
    bl_label = "Light Paths"
    rows = ("max_depth", "max_transmission_depth", "glass_shadows", "clamp")


class GATELIGHT_PT_film(_Panel):
    bl_label = "Film"

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.prop(context.scene.render, "film_transparent", text="Transparent")
        self.layout.prop(context.scene.render, "use_motion_blur")
        column = self.layout.column()
        column.active = context.scene.render.use_motion_blur
        column.prop(context.scene.render, "motion_blur_position")
        column.prop(context.scene.render, "motion_blur_shutter")


class GATELIGHT_PT_more(_Panel):
    bl_label = "Everything Else"
    bl_options = {"DEFAULT_CLOSED"}
    rows = ("device", "threads", "seed", "more")


CLASSES = (GATELIGHT_OT_from_cycles, GATELIGHT_PT_sampling, GATELIGHT_PT_paths, GATELIGHT_PT_film, GATELIGHT_PT_more)


def _shared_panels():
    return [found for found in (getattr(bpy.types, name, None) for name in SHARED) if hasattr(found, "COMPAT_ENGINES")]


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    for found in _shared_panels():
        found.COMPAT_ENGINES.add(ENGINE)


def unregister():
    for found in _shared_panels():
        found.COMPAT_ENGINES.discard(ENGINE)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
