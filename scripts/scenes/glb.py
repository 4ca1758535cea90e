"""Writes glTF 2.0 binary files, always with the same bytes. It knows only what the scenes of this project need."""

import json
import math
import struct
import zlib

FLOAT, SHORT, UNSIGNED_SHORT, UNSIGNED_INT = 5126, 5122, 5123, 5125
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def png(width, height, channels, pixels):
    """A PNG of 8-bit samples: 1 grey, 3 RGB or 4 RGBA channels, rows from the top. The file names no colour space."""
    stride = width * channels
    above = bytes(stride)
    rows = []
    for y in range(height):
        row = bytes(pixels[y * stride : (y + 1) * stride])
        left = bytes(channels) + row[:-channels]
        # The filter whose residuals are smallest in sum usually packs best.
        candidates = [
            (0, row),
            (1, bytes((a - b) & 255 for a, b in zip(row, left))),
            (2, bytes((a - b) & 255 for a, b in zip(row, above))),
            (3, bytes((a - ((b + c) >> 1)) & 255 for a, b, c in zip(row, left, above))),
        ]
        kind, best = min(candidates, key=lambda candidate: sum(min(v, 256 - v) for v in candidate[1]))
        rows.append(bytes([kind]) + best)
        above = row

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = struct.pack(">IIBBBBB", width, height, 8, {1: 0, 3: 2, 4: 6}[channels], 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
            + chunk(b"IDAT", zlib.compress(b"".join(rows), 9)) + chunk(b"IEND", b""))


