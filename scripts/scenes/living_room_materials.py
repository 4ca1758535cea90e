"""Textures and materials of the living room."""

import pictures
from glb import glass

# The light of the lamps.
WARM = (1.0, 0.56, 0.24)


def textures(glb):
    wood, wood_heights = pictures.herringbone()
    images = {
        "wood": pictures.encode(wood, 64),
        "wood normal": pictures.encode(pictures.normals(wood_heights, 0.30), 128),
        "marble": pictures.encode(pictures.marble(), 128),
        "plaster normal": pictures.encode(pictures.normals(pictures.plaster(), 3.0), 128),
        "weave normal": pictures.encode(pictures.normals(pictures.weave(), 1.2)),
        "rug": pictures.encode(pictures.rug(), 64),
        "painting": pictures.encode(pictures.mountains(), 128),
        "leaf": pictures.encode(pictures.leaf(), 64),
        "lace": pictures.encode(pictures.lace()),
        "sky": pictures.encode(pictures.sky(), 128),
        "lantern": pictures.encode(pictures.lantern()),
    }
    clamped = ("painting", "leaf", "sky", "lantern", "rug")
    return {name: glb.texture(name, image, "clamp" if name in clamped else None) for name, image in images.items()}


def materials(glb):
    image = textures(glb)
    new = glb.material

    def paint(name, colour, roughness=0.6, **more):
        return new(name, colour, roughness=roughness, **more)

    def metal(name, colour, roughness):
        return new(name, colour, metallic=1.0, roughness=roughness)

    def velvet(name, colour, sheen):
        return new(name, colour, roughness=0.85, extensions={
            "sheen": {"sheenColorFactor": list(sheen), "sheenRoughnessFactor": 0.38},
            "specular": {"specularFactor": 0.3}})

    def lacquer(name, colour, roughness=0.35, coat_roughness=0.02):
        return new(name, colour, roughness=roughness, extensions={
            "clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": coat_roughness}})

    wall_normal = image["plaster normal"]
    return {
        "floor": new("oak herringbone", (1.0, 1.0, 1.0), roughness=0.34,
                     base_texture=(image["wood"], 1.0, 45.0), normal_texture=(image["wood normal"], 1.0, 45.0)),
        "teal": paint("teal plaster", (0.085, 0.170, 0.170), 0.55, normal_texture=wall_normal, normal_scale=0.35),
        "white wall": paint("white plaster", (0.74, 0.70, 0.63), 0.8, normal_texture=wall_normal, normal_scale=0.5),
        "teal wood": paint("teal wood", (0.085, 0.170, 0.170), 0.35),
        "white wood": paint("white wood", (0.80, 0.78, 0.74), 0.35),
        "ceiling": paint("ceiling", (0.82, 0.80, 0.77), 0.9),
        "rug": new("rug", (1.0, 1.0, 1.0), roughness=0.95, base_texture=image["rug"],
                   normal_texture=(image["weave normal"], 60.0), normal_scale=0.6, extensions={
                       "sheen": {"sheenColorFactor": [0.25, 0.22, 0.18], "sheenRoughnessFactor": 0.6}}),
        "marble": new("marble", (1.0, 1.0, 1.0), roughness=0.12, base_texture=image["marble"]),
        "walnut": paint("walnut", (0.155, 0.075, 0.036), 0.38),
        "ochre velvet": velvet("ochre velvet", (0.46, 0.215, 0.032), (0.85, 0.50, 0.16)),
        "rust velvet": velvet("rust velvet", (0.33, 0.085, 0.035), (0.62, 0.24, 0.12)),
        "linen": new("linen", (0.70, 0.66, 0.58), roughness=0.9, normal_texture=(image["weave normal"], 40.0),
                     normal_scale=0.5, extensions={
                         "sheen": {"sheenColorFactor": [0.4, 0.38, 0.34], "sheenRoughnessFactor": 0.5}}),
        "drape": new("drape", (0.60, 0.55, 0.46), roughness=0.9, double_sided=True, extensions={
            "sheen": {"sheenColorFactor": [0.35, 0.32, 0.27], "sheenRoughnessFactor": 0.5}}),
        "lace": new("lace", (0.92, 0.92, 0.92), roughness=0.9, base_texture=image["lace"], mask=0.5, double_sided=True),
        "lacquer": lacquer("black piano lacquer", (0.010, 0.010, 0.012)),
        "glaze": lacquer("celadon glaze", (0.33, 0.46, 0.40), 0.5, 0.04),
        "red lacquer": lacquer("red lacquer", (0.38, 0.022, 0.016), 0.4, 0.02),
        "brass": metal("brass", (0.90, 0.68, 0.34), 0.16),
        "satin brass": metal("satin brass", (0.87, 0.65, 0.33), 0.34),
        "gold": metal("gold", (1.0, 0.766, 0.336), 0.07),
        "copper": metal("hammered copper", (0.955, 0.60, 0.47), 0.30),
        "glass": new("glass", (1.0, 1.0, 1.0), roughness=0.0, extensions=glass(1.5, 0.004, (0.80, 0.93, 0.88), 0.06)),
        "vase glass": new("smoked glass", (1.0, 1.0, 1.0), roughness=0.0,
                          extensions=glass(1.5, 0.005, (0.28, 0.52, 0.50), 0.018)),
        "wine": new("cordial", (1.0, 1.0, 1.0), roughness=0.0, extensions=glass(1.35, 0.1, (0.86, 0.36, 0.05), 0.035)),
        "painting": new("painting", (1.0, 1.0, 1.0), roughness=0.5, base_texture=image["painting"]),
        "leaf": new("leaf", (1.0, 1.0, 1.0), roughness=0.36, base_texture=image["leaf"], mask=0.5, double_sided=True),
        "stalk": paint("stalk", (0.12, 0.22, 0.06), 0.5),
        "soil": paint("soil", (0.035, 0.024, 0.017), 0.95),
        "twig": paint("twig", (0.10, 0.06, 0.04), 0.8),
        "bud": paint("bud", (0.62, 0.55, 0.45), 0.9),
        "orange": new("orange", (0.80, 0.26, 0.018), roughness=0.42, normal_texture=(wall_normal, 3.0),
                      normal_scale=0.5),
        "paper": paint("paper", (0.72, 0.66, 0.54), 0.9),
        "cloth red": paint("red cloth", (0.36, 0.055, 0.040), 0.7),
        "cloth blue": paint("blue cloth", (0.045, 0.095, 0.17), 0.7),
        "cloth green": paint("green cloth", (0.07, 0.15, 0.09), 0.7),
        "cloth cream": paint("cream cloth", (0.66, 0.58, 0.44), 0.7),
        "shade": new("lampshade", (0.75, 0.66, 0.52), roughness=0.9, double_sided=True, emission=WARM, strength=2.6),
        "bulb": new("bulb", (0.8, 0.8, 0.8), emission=WARM, strength=14.0),
        "lantern": new("paper lantern", (0.75, 0.70, 0.60), roughness=0.9, emission=(1.0, 1.0, 1.0), strength=2.0,
                       emission_texture=image["lantern"]),
        "fill": new("evening light", (0.0, 0.0, 0.0), emission=(0.86, 0.93, 1.0), strength=2.4),
        "sky": new("evening sky", (0.0, 0.0, 0.0), roughness=1.0, emission=(1.0, 1.0, 1.0), strength=2.5,
                   emission_texture=image["sky"], extensions={"specular": {"specularFactor": 0.0}}),
    }
