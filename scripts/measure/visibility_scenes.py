"""The scenes of compare-visibility."""

import math

from visibility_stage import BLUE, GREEN, GREY, RED, WHITE, Region, Scene, Stage

KINDS = ("camera", "diffuse", "glossy", "transmission", "volume_scatter", "shadow")  # of rays, as Blender names them
WHOLE, ALPHA = Region(), Region("A", channels="A")


def seen(name, stage, thing, rays, values, *regions, **more):
    """`rays`: what --visibility says of the thing, `values`: the same as properties of Blender's object."""
    return Scene(name, stage, ["--visibility", f"{thing}={rays}"], {"objects": {thing: values}}, regions or [WHOLE], **more)


def hidden(*kinds):
    return {f"visible_{kind}": False for kind in kinds}


def all_but(kind):
    return hidden(*(other for other in KINDS if other != kind))


def linked(name, stage, light, key, members, *regions, **more):
    """`key` is one of --light-links."""
    state = "EXCLUDE" if key.startswith("not-") else "INCLUDE"
    return Scene(name, stage, ["--light-links", f"{light}={key}:{'+'.join(members)}"],
                 {key.removeprefix("not-"): {light: dict.fromkeys(members, state)}}, regions or [WHOLE], **more)


# Stages


def yard():
    """A floor before the camera."""
    stage = Stage()
    stage.floor(stage.matte(GREY))
    stage.camera()
    return stage


def red_and_blue(stage):
    """Boxes whose ends below the floor nobody sees: faces in one plane would be seen by chance."""
    stage.box("red box", (-1.3, -0.1, -0.5), (-0.3, 1.2, 0.5), stage.matte(RED))
    stage.box("blue box", (0.3, -0.1, -0.5), (1.3, 1.2, 0.5), stage.matte(BLUE))


def shadow_yard():
    stage = yard()
    red_and_blue(stage)
    stage.sun((2, 3, -3), 2.0)
    stage.lamp((0, 2.2, -1.2), 2.0)
    return stage


SHADOW = Region("shadow", (0, 43, 18, 53))  # of its red box


def veiled_yard():
    """A blended rectangle before the boxes."""
    stage = shadow_yard()
    stage.rectangle("veil", (-0.9, 0.2, 1.2), (1.4, 0, 0), (0, 1.3, 0), stage.veil(GREY, 0.4))
    return stage


def mirror_yard(roughness=0.0):
    stage = yard()
    stage.rectangle("mirror", (-2.5, 0, -1.5), (5, 0, 0), (0, 2.5, 0), stage.metal(roughness))
    stage.box("red box", (-1.2, -0.1, -0.5), (-0.3, 1, 0.4), stage.matte(RED))
    stage.box("blue box", (0.3, -0.1, -0.5), (1.2, 1, 0.4), stage.matte(BLUE))
    stage.sun((2, 4, -3), 1.5)
    return stage


MIRRORED = Region("in the mirror", (19, 19, 29, 26))  # its red box


def walls_from_above():
    stage = Stage()
    stage.floor(stage.matte(GREY))
    stage.rectangle("left", (-1, 0, 2), (0, 0, -4), (0, 1.5, 0), stage.matte(RED))
    stage.rectangle("right", (1, 0, -2), (0, 0, 4), (0, 1.5, 0), stage.matte(WHITE))
    stage.parallel_camera((0, 5, 0), (0, 0, 0), 1.9)
    return stage


def glow_yard():
    stage = yard()
    red_and_blue(stage)
    stage.rectangle("glow", (-1.5, 2.6, -2), (2, 0, 0), (0, 0, 2), stage.glow("glow", (4, 4, 4)))
    return stage


def glass_yard(right=0.6):
    """`right`: the edge of the glass."""
    stage = yard()
    stage.box("slab", (-1.5, 0.1, 0.9), (right, 1.8, 1.1), stage.glass())
    stage.box("red box", (-1.1, -0.1, -0.6), (-0.3, 1.2, 0.2), stage.matte(RED))
    stage.box("blue box", (0.1, -0.1, -0.6), (1.1, 1, 0.2), stage.matte(BLUE))
    stage.rectangle("glow", (-1, 3, -0.5), (2, 0, 0), (0, 0, 2), stage.glow("glow", (3, 3, 3)))
    return stage