class Glb:
    """Collects a scene and writes it, with the names of the extensions that it uses. `all_uvs` keeps uvs that no texture
    needs."""

    def __init__(self, title, extras=None, all_uvs=False):
        self.all_uvs = all_uvs
        self.doc = {
            "asset": {"version": "2.0", "generator": "gatelight scripts/make-scenes", "copyright": "Apache-2.0",
                      "extras": {"title": title, **(extras or {})}},
            "scene": 0,
            "scenes": [{"name": title, "nodes": []}],
        }
        self.binary = bytearray()
        self.geometries = {}
        self.used = set()

    def append(self, kind, item):
        self.doc.setdefault(kind, []).append(item)
        return len(self.doc[kind]) - 1

    def view(self, data, **more):
        while len(self.binary) % 4:
            self.binary.append(0)
        offset = len(self.binary)
        self.binary += data
        return self.append("bufferViews", {"buffer": 0, "byteOffset": offset, "byteLength": len(data), **more})

    def accessor(self, view, component, count, kind, **more):
        return self.append("accessors", {"bufferView": view, "componentType": component, "count": count, "type": kind, **more})

    def floats(self, values, kind, target=None, **bounds):
        """An accessor of rounded values."""
        view = self.view(pack("f", [round_float(v) for v in values]), **({"target": target} if target else {}))
        return self.accessor(view, FLOAT, len(values) // WIDTHS[kind], kind, **bounds)

    # Textures and materials

    def texture(self, name, image, wrap=None):
        """`image` holds the bytes of a PNG; `wrap` is "clamp" or None for repeat. Returns the index of the texture."""
        view = self.view(image)
        source = self.append("images", {"name": name, "mimeType": "image/png", "bufferView": view})
        sampler = {"magFilter": 9729, "minFilter": 9987, "wrapS": 33071 if wrap else 10497,
                   "wrapT": 33071 if wrap else 10497}
        samplers = self.doc.setdefault("samplers", [])
        if sampler not in samplers:
            samplers.append(sampler)
        return self.append("textures", {"name": name, "source": source, "sampler": samplers.index(sampler)})

    def material(self, name, base=(0.8, 0.8, 0.8), metallic=0.0, roughness=0.5, alpha=1.0, extensions=None,
                 base_texture=None, rough_texture=None, normal_texture=None, normal_scale=1.0,
                 emission=None, emission_texture=None, strength=None, mask=None, double_sided=False, extras=None):
        """The keys of `extensions` are names without "KHR_materials_"."""
        pbr = {"baseColorFactor": [*base, alpha], "metallicFactor": metallic, "roughnessFactor": roughness}
        material = {"name": name, "pbrMetallicRoughness": pbr}
        if base_texture is not None:
            pbr["baseColorTexture"] = slot(base_texture)
        if rough_texture is not None:
            pbr["metallicRoughnessTexture"] = slot(rough_texture)
        if normal_texture is not None:
            material["normalTexture"] = {**slot(normal_texture), "scale": normal_scale}
        if emission is not None:
            material["emissiveFactor"] = list(emission)
        if emission_texture is not None:
            material["emissiveTexture"] = slot(emission_texture)
        if mask is not None:
            material["alphaMode"], material["alphaCutoff"] = "MASK", mask
        if double_sided:
            material["doubleSided"] = True
        extensions = {f"KHR_materials_{key}": value for key, value in (extensions or {}).items()}
        if strength is not None:
            extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        if extensions:
            material["extensions"] = extensions
        if extras:
            material["extras"] = extras
        return self.append("materials", material)

    # Geometry

    def geometry(self, mesh, material):
        """Accessors of a shapes.Mesh. They are written once, also if several glTF meshes use them."""
        if id(mesh) in self.geometries:
            return self.geometries[id(mesh)][0]
        floats = [round_float(v) for p in mesh.positions for v in p]
        attributes = {"POSITION": self.floats(floats, "VEC3", ARRAY_BUFFER, min=[min(floats[k::3]) for k in range(3)],
                                              max=[max(floats[k::3]) for k in range(3)])}
        if mesh.normals:
            # 16 bits a component, padded to 8 bytes a normal: smooth metal shows the steps of 8 bits.
            shorts = [v for n in mesh.normals for v in (*(round(c * 32767) for c in n), 0)]
            view = self.view(pack("h", shorts), byteStride=8, target=ARRAY_BUFFER)
            attributes["NORMAL"] = self.accessor(view, SHORT, len(mesh.normals), "VEC3", normalized=True)
            self.require("KHR_mesh_quantization")
        if mesh.uvs and (self.all_uvs or "Texture" in json.dumps(self.doc["materials"][material])):
            attributes["TEXCOORD_0"] = self.floats([c for uv in mesh.uvs for c in uv], "VEC2", ARRAY_BUFFER)
        small = len(mesh.positions) <= 65535
        indices = [i for triangle in mesh.triangles for i in triangle]
        view = self.view(pack("H" if small else "I", indices), target=ELEMENT_ARRAY_BUFFER)
        index = self.accessor(view, UNSIGNED_SHORT if small else UNSIGNED_INT, len(indices), "SCALAR")
        primitive = {"attributes": attributes, "indices": index}
        # The mesh is kept so that its id is not given to another one.
        self.geometries[id(mesh)] = (primitive, mesh)
        return primitive

    def mesh(self, name, *parts):
        """A glTF mesh of (shapes.Mesh, material) pairs."""
        return self.append("meshes", {"name": name, "primitives": [
            {**self.geometry(geometry, material), "material": material} for geometry, material in parts]})

    # Nodes

    def node(self, name, mesh=None, at=None, turn=None, tilt=None, scale=None, matrix=None, children=None,
             root=True, **more):
        """`turn` is degrees about y, `tilt` degrees about x (applied first), `scale` one number or three."""
        node = {"name": name}
        if mesh is not None:
            node["mesh"] = mesh
        if at is not None:
            node["translation"] = [round_float(v) for v in at]
        if turn or tilt:
            node["rotation"] = [round_float(v) for v in quaternion(turn or 0.0, tilt or 0.0)]
        if scale is not None:
            node["scale"] = [scale] * 3 if isinstance(scale, (int, float)) else list(scale)
        if matrix is not None:
            node["matrix"] = [round_float(v) for v in matrix]
        if children:
            node["children"] = children
        node.update(more)
        index = self.append("nodes", node)
        if root:
            self.doc["scenes"][0]["nodes"].append(index)
        return index

    def place(self, name, geometry, material, **where):
        """A mesh of one part, and a node that shows it."""
        return self.node(name, self.mesh(name, (geometry, material)), **where)

    def camera(self, name, eye, target, yfov_degrees, aspect=16.0 / 9.0, znear=0.01):
        return self.node(name, camera=self.perspective(name, yfov_degrees, aspect, znear), matrix=look_at(eye, target))

    def perspective(self, name, yfov_degrees, aspect=None, znear=0.01):
        """The index of a camera. No aspect ratio leaves it to the picture."""
        perspective = {"yfov": round_float(math.radians(yfov_degrees)), "znear": znear}
        if aspect:
            perspective["aspectRatio"] = round_float(aspect)
        return self.append("cameras", {"name": name, "type": "perspective", "perspective": perspective})

    def light(self, name, kind, color, intensity, eye, target, **more):
        """A punctual light at `eye` that shines towards `target`."""
        lights = self.doc.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append({"name": name, "type": kind, "color": list(color), "intensity": intensity, **more})
        return self.node(name, matrix=look_at(eye, target),
                         extensions={"KHR_lights_punctual": {"light": len(lights) - 1}})

    # The file

    def use(self, extension):
        """Names an extension that readers may ignore, where write() does not find it."""
        self.used.add(extension)

    def require(self, extension):
        required = self.doc.setdefault("extensionsRequired", [])
        if extension not in required:
            required.append(extension)

    def write(self, path):
        used = self.used | set(self.doc.get("extensionsRequired", [])) | set(self.doc.get("extensions", {}))
        for item in self.doc.get("materials", []):
            used |= set(item.get("extensions", {}))
            if "KHR_texture_transform" in json.dumps(item):
                used.add("KHR_texture_transform")
        if used:
            self.doc["extensionsUsed"] = sorted(used)
        while len(self.binary) % 4:
            self.binary.append(0)
        self.doc["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.doc, separators=(",", ":"), sort_keys=True).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(self.binary)))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(self.binary), b"BIN\0") + bytes(self.binary))


def slot(texture):
    """A texture's index, or (index, repeats) or (index, repeats, degrees) to tile and turn it."""
    if not isinstance(texture, tuple):
        return {"index": texture}
    transform = {"scale": [texture[1], texture[1]]}
    if len(texture) > 2:
        transform["rotation"] = round_float(math.radians(texture[2]))
    return {"index": texture[0], "extensions": {"KHR_texture_transform": transform}}


def glass(ior, thickness, colour=None, distance=None):
    """Extensions of a material that refracts, and absorbs all but `colour` within `distance`."""
    volume = {"thicknessFactor": thickness}
    if colour:
        volume.update(attenuationColor=list(colour), attenuationDistance=distance)
    return {"transmission": {"transmissionFactor": 1.0}, "ior": {"ior": ior}, "volume": volume}


def pack(code, values):
    return struct.pack(f"<{len(values)}{code}", *values)


def round_float(value):
    """The nearest 32-bit float of six decimals: the last bits of sin and cos differ between C libraries."""
    return struct.unpack("<f", struct.pack("<f", round(value, 6) + 0.0))[0]


def quaternion(turn, tilt):
    half_y, half_x = math.radians(turn) / 2, math.radians(tilt) / 2
    cy, sy, cx, sx = math.cos(half_y), math.sin(half_y), math.cos(half_x), math.sin(half_x)
    return cy * sx, sy * cx, -sy * sx, cy * cx


def look_at(eye, target, up=(0.0, 1.0, 0.0)):
    """Column-major matrix of a camera or light at `eye`: it looks along its -z."""
    z = unit([e - t for e, t in zip(eye, target)])
    x = unit(cross(up, z)) if abs(z[1]) < 0.9999 else [1.0, 0.0, 0.0]
    y = cross(z, x)
    return [*x, 0.0, *y, 0.0, *z, 0.0, *eye, 1.0]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = math.sqrt(sum(v * v for v in a))
    return [v / length for v in a]
