"""Blender's lights in a glTF document: punctual lights, and surfaces that let all rays pass where lights have a size."""

import math
import os

from . import ies, shapes, units

FAR = 1000.0  # a sun's disc lies so many radii of the scene away
SPOT_POINTS = 24  # in place of a disc, which would have no cone


class Lights:
    """Adds the lights of a scene. `flags` are those of the program that belong to them."""

    def __init__(self, document, folder, notes, radius, foggy):
        self.document, self.folder, self.notes, self.radius, self.foggy = document, folder, notes, radius, foggy
        self._profiles = {}
        self._meshes = {}

    @property
    def flags(self):
        return ["--ies", ";".join(f"{name}-*={path}" for name, path in self._profiles.values())] if self._profiles else []

    def add(self, node, thing, extensions):
        """The light of an object, as children of its node, whose scale they undo, with extensions."""
        light, color = thing.data, self._color(thing)
        scale = [abs(s) or 1.0 for s in thing.matrix_world.to_scale()]
        watts = light.energy * 2.0 ** getattr(light, "exposure", 0.0)
        area = self._size(light)[0] * self._size(light)[1] * scale[0] * scale[1] * (math.pi / 4.0 if light.type == "AREA" and
                                                                                   light.shape in ("DISK", "ELLIPSE") else 1.0)
        radius = light.shadow_soft_size if light.type in ("POINT", "SPOT") else 0.0
        if not getattr(light, "normalize", True):
            watts *= units.not_normalized(light.type, radius, area, getattr(light, "angle", 0.0))
        strength = [watts * c for c in color]
        if light.type == "AREA" and light.spread < math.pi - 1e-3:
            self.notes.add(f"light '{thing.name}'", "the spread of an area light; it shines evenly")
        children = len(node.get("children", ()))
        add = {"POINT": self._point, "SPOT": self._spot, "SUN": self._sun, "AREA": self._area}[light.type]
        add(node, thing, strength, {"scale": scale, "radius": radius, "area": area})
        for child in node.get("children", ())[children:]:
            for name, values in extensions.items():
                self.document.extend(self.document.json["nodes"][child], name, values)

    def _color(self, thing):
        light = thing.data
        color = list(light.color)
        if getattr(light, "use_temperature", False):
            color = [a * b for a, b in zip(color, light.temperature_color)]
        if light.use_nodes and light.node_tree:
            emission = next((n for n in light.node_tree.nodes if n.type == "EMISSION"), None)
            if emission is None:
                self.notes.add(f"light '{thing.name}'", "its nodes have no Emission; its own colour is taken")
                return color
            for name in ("Color", "Strength"):
                if emission.inputs[name].is_linked:
                    self.notes.add(f"light '{thing.name}'", f"the node behind {name}; its plain value is taken")
            factor = emission.inputs["Strength"].default_value
            color = [a * b * factor for a, b in zip(color, emission.inputs["Color"].default_value)]
        return color

    def _size(self, light):
        if light.type != "AREA":
            return 1.0, 1.0
        return light.size, light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else light.size

    def _profile(self, *cone):
        """The name of spots of a size and blend, which share a file."""
        if cone not in self._profiles:
            name = f"gatelight-{len(self._profiles)}"
            path = os.path.join(self.folder, name + ".ies")
            with open(path, "w", encoding="ascii") as file:
                file.write(ies.spot(*cone))
            self._profiles[cone] = name, path
        return self._profiles[cone][0]

    def _punctual(self, node, name, intensity, place=None, scale=(1.0, 1.0, 1.0), kind="point"):
        strength = max(*intensity, 1e-30)
        light = {"name": name, "type": kind, "color": [i / strength for i in intensity], "intensity": strength}
        child = {"name": name, **self.document.add_light(light)}
        if place is not None:
            child["translation"] = [p / s for p, s in zip(place, scale)]
        self.document.add_child(node, child)

    def _surface(self, node, thing, shape, radiance, scale, place=None):
        if shape not in self._meshes:
            self._meshes[shape] = getattr(shapes, shape)()
        material = self.document.add_clear_emitter(thing.name, radiance)
        child = {"name": thing.name, "mesh": self.document.add_mesh(thing.name, self._meshes[shape], material), "scale": scale}
        if place is not None:
            child["translation"] = place
        self.document.add_child(node, child)

    def _point(self, node, thing, watts, how):
        radius, scale = how["radius"], how["scale"]
        if radius <= 0.0:
            self._punctual(node, thing.name, [units.point_intensity(w) for w in watts])
        else:
            radiance = [units.surface_radiance(w, 4.0 * math.pi * radius * radius) for w in watts]
            self._surface(node, thing, "sphere", radiance, [radius / s for s in scale])

    def _spot(self, node, thing, watts, how):
        light, radius = thing.data, how["radius"]
        name = self._profile(light.spot_size, light.spot_blend)
        points = shapes.points_in_disc(SPOT_POINTS) if radius > 0.0 else [(0.0, 0.0, 0.0)]
        for point in points:
            part = [units.point_intensity(w) / len(points) for w in watts]
            self._punctual(node, f"{name}-{thing.name}", part, [radius * p for p in point], how["scale"])

    def _sun(self, node, thing, irradiance, how):
        angle, scale = thing.data.angle, how["scale"]
        if angle <= 1e-4 or self.foggy:
            if angle > 1e-4:
                self.notes.add(f"light '{thing.name}'", "the angle of a sun in fog; its shadows are sharp")
            self._punctual(node, thing.name, irradiance, kind="directional")
            return
        angle = min(angle, 0.99 * math.pi)
        distance = FAR * self.radius
        across = 2.0 * distance * math.tan(0.5 * angle)
        self._surface(node, thing, "disc", [units.sun_radiance(i, angle) for i in irradiance], [across / scale[0], across / scale[1], 1.0],
                      [0.0, 0.0, distance / scale[2]])

    def _area(self, node, thing, watts, how):
        light, area = thing.data, how["area"]
        if area <= 0.0:
            self.notes.add(f"light '{thing.name}'", "an area light without an area")
        else:
            shape = "disc" if light.shape in ("DISK", "ELLIPSE") else "rectangle"
            self._surface(node, thing, shape, [units.surface_radiance(w, area) for w in watts], [*self._size(light), 1.0])
