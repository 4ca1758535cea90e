"""Procedural pictures. A picture is a list of rows of floats (grey) or tuples (colour), sRGB in [0, 1]."""

import math
import random

from glb import png


def encode(rows, levels=256):
    """PNG of a picture. Fewer levels pack better, and are not visible in a noisy texture."""
    step = 256 // levels
    flat = []
    for row in rows:
        for pixel in row:
            for value in pixel if isinstance(pixel, tuple) else (pixel,):
                byte = min(255, max(0, round(value * 255)))
                flat.append(min(255, round(byte / step) * step))
    channels = len(rows[0][0]) if isinstance(rows[0][0], tuple) else 1
    return png(len(rows[0]), len(rows), channels, flat)


def noise(seed, width, height, cells_x, cells_y):
    """Smooth random values in [0, 1] that repeat at the borders."""
    generator = random.Random(seed)
    lattice = [[generator.random() for _ in range(cells_x)] for _ in range(cells_y)]
    columns = []
    for x in range(width):
        at = x * cells_x / width
        i = int(at)
        f = at - i
        columns.append((i % cells_x, (i + 1) % cells_x, f * f * (3 - 2 * f)))
    rows = []
    for y in range(height):
        at = y * cells_y / height
        j = int(at)
        f = at - j
        f = f * f * (3 - 2 * f)
        line = [a + (b - a) * f for a, b in zip(lattice[j % cells_y], lattice[(j + 1) % cells_y])]
        rows.append([line[i] + (line[k] - line[i]) * t for i, k, t in columns])
    return rows


def fractal(seed, width, height, cells_x, cells_y, octaves=4, gain=0.5):
    """Octaves of noise, scaled to [0, 1]."""
    total, weight = [[0.0] * width for _ in range(height)], 0.0
    for octave in range(octaves):
        amplitude = gain ** octave
        weight += amplitude
        layer = noise(seed + octave, width, height, cells_x << octave, cells_y << octave)
        total = [[a + amplitude * b for a, b in zip(row, more)] for row, more in zip(total, layer)]
    return [[v / weight for v in row] for row in total]


def picture(width, height, pixel):
    """The picture of all pixel(x, y)."""
    return [[pixel(x, y) for x in range(width)] for y in range(height)]


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def step(low, high, value):
    t = min(1.0, max(0.0, (value - low) / (high - low)))
    return t * t * (3 - 2 * t)


def normals(heights, strength):
    """Tangent-space normals (+y up) of a repeating height field; `strength` is in heights per pixel."""
    h, w = len(heights), len(heights[0])

    def pixel(x, y):
        row, above, below = heights[y], heights[y - 1], heights[(y + 1) % h]
        dx = (row[x - 1] - row[(x + 1) % w]) * strength
        dy = (below[x] - above[x]) * strength
        scale = 0.5 / math.sqrt(dx * dx + dy * dy + 1)
        return (0.5 + dx * scale, 0.5 + dy * scale, 0.5 + scale)

    return picture(w, h, pixel)


def herringbone(size=512, length=4):
    """Oak blocks: colour, and heights of their grooves and rounded edges. Repeats after 2 * length widths."""
    cell = size // (2 * length)
    grain = fractal(11, size, size, 3, 48, 3, 0.6)
    rings = noise(23, size, size, 2, 14)
    generator = random.Random(5)
    tones = {}
    colour, heights = [], []
    for y in range(size):
        line, profile = [], []
        for x in range(size):
            i, j = x // cell, y // cell
            d = (i - j) % (2 * length)
            if d < length:
                along, across, block = d * cell + x % cell, y % cell, ("h", (i - d) % (2 * length), j)
            else:
                along, across = (2 * length - 1 - d) * cell + y % cell, x % cell
                block = ("v", i, (j - (2 * length - 1 - d)) % (2 * length))
            if block not in tones:
                tones[block] = (generator.random(), generator.randrange(size), generator.randrange(size))
            tone, shift_x, shift_y = tones[block]
            u, v = (along + shift_x) % size, (across + shift_y) % size
            g = 0.65 * grain[v][u] + 0.35 * rings[v][u]
            pores = step(0.62, 0.78, grain[v][(u * 2) % size])
            edge = min(across, cell - 1 - across, along, length * cell - 1 - along)
            shade = (0.84 + 0.24 * tone) * (0.80 + 0.42 * g) * (1 - 0.16 * pores) * (0.55 if edge < 1 else 1.0)
            base = mix((0.60, 0.41, 0.25), (0.70, 0.50, 0.31), tone)
            line.append(tuple(c * shade for c in base))
            profile.append(min(edge, 3) / 3 + 0.10 * tone)
        colour.append(line)
        heights.append(profile)
    return colour, heights


