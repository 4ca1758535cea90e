"""Furniture of the living room, each piece standing on y = 0 about the origin and facing +z."""

import math

from shapes import catmull_rom, lathe, merge, rounded_box, surface, tube


def tub_chair_shell(channels=15):
    """The upholstered back and arms of a tub chair: a rounded section swept round the seat, stitched in channels."""
    spread = math.radians(128)

    def at(u, v):
        angle = spread * (2 * u - 1)
        # The arms fall away towards the front and end round.
        back = 0.5 + 0.5 * math.cos(angle * math.pi / spread)
        end = min(u, 1 - u) * 11.0
        cap = math.sqrt(max(0.0, 1 - (1 - end) ** 2)) if end < 1 else 1.0
        low, high = 0.13, 0.53 + 0.23 * back ** 1.2
        thick, radius = 0.125 * (0.35 + 0.65 * cap), 0.33
        tuft = 0.026 * (abs(math.sin(channels * math.pi * u)) ** 0.7 - 0.8) * min(1.0, end)
        # A superellipse about the middle of the wall.
        phi = 2 * math.pi * v
        c, s = math.cos(phi), math.sin(phi)
        out = math.copysign(abs(c) ** 0.55, c) * (thick / 2 + tuft)
        up = math.copysign(abs(s) ** 0.35, s) * (high - low) / 2 * (0.86 + 0.14 * cap)
        r = radius + thick / 2 + out + 0.05 * (up / (high - low)) * back
        return r * math.sin(angle), (low + high) / 2 + up, -r * math.cos(angle) * 0.97

    return surface(8 * channels, 22, at).flipped()


def seat_cushion():
    """A round cushion with a piped edge."""
    profile = catmull_rom([(0.30, 0.29), (0.365, 0.30), (0.385, 0.345), (0.37, 0.40), (0.34, 0.425), (0.2, 0.452),
                           (0.0, 0.46)], 5)
    return lathe(profile, 48, 80)


def chair_base():
    """The plinth under the cushion."""
    return lathe([(0.0, 0.13), (0.33, 0.13), (0.345, 0.15), (0.345, 0.31), (0.0, 0.31)], 48)


def tapered_leg(height, top=0.017, bottom=0.009, segments=16):
    return lathe([(0.0, 0.0), (bottom, 0.0), (bottom, 0.004), (top, height), (0.0, height)], segments)


def splayed_legs(height, spread, lean_degrees, **sizes):
    """Four legs that lean outwards."""
    leg = tapered_leg(height / math.cos(math.radians(lean_degrees)), **sizes)
    drift = height * math.tan(math.radians(lean_degrees))
    return merge(*(leg.moved(spread + drift, 0, 0).turned("z", 0).map(
        lambda p: (p[0] - drift * p[1] / height, p[1], p[2])).turned("y", 45 + 90 * k) for k in range(4)))


def round_wall(columns, rows, height, radius):
    """A wall around the y axis, with the radius `radius(angle, v)`."""
    def at(u, v):
        angle = 2 * math.pi * u
        r = radius(angle, v)
        return r * math.sin(angle), height * v, r * math.cos(angle)
    return surface(columns, rows, at, wrap=True)


def fluted_drum(radius, height, flutes=36):
    """A drum with half-round flutes."""
    return round_wall(6 * flutes, 1, height, lambda angle, v: radius * (1 - 0.035 * abs(math.cos(flutes * angle / 2)) ** 2.2))


def disc(radius, thickness, edge, segments=72):
    """A table top about y = 0 upwards, its edge rounded."""
    arc = [(radius - edge + edge * math.sin(a), thickness / 2 - thickness / 2 * math.cos(a))
           for a in (math.pi * k / 8 for k in range(9))]
    return lathe([(0.0, 0.0), *arc, (0.0, thickness)], segments, 60)


def sideboard_body(width=1.9, height=0.58, depth=0.45):
    return rounded_box((width, height, depth), 0.018, 4).moved(0, 0.2 + height / 2, 0)


