"""Blender's lights in a glTF document: punctual lights, and surfaces that let all rays pass where lights have a size."""

import math
import os

from mathutils import Vector

from . import ies, shapes, units

FAR = 1000.0  # a sun's disc lies so many radii of the scene away
SPOT_POINTS, SPHERE_POINTS, SIDE_POINTS = 24, 16, 8  # small lights in place of a surface


class Lights:
    """Adds the lights of a scene. `flags` are those of the program that belong to them."""

    def __init__(self, document, folder, notes, camera_sees, radius, animated):
        self.document, self.folder, self.notes = document, folder, notes
        self.camera_sees, self.radius, self.animated = camera_sees, radius, animated
        self._profiles = {}
        self._meshes = {}

    @property
    def flags(self):
        return ["--ies", ";".join(f"{name}-*={path}" for name, path in self._profiles.values())] if self._profiles else []

    def add(self, node, thing, fogged=False):
        """The light of an object, as children of its node, whose scale they undo."""
        light, color = thing.data, self._color(thing)
        scale = [abs(s) or 1.0 for s in thing.matrix_world.to_scale()]
        watts = light.energy * 2.0 ** getattr(light, "exposure", 0.0)
        area = self._size(light)[0] * self._size(light)[1] * scale[0] * scale[1] * (math.pi / 4.0 if light.type == "AREA" and
                                                                                   light.shape in ("DISK", "ELLIPSE") else 1.0)
        radius = light.shadow_soft_size if light.type in ("POINT", "SPOT") else 0.0
        if not getattr(light, "normalize", True):
            watts *= units.not_normalized(light.type, radius, area, getattr(light, "angle", 0.0))
        strength = [watts * c for c in color]
        self._complain(thing)
        seen = thing.visible_camera or not (self.animated or self.camera_sees(thing))
        add = {"POINT": self._point, "SPOT": self._spot, "SUN": self._sun, "AREA": self._area}[light.type]
        add(node, thing, strength, {"scale": scale, "radius": radius, "area": area, "seen": seen, "fogged": fogged})

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

    def _complain(self, thing):
        light, what = thing.data, f"light '{thing.name}'"
        if light.type == "AREA" and light.spread < math.pi - 1e-3:
            self.notes.add(what, "the spread of an area light; it shines evenly")
        if not light.use_shadow:
            self.notes.add(what, "light without shadows; it casts them")
        for name in ("diffuse", "glossy", "transmission", "volume_scatter"):
            if not getattr(thing, f"visible_{name}", True):
                self.notes.add(what, f"being hidden from {name} rays")

    def _size(self, light):
        if light.type != "AREA":
            return 1.0, 1.0
        return light.size, light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else light.size

    def _profile(self, key, text):
        """The name of lights with a profile, of which each has its own file."""
        if key not in self._profiles:
            name = f"gatelight-{len(self._profiles)}"
            path = os.path.join(self.folder, name + ".ies")
            with open(path, "w", encoding="ascii") as file:
                file.write(text())
            self._profiles[key] = name, path
        return self._profiles[key][0]

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
        elif how["seen"]:
            radiance = [units.surface_radiance(w, 4.0 * math.pi * radius * radius) for w in watts]
            self._surface(node, thing, "sphere", radiance, [radius / s for s in scale])
        else:
            for point in shapes.points_on_sphere(SPHERE_POINTS):
                part = [units.point_intensity(w) / SPHERE_POINTS for w in watts]
                self._punctual(node, thing.name, part, [radius * p for p in point], scale)

    def _spot(self, node, thing, watts, how):
        light, radius = thing.data, how["radius"]
        name = self._profile((light.spot_size, light.spot_blend), lambda: ies.spot(light.spot_size, light.spot_blend))
        points = shapes.points_in_disc(SPOT_POINTS) if radius > 0.0 else [(0.0, 0.0, 0.0)]
        for point in points:
            part = [units.point_intensity(w) / len(points) for w in watts]
            self._punctual(node, f"{name}-{thing.name}", part, [radius * p for p in point], how["scale"])

    def _sun(self, node, thing, irradiance, how):
        angle, scale = thing.data.angle, how["scale"]
        if angle <= 1e-4 or how["fogged"]:
            if how["fogged"] and angle > 1e-4:
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
        round_one = light.shape in ("DISK", "ELLIPSE")
        size = (*self._size(light), 1.0)
        if area <= 0.0:
            self.notes.add(f"light '{thing.name}'", "an area light without an area")
        elif how["seen"]:
            self._surface(node, thing, "disc" if round_one else "rectangle", [units.surface_radiance(w, area) for w in watts], list(size))
        else:
            name = self._profile("cosine", ies.cosine)
            unit = shapes.points_in_disc(SIDE_POINTS ** 2) if round_one else shapes.points_in_square(SIDE_POINTS)
            half = 0.5 if round_one else 1.0
            for point in unit:
                part = [w / (math.pi * len(unit)) for w in watts]
                self._punctual(node, f"{name}-{thing.name}", part, [half * p * s for p, s in zip(point, size)])


def in_view(camera, thing):
    """Whether the camera may see the light, through everything: its ball is in the view, and its front faces the camera."""
    to_camera = camera.matrix_world.inverted()
    center = to_camera @ thing.matrix_world.translation
    light = thing.data
    if light.type == "AREA":
        front = thing.matrix_world.to_3x3() @ Vector((0.0, 0.0, -1.0))
        if front.dot(camera.matrix_world.translation - thing.matrix_world.translation) <= 0.0:
            return False
        reach = 0.5 * max(light.size, light.size_y) * 1.42 * max(abs(s) for s in thing.matrix_world.to_scale())
    else:
        reach = light.shadow_soft_size
    if camera.data.type == "PANO":
        return True
    if camera.data.type == "ORTHO":
        return center.z < reach and max(abs(center.x), abs(center.y)) < 0.5 * camera.data.ortho_scale * 1.5 + reach
    widest = math.tan(0.5 * camera.data.angle) * 1.42
    return center.z < reach and center.xy.length < -center.z * widest + reach * math.sqrt(1.0 + widest * widest)
