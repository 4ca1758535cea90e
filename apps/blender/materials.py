"""What Blender's materials have and its glTF exporter leaves out, and what neither can carry."""

import math

from . import media

THICK = 0.01  # any thickness: rays measure the body
# Nodes through which the exporter finds pictures and colours.
CARRIED = {"TEX_IMAGE", "UVMAP", "MAPPING", "TEX_COORD", "NORMAL_MAP", "SEPARATE_COLOR", "SEPRGB", "COMBINE_COLOR", "VERTEX_COLOR",
           "ATTRIBUTE", "MIX", "MIX_RGB", "MATH", "RGB", "VALUE", "REROUTE", "FRAME", "CLAMP", "VECT_MATH"}
LOST = ("Diffuse Roughness", "Thin Film Thickness")  # inputs of Principled BSDF that the exporter leaves out


class Surface:
    """A material of the document and the node at its surface output."""

    def __init__(self, document, element, material, notes):
        self.document, self.element, self.notes = document, element, notes
        self.what = f"material '{material.name}'"
        self.surface = at_output(material, "Surface")
        self.volume = at_output(material, "Volume")
        self.material = material

    def patch(self):
        if not self.material.use_nodes:
            return
        node = self.surface
        if node is None and self.volume is None:
            self.notes.add(self.what, "a material without a surface; it is as the exporter wrote it")
        if node is not None:
            getattr(self, "_" + node.type.lower(), self._unknown)(node)
        if self.volume is not None:
            self._fill(node)
        self._complain_about_nodes()
        if self.material.displacement_method != "BUMP" and at_output(self.material, "Displacement"):
            self.notes.add(self.what, "displacement")

    # Surfaces, by the type of their node.
    def _bsdf_principled(self, node):
        self._transmission(node)
        if value(node, "Subsurface Weight") > 0.0:
            self._subsurface(node)
        for name in LOST:
            if name in node.inputs and (node.inputs[name].is_linked or value(node, name) > 1e-4):
                self.notes.add(self.what, f"{name} of Principled BSDF")

    def _bsdf_diffuse(self, node):
        self._set(self._color(node), metallic=0.0, roughness=1.0)
        self._extend("specular", {"specularFactor": 0.0})
        if value(node, "Roughness") > 1e-4:
            self.notes.add(self.what, "roughness of Diffuse BSDF")

    def _bsdf_glossy(self, node):
        self._set(self._color(node), metallic=1.0, roughness=value(node, "Roughness"))

    _bsdf_anisotropic = _bsdf_metallic = _bsdf_glossy

    def _bsdf_glass(self, node):
        self._set(self._color(node), metallic=0.0, roughness=value(node, "Roughness"))
        self._extend("transmission", {"transmissionFactor": 1.0})
        self._extend("ior", {"ior": value(node, "IOR")})
        self._extend("volume", {"thicknessFactor": THICK})

    def _bsdf_refraction(self, node):
        self._bsdf_glass(node)
        self.notes.add(self.what, "refraction without reflection; it is glass")

    def _bsdf_translucent(self, node):
        color = self._color(node)
        self._set((0.0, 0.0, 0.0), metallic=0.0, roughness=1.0)
        self._extend("specular", {"specularFactor": 0.0})
        self._extend("diffuse_transmission", {"diffuseTransmissionFactor": 1.0, "diffuseTransmissionColorFactor": list(color)})

    def _bsdf_transparent(self, node):
        self._clear(self._color(node))

    def _mix_shader(self, node):
        """A surface that is partly transparent."""
        sides = [node.inputs[index].links[0].from_node if node.inputs[index].is_linked else None for index in (1, 2)]
        factor = node.inputs[0]
        clear = next((index for index, side in enumerate(sides) if side is not None and side.type == "BSDF_TRANSPARENT"), None)
        if clear is None or sides[1 - clear] is None or factor.is_linked:
            self._unknown(node)
            return
        other = sides[1 - clear]
        getattr(self, "_" + other.type.lower(), self._unknown)(other)
        self._base_color()[3] = factor.default_value if clear == 0 else 1.0 - factor.default_value
        self.element["alphaMode"] = "BLEND"

    def _unknown(self, node):
        self.notes.add(self.what, f"the node '{node.name}' at its surface")

    def _emission(self, node):
        self._set((0.0, 0.0, 0.0), metallic=0.0, roughness=1.0)
        self._extend("specular", {"specularFactor": 0.0})
        radiance = [value(node, "Strength") * c for c in self._color(node)]
        if node.inputs["Strength"].is_linked:
            self.notes.add(self.what, "the node behind Strength")
        strength = max(*radiance, 1e-30)
        self.element["emissiveFactor"] = [r / strength for r in radiance]
        self.element.pop("emissiveTexture", None)
        self._extend("emissive_strength", {"emissiveStrength": strength})

    # Inside.
    def _transmission(self, node):
        """Cycles tints light by the root of the base colour at each boundary, glTF by the base colour, which is also the colour of the
        diffuse share: the mean by weight keeps the sum of both."""
        weight, color = node.inputs["Transmission Weight"], node.inputs["Base Color"]
        if weight.default_value <= 0.0 and not weight.is_linked:
            return
        self._extend("volume", {"thicknessFactor": THICK})
        if weight.is_linked or color.is_linked:
            self.notes.add(self.what, "the brighter colour of transmitted light: its colour or weight is a texture")
            return
        tint, share = self._base_color(), weight.default_value
        tint[:3] = [(1.0 - share) * c + share * math.sqrt(c) for c in tint[:3]]

    def _subsurface(self, node):
        color, weight = self._color(node, "Base Color"), value(node, "Subsurface Weight")
        radius = [value(node, "Subsurface Scale") * r for r in value(node, "Subsurface Radius")]
        ior = value(node, "Subsurface IOR") if node.subsurface_method == "RANDOM_WALK_SKIN" else value(node, "IOR")
        paths = media.subsurface_paths(color, radius, ior)
        anisotropy = value(node, "Subsurface Anisotropy")
        self._extend("diffuse_transmission", {"diffuseTransmissionFactor": weight, "diffuseTransmissionColorFactor": [1.0, 1.0, 1.0]})
        self._extend("volume", {"thicknessFactor": THICK, **media.attenuation([1.0 / p for p in paths])})
        self._extend("volume_scatter", {"multiscatterColorFactor": [min(c, 0.999) for c in color], "scatterAnisotropy": anisotropy})
        if node.inputs["Base Color"].is_linked:
            self.notes.add(self.what, "a texture of subsurface scattering; it has one colour inside")

    def _fill(self, surface):
        medium = medium_of(self.volume, self.what, self.notes)
        if medium is None:
            return
        extinction, albedo, anisotropy = medium
        if surface is None:
            self._clear((1.0, 1.0, 1.0))
        if max(extinction) <= 0.0:
            return
        self._extend("volume", {"thicknessFactor": THICK, **media.attenuation(extinction)})
        if max(albedo) > 0.0:
            colors = [media.reflectance_of(a, anisotropy) for a in albedo]
            self._extend("volume_scatter", {"multiscatterColorFactor": colors, "scatterAnisotropy": anisotropy})

    # Parts.
    def _clear(self, color):
        """A surface that changes no ray's direction."""
        self._set(color, metallic=0.0, roughness=0.0)
        self._extend("transmission", {"transmissionFactor": 1.0})
        self._extend("ior", {"ior": 1.0})
        self._extend("specular", {"specularFactor": 0.0})

    def _base_color(self):
        """The factor in the document, with its alpha, to be changed."""
        return self.element.setdefault("pbrMetallicRoughness", {}).setdefault("baseColorFactor", [1.0, 1.0, 1.0, 1.0])

    def _color(self, node, name="Color"):
        if name not in node.inputs:
            name = "Base Color"
        if node.inputs[name].is_linked and node.type != "BSDF_PRINCIPLED":
            self.notes.add(self.what, f"the node behind {name} of {node.name}; its plain colour is taken")
        return value(node, name)[:3]

    def _set(self, color, metallic, roughness):
        self.element.get("extensions", {}).pop("KHR_materials_unlit", None)
        pbr = self.element.setdefault("pbrMetallicRoughness", {})
        pbr.clear()
        pbr.update(baseColorFactor=[*color, 1.0], metallicFactor=metallic, roughnessFactor=roughness)

    def _extend(self, name, values):
        self.document.extend(self.element, "KHR_materials_" + name, values)

    def _complain_about_nodes(self):
        if self.surface is None or self.surface.type != "BSDF_PRINCIPLED":
            return
        for socket in self.surface.inputs:
            for node in upstream(socket):
                if node.type not in CARRIED:
                    self.notes.add(self.what, f"the node '{node.name}' behind {socket.name}")


