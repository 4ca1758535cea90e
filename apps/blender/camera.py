"""The camera: its view as flags, and as a camera of the glTF file."""

import dataclasses
import math

from . import units

CAMERA = "gatelight camera"


@dataclasses.dataclass
class Lens:
    """The picture that a part is rendered of, and the slope of a ray from one pixel to the next; 0: rays are parallel, or depth is the
    distance anyway."""
    size: tuple
    slope: float


def picture_size(render):
    scale = render.resolution_percentage / 100.0
    return max(int(render.resolution_x * scale), 1), max(int(render.resolution_y * scale), 1)


def border(render, width, height):
    """The rendered part in pixels: left, bottom, right and top, y up."""
    if not render.use_border:
        return 0, 0, width, height
    left, right = int(render.border_min_x * width), int(render.border_max_x * width)
    bottom, top = int(render.border_min_y * height), int(render.border_max_y * height)
    return left, bottom, max(right, left + 1), max(top, bottom + 1)


def add(document, node, camera, render, corners, notes):
    """Sets the camera of the document's node. Returns the flags of the view, and its lens. `corners` bound what is rendered."""
    width, height = picture_size(render)
    fit = _fitted(camera.data, width, height)
    size, (x, y) = units.shifted_frame(width, height, camera.data.shift_x, camera.data.shift_y, fit)
    left, bottom, right, top = border(render, width, height)
    part = (x + left, y + height - top, x + right, y + height - bottom)
    flags = ["--camera", CAMERA, "--size", f"{size[0]}x{size[1]}"]
    if part != (0, 0, *size):
        flags += ["--region", ",".join(map(str, part))]
    if abs(render.pixel_aspect_x - render.pixel_aspect_y) > 1e-6:
        notes.add("render", "pixels that are not square")
    node["camera"] = document.add("cameras", _projection(camera.data, width, height, size))
    node.setdefault("name", CAMERA)
    if camera.data.type == "PANO":
        flags += ["--projection", "panorama"]
        kind = getattr(camera.data, "panorama_type", None) or getattr(getattr(camera.data, "cycles", None), "panorama_type", "")
        if kind != "EQUIRECTANGULAR":
            notes.add(f"camera '{camera.name}'", f"a panorama of the kind {kind}; it is latitude-longitude")
    perspective = document.json["cameras"][node["camera"]].get("perspective") if camera.data.type == "PERSP" else None
    slope = math.tan(0.5 * perspective["yfov"]) / (0.5 * size[1]) if perspective else 0.0
    return flags + _clip(camera, corners) + _blur(camera, notes), Lens(size, slope)


def _fitted(data, width, height):
    """The side of the picture, in pixels, that the sensor fits."""
    return {"HORIZONTAL": width, "VERTICAL": height}.get(data.sensor_fit, max(width, height))


def _projection(data, width, height, size):
    if data.type == "ORTHO":
        fit = _fitted(data, width, height)
        return {"name": CAMERA, "type": "orthographic", "orthographic": {
            "xmag": 0.5 * data.ortho_scale * size[0] / fit, "ymag": 0.5 * data.ortho_scale * size[1] / fit, "znear": 0.0, "zfar": 1e6}}
    fov = units.vertical_fov(data.lens, data.sensor_width, data.sensor_height, data.sensor_fit, width, height)
    fov = 2.0 * math.atan(math.tan(0.5 * fov) * size[1] / height)
    return {"name": CAMERA, "type": "perspective", "perspective": {"yfov": fov, "aspectRatio": size[0] / size[1], "znear": 1e-3}}


def _clip(camera, corners):
    """Where nothing is too far, nothing is, so that a sun's disc is in view."""
    reach = max(((corner - camera.matrix_world.translation).length for corner in corners), default=0.0)
    far = f"{camera.data.clip_end:.9g}" if reach > camera.data.clip_end else "inf"
    return ["--clip", f"{camera.data.clip_start:.9g},{far}"]


def _blur(camera, notes):
    """Depth of field."""
    lens = camera.data.dof
    if not lens.use_dof:
        return []
    what = f"camera '{camera.name}'"
    if camera.data.type != "PERSP":
        notes.add(what, "depth of field of an orthographic or panoramic camera")
        return []
    if abs(lens.aperture_ratio - 1.0) > 1e-3:
        notes.add(what, "the ratio of an anamorphic aperture")
    distance = lens.focus_distance
    if lens.focus_object:
        place = camera.matrix_world.inverted() @ lens.focus_object.matrix_world.translation
        distance = -place.z
    flags = ["--aperture", f"{0.001 * camera.data.lens / lens.aperture_fstop:.9g}", "--focus", f"{max(distance, 1e-3):.9g}"]
    if lens.aperture_blades >= 3:
        flags += ["--blades", str(lens.aperture_blades)]
    return flags