def sideboard_door(width, height):
    return rounded_box((width, height, 0.024), 0.009, 3)


def knob():
    return lathe(catmull_rom([(0.006, 0.0), (0.006, 0.014), (0.015, 0.022), (0.016, 0.029), (0.0, 0.034)], 4),
                 20, 80).turned("x", 90)


def table_lamp_base():
    """A turned brass base with its stem."""
    profile = catmull_rom([(0.085, 0.0), (0.088, 0.012), (0.07, 0.022), (0.022, 0.035), (0.018, 0.06), (0.055, 0.115),
                           (0.072, 0.165), (0.06, 0.215), (0.022, 0.26), (0.012, 0.29), (0.018, 0.30), (0.009, 0.31),
                           (0.009, 0.42)], 5)
    return lathe([(0.0, 0.0), *profile], 48, 40)


def shade(bottom=0.165, top=0.105, height=0.21, segments=64):
    """An open lampshade: a cone of no thickness, its lower rim at y = 0."""
    return round_wall(segments, 6, height, lambda angle, v: bottom + (top - bottom) * v)


def ring(radius, thickness, segments=64):
    """A round wire lying flat."""
    return lathe([(radius + thickness * math.cos(a), thickness * math.sin(a)) for a in
                  (-math.pi + 2 * math.pi * k / 8 for k in range(9))], segments, 80)


def paper_lantern(ribs=20):
    """A tall lantern of paper over bamboo rings, its lower end at y = 0; the picture of its glow runs along v."""
    def radius(_angle, v):
        belly = 0.10 + 0.115 * math.sin(math.pi * (0.08 + 0.84 * v)) ** 0.7
        return belly * (1 - 0.030 * abs(math.cos(math.pi * ribs * v)) ** 3)

    return round_wall(48, 4 * ribs, 0.62, radius)


def tripod(height, spread=0.24):
    return merge(*(tube([(0.035, height, 0.0), (spread, 0.0, 0.0)], [0.013, 0.009], 12).turned("y", 30 + 120 * k)
                   for k in range(3)), ring(0.05, 0.012, 32).moved(0, height - 0.04, 0))


def picture_frame(width, height, bar=0.055, depth=0.035):
    """A profiled frame round a picture of the given size, mitred, the wall at z = 0."""
    section = [(0.0, 0.0), (0.0, 0.5), (0.12, 0.62), (0.25, 0.62), (0.38, 0.78), (0.62, 1.0), (0.82, 1.0), (1.0, 0.75),
               (1.0, 0.0)]
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    parts = []
    for k in range(4):
        (ax, ay), (bx, by) = corners[k], corners[(k + 1) % 4]
        for (o0, d0), (o1, d1) in zip(section, section[1:]):
            def at(u, v, a=(ax, ay), b=(bx, by), o=(o0, o1), d=(d0, d1)):
                out = (o[0] + (o[1] - o[0]) * v) * bar
                x, y = (a[i] + (b[i] - a[i]) * u for i in range(2))
                return x * (width / 2 + out), y * (height / 2 + out), (d[0] + (d[1] - d[0]) * v) * depth
            parts.append(surface(1, 1, at).flipped())
    return merge(*parts)


def drape(width, height, folds, depth, columns_per_fold=10, rows=14):
    """A curtain hanging from y = height, gathered at the top."""
    def at(u, v):
        loose = 1 - v
        wave = math.sin(2 * math.pi * folds * u + 0.7 * math.sin(2 * math.pi * 1.3 * u + 2.0 * loose))
        x = width * (u - 0.5) * (1 + 0.05 * loose) + 0.012 * math.sin(9 * u + 3 * loose)
        return x, height * v, depth * wave * (0.55 + 0.45 * loose) + 0.02 * loose * math.sin(4 * u)
    return surface(folds * columns_per_fold, rows, at)