def glow_and_mirror():
    stage = yard()
    stage.rectangle("mirror", (-2.2, 0, -1), (3, 0, -1), (0, 2.2, 0), stage.metal())
    stage.rectangle("glow", (0.9, 0.3, -0.8), (0.8, 0, 0.3), (0, 1.2, 0), stage.glow("glow", (3, 2, 1)))
    stage.box("metal box", (-0.6, -0.1, 0.5), (0.4, 0.5, 1.5), stage.metal(0.3))
    return stage


def metal_yard():
    stage = yard()
    stage.rectangle("plate", (-1.2, 0.01, 1.8), (2.4, 0, 0), (0, 0, -2.4), stage.metal(0.3))
    stage.box("red box", (-1, -0.1, -0.5), (0, 1, 0.5), stage.matte(RED))
    stage.lamp((0.9, 1.5, -1.5), 3.0)
    stage.lamp((-2, 1.5, 1), 0.5, "other")
    return stage


def open_yard():
    """The sky is in the upper rows."""
    stage = yard()
    stage.box("red box", (-1.3, -0.1, -0.5), (-0.3, 1.2, 0.5), stage.matte(RED))
    stage.rectangle("mirror", (0, 0, -0.5), (1.5, 0, 0.4), (0, 1.2, 0), stage.metal())
    stage.sun((2, 3, 3), 0.5)
    return stage


SKY = (0, 0, 64, 8)


def foggy_room(lamp=True):
    """Fog fills the scene's bounds in Gatelight and the whole space in Cycles, so the room is closed."""
    stage = Stage()
    stage.room(stage.matte(GREY), left=stage.matte(RED))
    if lamp:
        stage.lamp((0.5, 0.6, -0.4), 1.0)
    stage.rectangle("glow", (-0.3, 1.2, -0.3), (0.6, 0, 0), (0, 0.5, 0), stage.glow("glow", (8, 8, 8)))
    stage.camera((0, 1, 0.98), (0, 1, 0), 70)
    return stage


FOG = {"fog": 0.4, "spp": 256}


# Nothing is hidden: units, materials and lights agree


def plain():
    stage = yard()
    stage.box("red box", (-1.4, -0.1, -0.5), (-0.4, 1.2, 0.5), stage.matte(RED))
    stage.box("metal box", (0.4, -0.1, -0.5), (1.4, 1.2, 0.5), stage.metal(0.3))
    stage.rectangle("mirror", (-2, 0, -1.5), (4, 0, 0), (0, 1.5, 0), stage.metal())
    stage.rectangle("glow", (-1.5, 2.5, 1), (0.8, 0, 0), (0, 0, 0.8), stage.glow("glow", (6, 5, 4)))
    stage.sun((2, 4, 3), 1.0)
    stage.lamp((1.5, 1.5, 1.5), 0.7)
    yield Scene("plain", stage, environment=0.2)
    yield Scene("plain, glass", glass_yard(), environment=0.4)
    yield Scene("plain, fog", foggy_room(), **FOG)


def plain_floor():
    stage = Stage()
    stage.floor(stage.matte(GREY), half=50)
    stage.parallel_camera((0, 5, 0), (0, 0, 0), 0.01)
    stage.sun((3, 4, 0), 2.0)
    stage.lamp((0, 2, 0), 3.0)
    radiance = 0.5 * (0.5 + (2.0 * 0.8 + 3.0 / 4) / math.pi)
    yield Scene("plain, floor alone", stage, regions=[Region(known=radiance)], environment=0.5)


# What single rays do not see


def objects():
    stage = Stage()
    stage.room(stage.matte(GREY), left=stage.matte(RED), right=stage.matte(GREEN))
    stage.lamp((0.2, 1.4, 0), 3.0)
    stage.camera((0, 1, 5), (0, 1, 0), 26)
    yield seen("camera off", stage, "front", "camera:off", hidden("camera"))
    yield seen("camera off behind a veil", veiled_yard(), "red box", "camera:off", hidden("camera"), environment=0.2)
    yield seen("camera only", shadow_yard(), "red box", "camera:only", all_but("camera"), WHOLE, SHADOW)
    yield seen("glossy off", mirror_yard(), "red box", "glossy:off", hidden("glossy"), WHOLE, MIRRORED, environment=0.3)
    yield seen("transmission off", glass_yard(), "red box", "transmission:off", hidden("transmission"), WHOLE,
               Region("behind the glass", (15, 22, 27, 38)), environment=0.4)
    yield seen("volume off", foggy_room(lamp=False), "glow", "volume:off", hidden("volume_scatter"), **FOG)
    yield seen("bounces off", mirror_yard(), "red box", "bounces:off", hidden(*KINDS[1:5]), WHOLE, MIRRORED)
    yield seen("shadow off", shadow_yard(), "red box", "shadow:off", hidden("shadow"), WHOLE, SHADOW)
    yield seen("shadow only", shadow_yard(), "red box", "shadow:only", all_but("shadow"), WHOLE, SHADOW)


