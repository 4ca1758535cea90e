"""What the scenes of compare-visibility are made of: boxes and rectangles in metres, y up, and what is compared."""

import dataclasses
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scenes"))
import glb  # noqa: E402
from shapes import polygon, upright  # noqa: E402

GREY, RED, GREEN, BLUE, WHITE = (0.5, 0.5, 0.5), (0.7, 0.2, 0.1), (0.1, 0.6, 0.2), (0.1, 0.3, 0.7), (0.8, 0.8, 0.8)


@dataclasses.dataclass
class Region:
    """A mean that is compared. `rectangle`: pixels x0, y0, x1, y1 from the upper left; None: the whole picture. `known`: its
    value, by a closed form."""

    name: str = ""
    rectangle: tuple = None
    channels: str = "RGB"  # or A
    known: float = None


@dataclasses.dataclass
class Scene:
    """`blender` holds the properties that visibility_cycles.py sets, `flags` are those of gatelight render."""

    name: str
    stage: "Stage"
    flags: tuple = ()
    blender: dict = dataclasses.field(default_factory=dict)
    regions: tuple = (Region(),)
    environment: float = 0.0  # a grey radiance
    fog: float = 0.0  # white, its extinction per metre
    transparent: bool = False  # the film
    depth: int = 64  # scattering events; 1: direct light
    spp: int = 512
    pixels: int = 64


class Stage:
    """A glTF file."""

    def __init__(self):
        self.glb = glb.Glb("visibility")

    def material(self, name, base, **more):
        return self.glb.material(name, base=base, **{"double_sided": True, **more})

    def matte(self, base):
        """Without the specular lobe that glTF's dielectrics have."""
        return self.material("matte", base, roughness=1.0, extensions={"specular": {"specularFactor": 0.0}})

    def veil(self, base, alpha):
        index = self.material("veil", base, alpha=alpha, roughness=1.0, extensions={"specular": {"specularFactor": 0.0}})
        self.glb.doc["materials"][index]["alphaMode"] = "BLEND"
        return index

    def metal(self, roughness=0.0, base=(0.9, 0.9, 0.9)):
        return self.material("metal", base, metallic=1.0, roughness=roughness)

    def glass(self):
        return self.material("glass", (1.0, 1.0, 1.0), roughness=0.0, extensions=glb.glass(1.5, 0.2), double_sided=False)

    def glow(self, name, radiance):
        """Matte and black, and shines from both sides."""
        strength = max(radiance)
        return self.material(name, (0.0, 0.0, 0.0), roughness=1.0, emission=[r / strength for r in radiance],
                             strength=strength, extensions={"specular": {"specularFactor": 0.0}})

    def box(self, name, low, high, material):
        (x, y, z), (a, b, c) = low, high
        self.glb.place(name, upright([(x, y, c), (a, y, c), (a, y, z), (x, y, z)], b - y), material)

    def rectangle(self, name, corner, u, v, material):
        """The front faces along u x v."""
        at = [[p + i * a + j * b for p, a, b in zip(corner, u, v)] for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
        self.glb.place(name, polygon(*at), material)

    def room(self, material, low=(-1, 0, -1), high=(1, 2, 1), **others):
        """Six walls that face inwards; `others` are materials of single ones."""
        (x, y, z), (a, b, c) = low, high
        w, h, d = a - x, b - y, c - z
        walls = {"floor": ((x, y, c), (w, 0, 0), (0, 0, -d)), "ceiling": ((x, b, z), (w, 0, 0), (0, 0, d)),
                 "left": ((x, y, c), (0, 0, -d), (0, h, 0)), "right": ((a, y, z), (0, 0, d), (0, h, 0)),
                 "back": ((x, y, z), (w, 0, 0), (0, h, 0)), "front": ((a, y, c), (-w, 0, 0), (0, h, 0))}
        for name, (corner, u, v) in walls.items():
            self.rectangle(name, corner, u, v, others.get(name, material))

    def floor(self, material, half=4.0):
        self.rectangle("floor", (-half, 0, half), (2 * half, 0, 0), (0, 0, -2 * half), material)

    def camera(self, eye=(0, 2.2, 5.5), target=(0, 0.6, 0), fov=40):
        self.glb.camera("camera", eye, target, fov, aspect=1.0)

    def parallel_camera(self, eye, target, height):
        """A square picture of `height` metres."""
        view = {"xmag": height / 2, "ymag": height / 2, "znear": 0.01, "zfar": 100.0}
        camera = self.glb.append("cameras", {"name": "camera", "type": "orthographic", "orthographic": view})
        self.glb.node("camera", camera=camera, matrix=glb.look_at(eye, target))

    def sun(self, come_from, irradiance, name="sun"):
        self.glb.light(name, "directional", (1, 1, 1), irradiance, come_from, (0, 0, 0))

    def lamp(self, at, intensity, name="lamp", color=(1, 1, 1)):
        self.glb.light(name, "point", color, intensity, at, [p - d for p, d in zip(at, (0, 1, 0))])