def marble(size=256):
    """White stone with grey and golden veins."""
    warp_x, warp_y = fractal(31, size, size, 3, 3, 4), fractal(41, size, size, 3, 3, 4)
    veins, fine = fractal(51, size, size, 2, 2, 5, 0.55), fractal(61, size, size, 5, 5, 3)

    def pixel(x, y):
        u = int(x + 90 * (warp_x[y][x] - 0.5)) % size
        v = int(y + 90 * (warp_y[y][x] - 0.5)) % size
        vein = 1 - step(0.0, 0.055, abs(veins[v][u] - 0.5))
        thin = 1 - step(0.0, 0.02, abs(fine[v][u] - 0.48))
        cloud = fine[y][x]
        colour = mix((0.93, 0.92, 0.90), (0.84, 0.83, 0.82), cloud)
        colour = mix(colour, (0.50, 0.50, 0.53), 0.75 * vein * (0.4 + 0.6 * cloud))
        return mix(colour, (0.66, 0.56, 0.42), 0.45 * thin)

    return picture(size, size, pixel)


def plaster(size=192):
    """Heights of trowelled plaster."""
    return fractal(71, size, size, 5, 4, 4, 0.55)


def weave(size=64, threads=8):
    """Heights of a plain weave of threads."""
    def pixel(x, y):
        u, v = x * threads / size, y * threads / size
        over, under = (v, u) if (int(u) + int(v)) % 2 else (u, v)
        return abs(math.sin(math.pi * over)) * (0.6 + 0.4 * abs(math.sin(math.pi * under)))

    return picture(size, size, pixel)


