"""A record player by a lamp: anisotropic metal, a grooved record, cloth and paper that let light through, a soap bubble, a prism,
an environment in the file, and a hidden node."""

import math

import pictures
from glb import Glb, cross, glass, unit
from shapes import lathe, merge, quad, rounded_box, sphere, surface, upright

SKY = {"zenith": (0.35, 0.45, 0.65), "horizon": (0.75, 0.72, 0.68), "ground": (0.10, 0.09, 0.08)}
WINDOW = (6.0, 5.6, 5.0)


def ring(inner, outer, height=0.0):
    """A flat ring that faces up. u runs around, v from the inside out."""
    def at(u, v):
        r = inner + (outer - inner) * v
        return r * math.cos(2 * math.pi * u), height, r * math.sin(2 * math.pi * u)
    return surface(96, 2, at, wrap=True)


def radiance(d):
    """The environment's radiance from a direction: a bright window at +x, a little above the horizon."""
    x, y, z = d
    if x > 0.55 and abs(z) < 0.38 * x and 0.05 * x < y < 0.75 * x:
        return WINDOW
    low, high = (SKY["horizon"], SKY["zenith"]) if y > 0 else (SKY["horizon"], SKY["ground"])
    t = min(1.0, abs(y) * (1.0 if y > 0 else 6.0))
    return tuple(a + (b - a) * t for a, b in zip(low, high))


def faces(glb, size=16):
    """The six sides of the environment as pictures, with an alpha that divides the colours."""
    axes = [(0, 1), (0, -1), (1, 1), (1, -1), (2, 1), (2, -1)]
    images = []
    for axis, sign in axes:
        forward, up = [0.0] * 3, [0.0, 1.0, 0.0]
        forward[axis] = float(sign)
        if axis == 1:
            up = [0.0, 0.0, float(-sign)]
        right = cross(forward, up)

        def pixel(x, y, forward=forward, up=up, right=right):
            a, b = 2 * (x + 0.5) / size - 1, 1 - 2 * (y + 0.5) / size
            color = radiance(unit([forward[k] + a * right[k] + b * up[k] for k in range(3)]))
            divisor = min(1.0, math.floor(255 / max(*color, 1.0)) / 255)
            return (*(srgb(v * divisor) for v in color), divisor)

        view = glb.view(pictures.encode(pictures.picture(size, size, pixel)))
        images.append(glb.append("images", {"mimeType": "image/png", "bufferView": view}))
    return images


def films(glb):
    """Thin at the top of a bubble, thick at its bottom."""
    return glb.texture("film", pictures.encode([[(0.0, y / 31, 0.0)] * 2 for y in range(32)]), "clamp")


def prism(half, height):
    """A triangular prism that stands on its end."""
    corners = [(half * math.sin(2 * math.pi * k / 3), half * math.cos(2 * math.pi * k / 3)) for k in range(3)]
    return upright([(x, 0.0, z) for x, z in corners], height)


def srgb(value):
    return 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055


def materials(glb):
    new = glb.material

    def anisotropic(name, colour, roughness, strength, quarter_turn):
        return new(name, colour, metallic=1.0, roughness=roughness, extensions={"anisotropy": {
            "anisotropyStrength": strength, "anisotropyRotation": round(math.pi / 2 if quarter_turn else 0.0, 6)}})

    def through(name, reflected, share, transmitted):
        return new(name, reflected, roughness=0.9, double_sided=True, extensions={"diffuse_transmission": {
            "diffuseTransmissionFactor": share, "diffuseTransmissionColorFactor": list(transmitted)}})

    return {
        # Grooves run around, so the record is rough across them; the platter is turned on a lathe.
        "record": new("record", (0.02, 0.02, 0.022), roughness=0.22, extensions={
            "anisotropy": {"anisotropyStrength": 0.75, "anisotropyRotation": round(math.pi / 2, 6)}}),
        "platter": anisotropic("platter", (0.91, 0.92, 0.92), 0.2, 0.7, True),
        "plate": anisotropic("brushed brass", (0.89, 0.74, 0.42), 0.25, 0.6, False),
        "label": new("label", (0.72, 0.12, 0.08), roughness=0.6),
        "shade": through("lampshade", (0.85, 0.80, 0.70), 0.55, (0.95, 0.78, 0.55)),
        "paper": through("paper", (0.85, 0.85, 0.82), 0.4, (0.95, 0.93, 0.85)),
        "leaf": through("leaf", (0.12, 0.30, 0.05), 0.5, (0.45, 0.65, 0.08)),
        "bubble": new("soap bubble", (1.0, 1.0, 1.0), roughness=0.0, double_sided=True, extensions={
            "transmission": {"transmissionFactor": 1.0}, "ior": {"ior": 1.0},
            "iridescence": {"iridescenceFactor": 1.0, "iridescenceIor": 1.33, "iridescenceThicknessMinimum": 150.0,
                            "iridescenceThicknessMaximum": 750.0,
                            "iridescenceThicknessTexture": {"index": films(glb)}}}),
        "prism": new("prism", (1.0, 1.0, 1.0), roughness=0.0, extensions={
            **glass(1.62, 0.3), "dispersion": {"dispersion": 1.5}}),
        "beetle": new("beetle", (0.05, 0.12, 0.08), metallic=0.6, roughness=0.25, extensions={
            "iridescence": {"iridescenceFactor": 1.0, "iridescenceIor": 1.6, "iridescenceThicknessMaximum": 420.0}}),
        "wood": new("wood", (0.32, 0.19, 0.10), roughness=0.45),
        "table": new("table", (0.55, 0.52, 0.48), roughness=0.7),
        "bulb": new("bulb", (0.0, 0.0, 0.0), emission=(1.0, 0.82, 0.6), strength=25.0),
        "hidden": new("hidden", (0.0, 0.0, 0.0), emission=(1.0, 0.0, 1.0), strength=50.0),
    }


