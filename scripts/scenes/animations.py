"""Animations of a file: keys, and the values that they move."""

import math

from glb import quaternion, round_float

KINDS = {"translation": "VEC3", "rotation": "VEC4", "weights": "SCALAR", "pointer": "SCALAR"}


def times(glb, keys):
    """An accessor of rising times in seconds."""
    rounded = [round_float(key) for key in keys]
    return glb.floats(rounded, "SCALAR", min=[rounded[0]], max=[rounded[-1]])


def turn_key(degrees, speed):
    """A key of a cubic spline of rotations about y; `speed` is in degrees per second."""
    half, slope = math.radians(degrees) / 2, math.radians(speed) / 2
    tangent = [0.0, slope * math.cos(half), 0.0, -slope * math.sin(half)]
    return [*tangent, *quaternion(degrees, 0.0), *tangent]


class Animation:
    """One animation. Each channel is written when it is added."""

    def __init__(self, glb, name):
        self.glb, self.samplers, self.channels = glb, [], []
        glb.append("animations", {"name": name, "samplers": self.samplers, "channels": self.channels})

    def move(self, node, path, keys, values, interpolation="LINEAR"):
        """`keys` is an accessor of times(); `path` is translation, rotation or weights of the node."""
        self.add({"node": node, "path": path}, keys, values, interpolation)

    def change(self, pointer, keys, values, interpolation="LINEAR"):
        """A number anywhere in the file, by KHR_animation_pointer."""
        self.glb.use("KHR_animation_pointer")
        self.add({"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}}, keys, values,
                 interpolation)

    def add(self, target, keys, values, interpolation):
        self.channels.append({"sampler": len(self.samplers), "target": target})
        self.samplers.append({"input": keys, "interpolation": interpolation,
                              "output": self.glb.floats(values, KINDS[target["path"]])})