def rug(width=384, height=256):
    """A flat-woven rug: borders about a field of stepped lozenges."""
    cream, ink, clay, blue, ochre = ((0.86, 0.81, 0.71), (0.17, 0.19, 0.25), (0.66, 0.29, 0.19),
                                     (0.22, 0.36, 0.44), (0.78, 0.58, 0.28))
    wear = fractal(81, width, height, 12, 8, 4, 0.6)
    yarn = noise(91, width, height, width // 2, height)

    def pixel(x, y):
        # Stitches are three pixels: slanted edges become steps.
        i, j = x // 3, y // 3
        border = min(i, j, (width - 1) // 3 - i, (height - 1) // 3 - j)
        if border < 2:
            colour = ink
        elif border < 4:
            colour = cream
        elif border < 11:
            tooth = abs((i + j * (width // height == 0)) % 10 - 5) if border in (4, 10) else abs((i + j) % 10 - 5)
            colour = clay if tooth + abs(border - 7) > 4 else ochre
            if tooth + abs(border - 7) < 2:
                colour = ink
        elif border < 13:
            colour = cream if border == 11 else ink
        else:
            a, b = (i - width // 6) % 28 - 14, (j - height // 6) % 28 - 14
            d = abs(a) + abs(b)
            colour = cream
            if d in (13, 14):
                colour = ink
            elif 9 <= d <= 11:
                colour = clay if (i - width // 6 + 14) // 28 % 2 == (j - height // 6 + 14) // 28 % 2 else blue
            elif d in (5, 6):
                colour = ochre
            elif d <= 2:
                colour = ink
        return tuple(c * (0.78 + 0.22 * wear[y][x] + 0.14 * (yarn[y][x] - 0.5)) for c in colour)

    return picture(width, height, pixel)


def mountains(width=320, height=224):
    """A painting: ranges of hills in the mist before a low sun."""
    grain = fractal(101, width, height, 40, 28, 3, 0.7)
    ridges = []
    for layer in range(6):
        base = noise(110 + layer, width, 1, 3 + layer, 1)[0]
        rough = fractal(120 + layer, width, 1, 9 + 4 * layer, 1, 4)[0]
        ridges.append([height * (0.42 + 0.095 * layer - 0.20 * (b - 0.35) - 0.07 * (r - 0.5))
                       for b, r in zip(base, rough)])
    far, near = (0.80, 0.66, 0.55), (0.07, 0.15, 0.19)

    def pixel(x, y):
        sky = mix((0.93, 0.75, 0.52), (0.38, 0.50, 0.56), step(0.55, -0.05, y / height))
        sun = math.hypot(x - 0.66 * width, y - 0.30 * height) / height
        colour = mix((0.98, 0.88, 0.66), sky, step(0.0, 0.42, sun))
        colour = mix(colour, (0.96, 0.52, 0.27), step(0.092, 0.080, sun))
        for layer, ridge in enumerate(ridges):
            depth = y - ridge[x]
            if depth > 0:
                tone = mix(far, near, ((layer + 0.6) / 6) ** 0.8)
                colour = mix(tone, mix(tone, (0.88, 0.74, 0.60), 0.55 - 0.07 * layer), step(0, 50, depth))
        return tuple(c * (0.90 + 0.2 * grain[y][x]) for c in colour)

    return picture(width, height, pixel)


def leaf(width=128, height=160):
    """A monstera leaf, its stalk at the bottom: colour and coverage."""
    spots = fractal(131, width, height, 5, 6, 3)

    def pixel(x, y):
        u, v = (x + 0.5) / width * 2 - 1, 1 - (y + 0.5) / height
        side = abs(u)
        # A heart: half its width at height v; the lobes reach below the stalk at v = 0.18.
        outline = 0.97 * math.sin(math.pi * min(1.0, max(0.0, v)) ** 0.62) ** 0.75
        inside = side < outline and not (v < 0.17 and side < 0.25 * (0.17 - v) / 0.17)
        rib = v - 0.18 - 0.42 * side
        phase = (rib * 6.5) % 1.0
        slit = 0.33 < phase < 0.62 and side > outline * (0.42 + 0.10 * math.sin(20 * v)) and 0.05 < rib < 0.72
        hole = math.hypot((phase - 0.48) / 2.4, side - 0.20) < 0.055 and 0.08 < rib < 0.6
        vein = max(step(0.035, 0.012, side), 0.7 * step(0.10, 0.03, abs(phase - 0.98)) * (rib > -0.1))
        green = mix((0.10, 0.27, 0.10), (0.20, 0.42, 0.15), spots[y][x])
        cover = 1.0 if inside and not slit and not hole else 0.0
        return (*mix(green, (0.52, 0.66, 0.36), 0.55 * vein), cover)

    return picture(width, height, pixel)


def lace(size=128):
    """A net with flowers: white, and where it is."""
    def pixel(x, y):
        u, v = (x + 0.5) / size, (y + 0.5) / size
        net = min(abs((u * 16 + v * 16) % 1 - 0.5), abs((u * 16 - v * 16) % 1 - 0.5)) < 0.17
        flower = False
        for cu, cv in ((0.5, 0.5), (0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)):
            r, angle = math.hypot(u - cu, v - cv), math.atan2(v - cv, u - cu)
            flower |= 0.03 < r < 0.13 + 0.07 * math.cos(6 * angle) and abs(math.cos(3 * angle)) > 0.22
        return (0.96, 0.95, 0.92, 1.0 if net or flower else 0.0)

    return picture(size, size, pixel)


def sky(width=192, height=128):
    """An evening sky over misty trees, for the window."""
    clouds = fractal(141, width, height, 3, 7, 5, 0.55)
    crowns = [fractal(150 + k, width, 1, 5 + 4 * k, 1, 4, 0.6)[0] for k in range(3)]

    def pixel(x, y):
        v = y / height
        colour = mix((0.30, 0.49, 0.82), (0.86, 0.82, 0.80), step(0.05, 0.72, v))
        colour = mix(colour, (0.97, 0.95, 0.94), 0.65 * step(0.48, 0.72, clouds[y][x]))
        for layer, crown in enumerate(crowns):
            top = 0.60 + 0.10 * layer - 0.22 * (crown[x] - 0.4)
            tone = mix((0.56, 0.64, 0.70), (0.17, 0.27, 0.26), layer / 2)
            colour = mix(colour, tone, 0.9 * step(top - 0.012, top + 0.012, v))
        return colour

    return picture(width, height, pixel)


def lantern(width=4, height=128, ribs=20):
    """The glow of a paper lantern from bottom to top: bright in the middle, a thin shadow at each rib."""
    rows = []
    for y in range(height):
        v = (y + 0.5) / height
        glow = 0.45 + 0.55 * math.sin(math.pi * v) ** 0.8
        glow *= 1 - 0.28 * step(0.38, 0.5, abs((v * ribs) % 1 - 0.5))
        rows.append([(glow, glow * 0.76, glow * 0.49)] * width)
    return rows
