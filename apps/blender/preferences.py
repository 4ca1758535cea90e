"""Preferences of the extension and properties of a scene."""

import json
import os

import bpy

from . import find_program, option_texts

PRESETS = ("NONE", "preview", "standard", "final")
TABLE = os.path.join(os.path.dirname(__file__), "option_texts.json")
_texts = {}


def program_path():
    """The file or folder that the user has named, or nothing."""
    found = bpy.context.preferences.addons.get(__package__)
    return found.preferences.program if found and found.preferences else ""


def values(group):
    """The properties of a scene as plain values."""
    return {name: getattr(group, name) for name in GatelightSettings.__annotations__}


def text(flag):
    return _texts.get(flag, "Install the program gatelight: its own explanation then stands here")


class GatelightPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: bpy.props.StringProperty(name="Program", subtype="FILE_PATH", description="The file or the folder of the program; "
                                      "empty: where it is found by itself")

    def draw(self, context):
        self.layout.prop(self, "program")
        try:
            path = find_program.find(self.program)
            find_program.check(path)
            self.layout.label(text=f"Found: {path}", icon="CHECKMARK")
        except find_program.NoProgram as error:
            self.layout.label(text=str(error), icon="ERROR")


class GatelightSettings(bpy.types.PropertyGroup):
    """Values of the panel; 0 and DEFAULT leave the choice to the preset."""


def _choices(flag, *words):
    return [("DEFAULT", "By Preset", text(flag)), *((word, word, text(flag)) for word in words)]


def _properties():
    """The annotations of GatelightSettings, with the program's own texts as tooltips."""
    prop = bpy.props
    whole, decimal, choice = prop.IntProperty, prop.FloatProperty, prop.EnumProperty
    return {
        "preset": choice(name="Preset", default="standard", description=text("preset"),
                         items=[(word, word.title(), text("preset")) for word in PRESETS]),
        "spp": whole(name="Samples", min=0, max=16777216, default=0, description=text("spp")),
        "time_limit": decimal(name="Time Limit", min=0.0, default=0.0, unit="TIME_ABSOLUTE", description=text("time-limit")),
        "max_error": decimal(name="Error Limit", min=0.0, max=1.0, default=0.0, precision=4, description=text("max-error")),
        "denoiser": choice(name="Denoiser", default="DEFAULT", description=text("denoiser"),
                           items=_choices("denoiser", "auto", "oidn", "none")),
        "integrator": choice(name="Integrator", default="DEFAULT", description=text("integrator"),
                             items=_choices("integrator", "auto", "path", "nrc", "ao", "nao")),
        "max_depth": whole(name="Largest Depth", min=0, default=0, description=text("max-depth")),
        "max_transmission_depth": whole(name="Largest Transmission Depth", min=0, default=0,
                                        description=text("max-transmission-depth")),
        "clamp": decimal(name="Clamp", min=0.0, default=0.0, description=text("clamp")),
        "glass_shadows": choice(name="Glass Shadows", default="DEFAULT", description=text("glass-shadows"),
                                items=_choices("glass-shadows", "refract", "straight")),
        "device": prop.StringProperty(name="Device of the Cache", default="", description=text("device")),
        "threads": whole(name="Threads", min=0, default=0, description=text("threads")),
        "seed": whole(name="Seed", min=0, default=0, description=text("seed")),
        "more": prop.StringProperty(name="Further Flags", default="",
                                    description="Other flags of 'gatelight render', as on a command line"),
    }


def _load_texts():
    """The table that the packaging wrote; else what an installed program says."""
    if os.path.exists(TABLE):
        with open(TABLE, encoding="utf-8") as file:
            return json.load(file)
    try:
        return option_texts.parse(find_program.check(find_program.find("")))
    except find_program.NoProgram:
        return {}


def register():
    _texts.update(_load_texts())
    GatelightSettings.__annotations__ = _properties()
    bpy.utils.register_class(GatelightPreferences)
    bpy.utils.register_class(GatelightSettings)
    bpy.types.Scene.gatelight = bpy.props.PointerProperty(type=GatelightSettings)


def unregister():
    del bpy.types.Scene.gatelight
    bpy.utils.unregister_class(GatelightSettings)
    bpy.utils.unregister_class(GatelightPreferences)