def diffuse_off():
    stage = walls_from_above()
    stage.lamp((0.1, 1, 0), 1.0)
    yield seen("diffuse off", stage, "right", "diffuse:off", hidden("diffuse"))


def found_twice():
    """Light samples and bounces both find an emitter or an environment. An object that only one of them sees gets a share that
    depends on their weights. Cycles finds an environment of one colour by bounces alone."""
    stage = yard()
    red_and_blue(stage)
    yield seen("shadow off, environment", stage, "red box", "shadow:off", hidden("shadow"), environment=0.5)
    yield seen("shadow off, emitter", glow_yard(), "red box", "shadow:off", hidden("shadow"), WHOLE, SHADOW)
    yield seen("diffuse off, environment", walls_from_above(), "right", "diffuse:off", hidden("diffuse"), environment=0.5)
    yield seen("glossy off, rough metal", mirror_yard(0.2), "red box", "glossy:off", hidden("glossy"), WHOLE, MIRRORED,
               environment=0.3)


def indirect_only():
    stage = yard()
    stage.box("glow", (-1, 0.2, -0.8), (-0.2, 1, 0), stage.glow("glow", (3, 2, 1)))
    stage.box("green box", (0.2, -0.1, -0.8), (1, 1, 0), stage.matte(GREEN))
    yield Scene("indirect only", stage, ["--visibility", "glow=camera:off;green box=camera:off"],
                {"indirect_only": ["glow", "green box"]}, environment=0.2)


def lights():
    yield seen("emitter, camera off", glow_and_mirror(), "glow", "camera:off", hidden("camera"))
    yield seen("emitter, diffuse off", glow_and_mirror(), "glow", "diffuse:off", hidden("diffuse"))
    yield seen("emitter, transmission off", glass_yard(), "glow", "transmission:off", hidden("transmission"))
    yield seen("lamp, diffuse off", metal_yard(), "lamp", "diffuse:off", hidden("diffuse"))
    yield seen("lamp, glossy off", metal_yard(), "lamp", "glossy:off", hidden("glossy"))
    yield seen("lamp, volume off", foggy_room(), "lamp", "volume:off", hidden("volume_scatter"), **FOG)


def environment():
    def unseen(name, rays, kinds, region):
        return Scene(name, open_yard(), ["--visibility", f"environment={rays}"], {"world": dict.fromkeys(kinds, False)},
                     [WHOLE, region], environment=0.6)

    yield unseen("environment, camera only", "camera:only", ["diffuse", "glossy", "transmission", "scatter"],
                 Region("sky", SKY, known=0.6))
    yield unseen("environment, camera off", "camera:off", ["camera"], Region("sky", SKY, known=0.0))
    yield unseen("environment, glossy off", "glossy:off", ["glossy"], Region("in the mirror", (27, 21, 56, 42)))


# Links of lights


def links():
    stage = shadow_yard()
    stage.lamp((0, 1.5, 2), 3.0, "key", (1, 0.8, 0.5))
    yield linked("lamp, receivers", stage, "key", "receivers", ["red box"])
    yield linked("lamp, not receivers", stage, "key", "not-receivers", ["red box", "floor"])
    # Fog is only a receiver of lights that name none.
    yield linked("lamp, receivers, fog", foggy_room(), "lamp", "receivers", ["left"], **FOG)
    yield linked("lamp, not receivers, fog", foggy_room(), "lamp", "not-receivers", ["back"], **FOG)
    yield linked("lamp, blockers", shadow_yard(), "lamp", "blockers", ["blue box"], WHOLE, SHADOW)
    yield linked("sun, not blockers", shadow_yard(), "sun", "not-blockers", ["red box"], WHOLE, SHADOW)


