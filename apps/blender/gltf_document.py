"""A .gltf file as JSON, to which materials, meshes and lights are added."""

import base64
import json
import struct

LIGHTS = "KHR_lights_punctual"


class Document:
    def __init__(self, path):
        self.path = path
        with open(path, encoding="utf-8") as file:
            self.json = json.load(file)

    @property
    def scene(self):
        return self.json["scenes"][self.json.get("scene", 0)]

    def save(self):
        for name in ("extensionsUsed", "materials", "meshes", "accessors", "bufferViews", "buffers", "cameras", "lights"):
            if self.json.get(name) == []:
                del self.json[name]
        with open(self.path, "w", encoding="utf-8") as file:
            json.dump(self.json, file)

    def list_of(self, name):
        return self.json.setdefault(name, [])

    def tagged(self, name, tag):
        """The elements of a list whose extras have the tag, each with its value."""
        return [(element, element["extras"][tag]) for element in self.json.get(name, []) if tag in element.get("extras", {})]

    def use(self, extension):
        used = self.list_of("extensionsUsed")
        if extension not in used:
            used.append(extension)

    def extend(self, element, extension, values):
        """Sets values of an extension of an element, beside those that it has."""
        if values:
            self.use(extension)
            element.setdefault("extensions", {}).setdefault(extension, {}).update(values)

    def add(self, name, element):
        """The index of the new element."""
        elements = self.list_of(name)
        elements.append(element)
        return len(elements) - 1

    def add_child(self, node, child):
        index = self.add("nodes", child)
        node.setdefault("children", []).append(index)

    def add_light(self, light):
        self.use(LIGHTS)
        lights = self.json.setdefault("extensions", {}).setdefault(LIGHTS, {}).setdefault("lights", [])
        lights.append(light)
        return {"extensions": {LIGHTS: {"light": len(lights) - 1}}}

    def drop_lights(self):
        """Forgets the exporter's lights; the nodes stay."""
        self.json.get("extensions", {}).pop(LIGHTS, None)
        for node in self.json.get("nodes", []):
            node.get("extensions", {}).pop(LIGHTS, None)
            if node.get("extensions") == {}:
                del node["extensions"]

    def add_mesh(self, name, shape, material):
        points, triangles = shape
        floats = b"".join(struct.pack("<3f", *point) for point in points)
        indices = b"".join(struct.pack("<3I", *triangle) for triangle in triangles)
        data = base64.b64encode(floats + indices).decode()
        buffer = self.add("buffers", {"byteLength": len(floats) + len(indices), "uri": "data:application/octet-stream;base64," + data})
        views = [self.add("bufferViews", {"buffer": buffer, "byteOffset": 0, "byteLength": len(floats)}),
                 self.add("bufferViews", {"buffer": buffer, "byteOffset": len(floats), "byteLength": len(indices)})]
        corners = [[limit(point[axis] for point in points) for axis in range(3)] for limit in (min, max)]
        positions = self.add("accessors", {"bufferView": views[0], "componentType": 5126, "count": len(points), "type": "VEC3",
                                           "min": corners[0], "max": corners[1]})
        order = self.add("accessors", {"bufferView": views[1], "componentType": 5125, "count": 3 * len(triangles), "type": "SCALAR"})
        primitive = {"attributes": {"POSITION": positions}, "indices": order, "material": material}
        return self.add("meshes", {"name": name, "primitives": [primitive]})

    def add_clear_emitter(self, name, radiance):
        """A material that shines from its front and lets all rays pass, as lights of Blender do."""
        material = {"name": name, "pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.0}}
        strength = max(*radiance, 1e-30)
        material["emissiveFactor"] = [value / strength for value in radiance]
        self.extend(material, "KHR_materials_emissive_strength", {"emissiveStrength": strength})
        self.extend(material, "KHR_materials_transmission", {"transmissionFactor": 1.0})
        self.extend(material, "KHR_materials_ior", {"ior": 1.0})
        self.extend(material, "KHR_materials_specular", {"specularFactor": 0.0})
        return self.add("materials", material)
