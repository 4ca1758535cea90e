"""Reads and writes scanline EXR files with NumPy: what the program writes, without Blender's image editor."""

import dataclasses
import struct
import zlib

import numpy

TYPES = {0: numpy.dtype("<u4"), 1: numpy.dtype("<f2"), 2: numpy.dtype("<f4")}
LONG_NAMES = 4  # the only flag of the version that changes nothing here
ROWS = {0: 1, 2: 1, 3: 16}  # rows of a block: uncompressed, ZIPS, ZIP


class BadPicture(Exception):
    """The file is not an EXR that this reads."""


@dataclasses.dataclass
class Picture:
    layers: dict  # name -> array of height x width x channels, float32, rows from the top; "" is the picture itself
    attributes: dict  # texts of the header
    corner: tuple  # of the data window


def _attributes(data):
    at = 8
    while data[at] != 0:
        name_end = data.index(0, at)
        kind_end = data.index(0, name_end + 1)
        size, = struct.unpack_from("<i", data, kind_end + 1)
        value = data[kind_end + 5:kind_end + 5 + size]
        yield data[at:name_end].decode(), data[name_end + 1:kind_end].decode(), value, kind_end + 5 + size
        at = kind_end + 5 + size


def _channels(value):
    at, found = 0, []
    while value[at] != 0:
        end = value.index(0, at)
        kind, = struct.unpack_from("<i", value, end + 1)
        found.append((value[at:end].decode(), TYPES[kind]))
        at = end + 17
    return found


def _unpack(block, size):
    """Reverses the prediction and the interleaving of ZIP."""
    if len(block) == size:
        return block
    coded = numpy.frombuffer(zlib.decompress(block), numpy.uint8).astype(numpy.int64)
    coded[1:] -= 128
    halves = numpy.cumsum(coded).astype(numpy.uint8)
    plain = numpy.empty(size, numpy.uint8)
    middle = (size + 1) // 2
    plain[0::2], plain[1::2] = halves[:middle], halves[middle:]
    return plain.tobytes()


def _layer_of(channel):
    return channel.rpartition(".")[0]


def _order(channel):
    letter = channel.rpartition(".")[2]
    return "RGBAXYZ".find(letter), letter


def read(path):
    """The layers of a picture. Throws BadPicture."""
    with open(path, "rb") as file:
        data = file.read()
    try:
        return _parse(data)
    except (struct.error, ValueError, IndexError, KeyError, zlib.error) as error:
        raise BadPicture(f"'{path}' is not a picture of the program: {error}") from error


def _parse(data):
    if data[:4] != b"\x76\x2f\x31\x01" or data[5] & ~LONG_NAMES:
        raise ValueError("expected an EXR of one part with scanlines")
    header, texts, end = {}, {}, 8
    for name, kind, value, end in _attributes(data):
        header[name] = value
        if kind == "string":
            texts[name] = value.decode(errors="replace")
    channels, compression = _channels(header["channels"]), header["compression"][0]
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height, rows = x1 - x0 + 1, y1 - y0 + 1, ROWS[compression]
    planes = {name: numpy.empty((height, width), numpy.float32) for name, _ in channels}
    row_bytes = sum(kind.itemsize for _, kind in channels) * width
    blocks = -(-height // rows)
    for offset in struct.unpack_from(f"<{blocks}q", data, end + 1):
        y, size = struct.unpack_from("<2i", data, offset)
        first, count = y - y0, min(rows, height - (y - y0))
        block = numpy.frombuffer(_unpack(data[offset + 8:offset + 8 + size], row_bytes * count), numpy.uint8)
        block, at = block.reshape(count, row_bytes), 0
        for name, kind in channels:
            part = numpy.ascontiguousarray(block[:, at:at + width * kind.itemsize])
            planes[name][first:first + count] = part.view(kind)
            at += width * kind.itemsize
    layers = {}
    for name in sorted(planes, key=_order):
        layers.setdefault(_layer_of(name), []).append(planes[name])
    return Picture({name: numpy.stack(parts, axis=-1) for name, parts in layers.items()}, texts, (x0, y0))


def write(path, pixels):
    """Writes height x width x 3 values as an uncompressed EXR of 32 bits, rows from the top."""
    height, width, _ = pixels.shape
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    listed = b"".join(name + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    attributes = [("channels", "chlist", listed), ("compression", "compression", b"\0"), ("dataWindow", "box2i", window),
                  ("displayWindow", "box2i", window), ("lineOrder", "lineOrder", b"\0"),
                  ("pixelAspectRatio", "float", struct.pack("<f", 1.0)), ("screenWindowCenter", "v2f", struct.pack("<2f", 0.0, 0.0)),
                  ("screenWindowWidth", "float", struct.pack("<f", 1.0))]
    head = b"\x76\x2f\x31\x01\x02\0\0\0" + b"".join(
        f"{name}\0{kind}\0".encode() + struct.pack("<i", len(value)) + value for name, kind, value in attributes) + b"\0"
    size = 12 * width
    start = len(head) + 8 * height
    with open(path, "wb") as file:
        file.write(head + struct.pack(f"<{height}q", *(start + row * (8 + size) for row in range(height))))
        for row in range(height):
            planes = numpy.ascontiguousarray(pixels[row, :, ::-1].T, "<f4")
            file.write(struct.pack("<2i", row, size) + planes.tobytes())