def links_of_emitters():
    stage = yard()
    red_and_blue(stage)
    stage.rectangle("glow", (-0.8, 2.2, 0.5), (1.6, 0, 0), (0, 0, 1), stage.glow("glow", (4, 4, 4)))
    stage.lamp((0, 1.5, 2), 1.0)
    yield linked("emitter, receivers", stage, "glow", "receivers", ["red box"])
    yield linked("emitter, not blockers", glow_yard(), "glow", "not-blockers", ["red box"], WHOLE, SHADOW)
    stage = glow_and_mirror()
    stage.lamp((0, 1.5, 2), 1.0)
    yield linked("emitter, receivers, mirror", stage, "glow", "receivers", ["floor"])  # which the mirror is not


# Holdouts and shadow catchers


def holdouts():
    def hole(name, stage, *regions, thing="red box", **more):
        return seen(name, stage, thing, "holdout:on", {"is_holdout": True}, *regions, **more)

    stage = Stage()
    stage.rectangle("glow", (-5, -5, 0), (10, 0, 0), (0, 10, 0), stage.glow("glow", (0, 1, 0)))
    stage.rectangle("hole", (0.5, -5, 1), (5, 0, 0), (0, 10, 0), stage.matte(RED))
    stage.sun((0, 0, 1), 1.0)
    stage.parallel_camera((0, 0, 3), (0, 0, 0), 8.0)
    column = (4, 0, 5, 8)  # of eight: half of each of its pixels is covered
    yield hole("holdout, half a pixel", stage, Region("RGB", column, "RGB", 0.5 / 3), Region("A", column, "A", 0.5),
               thing="hole", transparent=True, spp=4096, pixels=8)
    yield hole("holdout, no alpha", shadow_yard(), WHOLE, Region("hole", (12, 25, 24, 42), known=0.0), environment=0.4)
    half = glass_yard(-0.6)  # of the box is behind the glass
    yield hole("holdout behind glass", half, Region("RGB"), ALPHA, environment=0.4, transparent=True)
    yield hole("holdout behind a veil", veiled_yard(), Region("RGB"), ALPHA, environment=0.2, transparent=True)
    yield hole("holdout in a mirror", mirror_yard(), Region("RGB"), MIRRORED, ALPHA, environment=0.3, transparent=True)


def catchers():
    """A black box between a floor and a wall that catch its shadows, in direct light: Gatelight's catchers know no other."""
    def stage(sun=None):
        stage = Stage()
        stage.rectangle("floor", (-2, 0, 2), (4, 0, 0), (0, 0, -3), stage.matte(GREY))
        stage.rectangle("wall", (-2, 0, -1), (4, 0, 0), (0, 3, 0), stage.matte(GREY))
        stage.box("box", (-0.5, 0.4, -0.4), (0.5, 1.2, 0.4), stage.matte((0, 0, 0)))
        if sun:
            stage.sun(sun, 2.0)
        stage.camera((0, 2, 5), (0, 0.7, 0), 40)
        return stage

    def caught(name, stage, flags=(), box=(), **more):
        objects = {"floor": {"is_shadow_catcher": True}, "wall": {"is_shadow_catcher": True}, "box": dict(box)}
        return Scene(f"two shadow catchers{name}", stage, ["--shadow-catcher", "floor;wall", *flags], {"objects": objects},
                     [ALPHA], transparent=True, depth=1, **more)

    front = (1, 2, 2)
    yield caught("", stage(front))
    yield caught(", box unseen", stage(front), ["--visibility", "box=camera:off"], hidden("camera"))
    # The wall shades the floor, which shows only the shadow of the box beyond.
    yield caught(", sun behind", stage((0.5, 2, -1)))
    yield caught(", environment", stage(), environment=0.5)


# Clipping


def clipping():
    def clipped(name, stage, near, far, *regions):
        return Scene(name, stage, ["--clip", f"{near},{far}"], {"clip": [near, far]}, regions, environment=0.3)

    # Mirrors and shadows show the boxes whole.
    yield clipped("clip near", mirror_yard(), 5.4, 1000, WHOLE, Region("cut", (13, 27, 26, 36), known=0.0))
    yield clipped("clip far", mirror_yard(), 0.01, 5.9, WHOLE)
    stage = Stage()
    stage.floor(stage.matte(GREY))
    red_and_blue(stage)
    stage.sun((2, 3, 3), 2.0)
    stage.parallel_camera((0, 2.2, 5.5), (0, 0.6, 0), 3.0)
    yield clipped("clip, parallel camera", stage, 5.2, 6.2, WHOLE)


PARTS = (plain, plain_floor, objects, diffuse_off, indirect_only, found_twice, lights, environment, links, links_of_emitters,
         holdouts, catchers, clipping)
SCENES = [scene for part in PARTS for scene in part()]
