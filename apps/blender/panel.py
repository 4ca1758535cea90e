"""The panels of the render properties, and the button that takes over the values of Cycles."""

import bpy

from . import flags, visibility

ENGINE = "GATELIGHT"
# Panels of other engines that say something to this one too, and general ones that say nothing to it.
TAKEN = ("DATA_PT_EEVEE_light", "DATA_PT_camera_dof", "DATA_PT_camera_dof_aperture", "EEVEE_MATERIAL_PT_context_material",
         "EEVEE_MATERIAL_PT_surface", "EEVEE_MATERIAL_PT_volume", "EEVEE_WORLD_PT_surface", "EEVEE_WORLD_PT_volume",
         "CYCLES_RENDER_PT_passes", "CYCLES_RENDER_PT_passes_data", "CYCLES_RENDER_PT_passes_light", "CYCLES_RENDER_PT_passes_crypto")
LEFT = ("DATA_PT_light", "DATA_PT_spot", "RENDER_PT_freestyle", "VIEWLAYER_PT_freestyle", "RENDER_PT_gpencil", "RENDER_PT_grease_pencil")


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
    rows = ("preset", "spp", "time_limit", "max_error", "denoiser", "integrator", "device")

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
    rows = ("threads", "seed", "more")


class GATELIGHT_PT_visibility(_Panel):
    """What Cycles has in panels of its own."""
    bl_label = "Visibility in Gatelight"
    bl_context = "object"

    def draw(self, context):
        self.layout.use_property_split = True
        for name in [*visibility.LAMP.values()] if context.object.type == "LIGHT" else [*visibility.OBJECT.values(), "is_shadow_catcher"]:
            self.layout.prop(context.object, name)


class GATELIGHT_PT_world_visibility(_Panel):
    """The same of the world."""
    bl_label = "Visibility in Gatelight"
    bl_context = "world"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and hasattr(context.world, "cycles_visibility")

    def draw(self, context):
        self.layout.use_property_split = True
        for name in visibility.WORLD.values():
            self.layout.prop(context.world.cycles_visibility, name)


CLASSES = (GATELIGHT_OT_from_cycles, GATELIGHT_PT_sampling, GATELIGHT_PT_paths, GATELIGHT_PT_film, GATELIGHT_PT_more,
           GATELIGHT_PT_visibility, GATELIGHT_PT_world_visibility)


def _share(change):
    """Sets the engines of Blender's panels. Each gets its own set, since many inherit one."""
    for found in bpy.types.Panel.__subclasses__():
        name, engines = found.__name__, getattr(found, "COMPAT_ENGINES", ())
        if name in TAKEN or ("BLENDER_RENDER" in engines and not name.startswith(LEFT)):
            found.COMPAT_ENGINES = change(set(engines))


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    _share(lambda engines: engines | {ENGINE})


def unregister():
    _share(lambda engines: engines - {ENGINE})
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