def build(path):
    glb = Glb("turntable", all_uvs=True)
    of = materials(glb)
    glb.place("table", quad((-3.0, 0.0, 2.0), (6.0, 0.0, 0.0), (0.0, 0.0, -5.0)), of["table"])
    glb.place("base", rounded_box((1.5, 0.16, 1.2), 0.03), of["wood"], at=(0.0, 0.08, 0.0))
    glb.place("platter", lathe([(0.0, 0.18), (0.53, 0.18), (0.54, 0.21), (0.0, 0.21)]), of["platter"], at=(-0.12, 0.0, 0.0))
    glb.place("record", merge(ring(0.16, 0.5, 0.222)), of["record"], at=(-0.12, 0.0, 0.0))
    glb.place("label", ring(0.012, 0.16, 0.2225), of["label"], at=(-0.12, 0.0, 0.0))
    glb.place("name plate", quad((-0.35, 0.02, 0.612), (0.5, 0.0, 0.0), (0.0, 0.12, 0.0)), of["plate"], at=(0.1, 0.0, 0.0))
    glb.place("dial", quad((0.48, 0.163, 0.45), (0.2, 0.0, 0.0), (0.0, 0.0, -0.2)), of["plate"])
    # The lamp: a shade without top and bottom, around a bulb.
    def cone(u, v):
        r = 0.36 - 0.12 * v
        return r * math.cos(-2 * math.pi * u), 0.62 + 0.5 * v, r * math.sin(-2 * math.pi * u)
    lamp = (1.25, 0.0, -0.55)
    glb.place("shade", surface(48, 4, cone, wrap=True), of["shade"], at=lamp)
    glb.place("bulb", sphere(0.08, 20, 10), of["bulb"], at=(lamp[0], 0.82, lamp[2]))
    glb.place("stand", lathe([(0.0, 0.0), (0.16, 0.0), (0.15, 0.03), (0.02, 0.05), (0.02, 0.72), (0.0, 0.72)]), of["platter"],
              at=lamp)
    # A sheet of paper and a leaf before the window.
    glb.place("paper", quad((0.0, 0.0, 0.0), (0.0, 0.0, -0.7), (0.0, 0.75, 0.0)), of["paper"], at=(-1.0, 0.01, 0.0), turn=-60)
    def leaf(u, v):
        w = 0.24 * math.sin(math.pi * v) * (1.0 - 0.3 * v)
        return (2 * u - 1) * w, 0.9 * v, 0.35 * v * v + 0.6 * w * (2 * u - 1) ** 2
    glb.place("leaf", surface(8, 12, leaf), of["leaf"], at=(-1.45, 0.0, -0.4), turn=70)
    glb.place("bubble", sphere(0.2, 40, 20), of["bubble"], at=(-0.55, 0.98, 0.1))
    glb.place("prism", prism(0.15, 0.42), of["prism"], at=(0.95, 0.001, 0.55), turn=20)
    glb.place("beetle", sphere(0.09, 32, 16), of["beetle"], at=(-0.85, 0.055, 0.85), scale=(1.0, 0.6, 1.5))
    glb.node("hidden", glb.mesh("hidden", (quad((-1.0, 0.0, 1.5), (2.0, 0.0, 0.0), (0.0, 1.5, 0.0)), of["hidden"])),
             extensions={"KHR_node_visibility": {"visible": False}})
    glb.require("KHR_node_visibility")
    glb.doc.setdefault("extensions", {})["EXT_lights_image_based"] = {"lights": [{
        "name": "window", "intensity": 1.0, "rotation": [0.0, 0.173648, 0.0, 0.984808], "specularImages": [faces(glb)],
        "specularImageSize": 16, "irradianceCoefficients": [[0.0, 0.0, 0.0]] * 9}]}
    glb.doc["scenes"][0]["extensions"] = {"EXT_lights_image_based": {"light": 0}}
    glb.camera("camera", (0.1, 1.35, 2.75), (0.08, 0.38, -0.1), 38.0, aspect=None)
    glb.write(path)