def value(node, name):
    """The plain value of an input: a number or a tuple."""
    found = node.inputs[name].default_value
    return tuple(found) if hasattr(found, "__len__") else found


def upstream(socket):
    """The nodes that an input depends on."""
    found, rest = [], [link.from_node for link in socket.links]
    while rest:
        node = rest.pop()
        if node not in found:
            found.append(node)
            rest += [link.from_node for other in node.inputs for link in other.links]
    return found


def at_output(owner, name):
    """The node at an output of a material or a world; None: there is none."""
    if not owner.use_nodes or not owner.node_tree:
        return None
    output = owner.node_tree.get_output_node("CYCLES")
    links = output.inputs[name].links if output else ()
    return links[0].from_node if links else None


def medium_of(node, what, notes):
    """Extinction and albedo by channel, and the mean cosine of scattering of a volume node; None if it cannot be carried."""
    if any(socket.is_linked for socket in node.inputs):
        notes.add(what, f"a volume whose density or colour varies ('{node.name}')")
        return None
    if node.type == "PRINCIPLED_VOLUME":
        if value(node, "Emission Strength") > 0.0 or value(node, "Blackbody Intensity") > 0.0:
            notes.add(what, "the emission of a volume")
        extinction, albedo = media.principled_volume(value(node, "Density"), value(node, "Color")[:3], value(node, "Absorption Color")[:3])
        return extinction, albedo, value(node, "Anisotropy")
    color, density = value(node, "Color")[:3], value(node, "Density") if "Density" in node.inputs else 0.0
    if node.type == "VOLUME_ABSORPTION":
        return [density * (1.0 - c) for c in color], [0.0] * 3, 0.0
    if node.type == "VOLUME_SCATTER":
        return [density * c for c in color], [1.0 if c > 0.0 else 0.0 for c in color], value(node, "Anisotropy")
    notes.add(what, f"the node '{node.name}' at its volume")
    return None


def add_default(document):
    """Surfaces without a material are grey and matt in Blender."""
    bare = [part for mesh in document.json.get("meshes", []) for part in mesh["primitives"] if "material" not in part]
    if bare:
        grey = {"name": "none", "doubleSided": True,
                "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.8, 0.8, 1.0], "metallicFactor": 0.0}}
        document.extend(grey, "KHR_materials_specular", {"specularFactor": 0.0})
        index = document.add("materials", grey)
        for part in bare:
            part["material"] = index


def has_only_clear_media(document):
    """Whether there are media behind surfaces that do not refract, and no surface that does."""
    found = [element.get("extensions", {}) for element in document.json.get("materials", [])]
    bodies = [e for e in found if "KHR_materials_volume" in e and
              e.get("KHR_materials_transmission", {}).get("transmissionFactor", 0.0) > 0.0]
    return bool(bodies) and all(e.get("KHR_materials_ior", {}).get("ior", 1.5) == 1.0 for e in bodies)


def patch(document, notes, materials, tag):
    """Changes all materials of the document that come from one of `materials` (Blender's, by name)."""
    for element, name in document.tagged("materials", tag):
        if name in materials:
            Surface(document, element, materials[name], notes).patch()
