"""A closed uniform furnace: every surface reflects a and emits Le, so radiance is Le / (1 - a) in every direction."""

from glb import Glb
from shapes import Mesh, merge, sphere, surface

ALBEDO, EMISSION = 0.5, 1.0


def room(half, pieces):
    """A cube seen from inside."""
    sides = []
    for axis in range(3):
        for sign in (-1, 1):
            def at(u, v, axis=axis, sign=sign):
                p = [0.0, 0.0, 0.0]
                p[axis] = sign * half
                p[(axis + 1) % 3] = -sign * half * (2 * u - 1)
                p[(axis + 2) % 3] = half * (2 * v - 1)
                return p
            sides.append(surface(pieces, pieces, at).flat())
    return merge(*sides)


def build(path):
    numbers = {"albedo": ALBEDO, "emission": EMISSION, "radiance": EMISSION / (1 - ALBEDO)}
    glb = Glb("furnace", extras=numbers)
    # Neither highlight nor interpolated normals: both would make the reflectance depend on the direction.
    wall = glb.material("furnace", (ALBEDO,) * 3, roughness=1.0, emission=(EMISSION,) * 3,
                        extensions={"specular": {"specularFactor": 0.0}}, extras=numbers)
    ball: Mesh = sphere(0.35, 24, 12).flat()
    glb.place("room", room(1.0, 6), wall)
    balls = glb.mesh("ball", (ball, wall))
    glb.node("large ball", balls, at=(-0.4, -0.3, -0.35))
    glb.node("small ball", balls, at=(0.45, 0.2, -0.4), scale=0.6)
    glb.camera("camera", (0.2, 0.1, 0.9), (-0.05, -0.05, -0.4), 60.0, aspect=None)
    glb.write(path)
