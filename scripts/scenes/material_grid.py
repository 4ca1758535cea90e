"""Fifteen balls of one material each before a striped wall: every part of the material model in one small picture."""

import math

import pictures
from glb import Glb, glass
from shapes import quad, sphere

RADIUS = 0.42


def textures(glb):
    stripes = [[(0.72, 0.66, 0.58) if (x // 8 + y // 8) % 2 else (0.30, 0.36, 0.44) for x in range(32)]
               for y in range(32)]
    # Green is the roughness, blue the metal.
    patches = [[(0.0, 0.25 + 0.5 * ((x // 8) % 2), float((y // 8) % 2)) for x in range(32)] for y in range(32)]
    return {
        "stripes": glb.texture("stripes", pictures.encode(stripes)),
        "patches": glb.texture("patches", pictures.encode(patches)),
        "weave": glb.texture("weave", pictures.encode(pictures.normals(pictures.weave(32, 4), 2.5))),
        "lace": glb.texture("lace", pictures.encode(pictures.lace(64))),
        "lantern": glb.texture("lantern", pictures.encode(pictures.lantern(4, 64, 6)), "clamp"),
    }


def materials(glb, image):
    new, white = glb.material, (1.0, 1.0, 1.0)

    def metal(name, colour, roughness, **more):
        return new(name, colour, metallic=1.0, roughness=roughness, **more)

    def clear(name, roughness, tint=None, ior=1.5):
        return new(name, white, roughness=roughness, extensions=glass(ior, 2 * RADIUS, tint, RADIUS))

    def thin(name, colour, roughness):
        return new(name, colour, roughness=roughness, double_sided=True,
                   extensions={"transmission": {"transmissionFactor": 1.0}})

    def coated(name, colour, roughness, coat_roughness):
        return new(name, colour, roughness=roughness, extensions={
            "clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": coat_roughness}})

    veil = new("veil", (0.9, 0.35, 0.30), roughness=0.6, alpha=0.45, double_sided=True)
    glb.doc["materials"][veil]["alphaMode"] = "BLEND"
    return (
        (metal("gold mirror", (1.0, 0.766, 0.336), 0.05), metal("rough copper", (0.955, 0.60, 0.47), 0.5),
         metal("woven silver", (0.95, 0.93, 0.88), 0.3, normal_texture=(image["weave"], 2.0)),
         coated("red lacquer", (0.50, 0.03, 0.02), 0.5, 0.03), coated("hazy blue", (0.05, 0.12, 0.45), 0.6, 0.35)),
        (clear("green glass", 0.0, (0.35, 0.80, 0.45)), clear("frosted glass", 0.3), clear("water", 0.0, ior=1.33),
         thin("bubble", (0.9, 0.95, 1.0), 0.0), thin("frosted bubble", (1.0, 0.9, 0.8), 0.4)),
        (new("velvet", (0.30, 0.02, 0.05), roughness=0.9, extensions={
            "sheen": {"sheenColorFactor": [0.9, 0.4, 0.4], "sheenRoughnessFactor": 0.4}}),
         new("patched plastic", white, metallic=1.0, roughness=1.0, base_texture=(image["stripes"], 2.0),
             rough_texture=(image["patches"], 2.0)),
         new("lace", white, roughness=0.9, base_texture=(image["lace"], 3.0), mask=0.5, double_sided=True),
         veil,
         new("lantern", (0.5, 0.5, 0.5), roughness=0.8, emission=white, strength=1.5,
             emission_texture=image["lantern"])),
    )


def build(path):
    glb = Glb("material-grid", all_uvs=True)
    image = textures(glb)
    ball = sphere(RADIUS, 48, 24)
    for row, line in enumerate(materials(glb, image)):
        for column, material in enumerate(line):
            name = glb.doc["materials"][material]["name"]
            at = (column - 2.0, 2.45 - row, 0.0)
            if name == "hazy blue":
                # Used twice, squeezed and mirrored: instances whose normals need the inverse transpose.
                mesh = glb.mesh(name, (ball, material))
                glb.node(name, mesh, at=at, scale=(1.0, 0.7, 1.0))
                glb.node(f"{name}, mirrored", mesh, at=(2.0, 1.98, 0.55), scale=(-0.4, 0.25, 0.25))
            else:
                glb.place(name, ball, material, at=at)
    backdrop = glb.material("backdrop", (1.0, 1.0, 1.0), roughness=0.7, base_texture=image["stripes"])
    glb.place("floor", quad((-6, 0, 6), (12, 0, 0), (0, 0, -7), (12, 7)), backdrop)
    glb.place("wall", quad((-6, 0, -1), (12, 0, 0), (0, 8, 0), (12, 8)), backdrop)
    glb.light("point", "point", (1.0, 0.8, 0.6), 2.5, (-1.5, 2.9, 1.4), (0, 0, 0), range=6.0)
    glb.light("spot", "spot", (0.6, 0.8, 1.0), 12.0, (2.6, 3.0, 2.2), (1.2, 0.5, -0.2),
              spot={"innerConeAngle": 0.2, "outerConeAngle": round(math.pi / 8, 6)})
    glb.light("sun", "directional", (1.0, 0.9, 0.8), 0.8, (-2, 4, 3), (0, 0, 0))
    glb.camera("camera", (0.0, 1.75, 7.0), (0.0, 1.5, 0.0), 27.0, aspect=None)
    glb.write(path)
