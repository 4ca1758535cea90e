"""Sweeps that were never run, for check_report: results of closed forms and pictures of one colour each."""

import json
import os
import struct
import zlib

CPU = "Fast & <Small> 9000"


def write_png(path, color, width=320, height=180):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    os.makedirs(os.path.dirname(path), exist_ok=True)
    row = b"\0" + bytes(color) * width
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
                   + chunk(b"IDAT", zlib.compress(row * height)) + chunk(b"IEND", b""))


def cell(scene, series, seed, steps=None, spp=4, kind="path", **changes):
    """Path tracing has FLIP 0.8 / sqrt(seconds); a cache 0.4 steps^-0.25, in 0.5 + steps / 256 seconds."""
    number = abs(hash_of(f"{scene}{series}{seed}{steps}{spp}{kind}"))
    name = f"{number:016x}"
    seconds = spp / 4 if steps is None else 0.5 + steps / 256
    scale = 1 + 0.08 * (seed - 2)
    flip = scale * (0.8 / seconds ** 0.5 if steps is None else (0.6 if "hash" in series else 0.4) * steps ** -0.25)
    made = {
        "id": name, "scene": scene, "series": series, "integrator": "path" if steps is None else "nrc",
        "encoding": None if steps is None else series.split()[-1], "axes": {"encoding": series.split()[-1]}, "seed": seed,
        "train_steps": steps, "spp": spp, "options": {"size": [1280, 720], "max-depth": 8, "seed": seed, "tonemap": "filmic"},
        "status": "done", "error": None,
        "seconds": {"scout": 0.1, "setup": 0.2, "train": None if steps is None else steps / 256, "render": 0.2, "total": seconds},
        "train_ms_per_step": None if steps is None else 3.9 * scale, "train_step_ms": None if steps is None else 2.1,
        "query_ms_per_2m": None if steps is None else 41.5,
        "memory_bytes": None if steps is None else {"parameters": 50 << 20, "optimizer": 100 << 20, "layout": 12345678},
        "loss": None if steps is None else 0.01, "reference": kind, "reference_id": reference_id(scene, kind),
        "version": "1.0.0", "cpu": CPU, "isa": "avx512",
        "errors": {"mse": flip ** 2 / 3, "rel_mse": flip ** 2, "rel_mse_clean": flip ** 2 - 0.001, "psnr": 20 / flip ** 0.5,
                   "ssim": 1 - flip, "flip": flip, "hdr_flip": flip * 1.4},
        "flip_percentiles": {"q25": flip / 2, "median": flip, "q75": flip * 2},
        "picture": f"pictures/{name}.png" if seed == 1 else None,
        "error_map": f"pictures/{name}-flip.png" if seed == 1 else None,
        "command": f"gatelight render '{scene}.glb' --seed {seed} --train-steps {steps} -o out.exr",
    }
    made.update(changes)
    return made


def hash_of(text):
    return zlib.crc32(text.encode()) * 0x9E3779B97F4A7C15 % (1 << 64)


def reference_id(scene, kind, of=""):
    return f"{hash_of(scene + kind + of):016x}"


def reference(scene, kind, of=""):
    name = reference_id(scene, kind, of)
    return {"id": name, "kind": kind, "spp": 512, "file": f"references/{name}.png", "rel_mse_noise": 0.001, "seconds": 12.3}


def scene(name, kinds=("path",)):
    return {"name": name, "file": f"/scenes/{name}.glb", "references": [reference(name, kind) for kind in kinds]}


def results(scenes, cells):
    return {"schema": 2, "versions": {"gatelight": "1.0.0", "embree": "3.13.5", "of_cells": ["1.0.0"]},
            "command": ["gatelight", "sweep", "a scene.glb", "-o", "it's"],
            "machine": {"cpu": CPU, "threads": 2, "isa": "avx512"}, "scenes": scenes, "cells": cells}


STEPS = (8, 16, 32, 64, 128, 256, 512, 1024)


def full():
    """Two scenes, three seeds, two encodings, path tracing; in the first also what the cache stores, and failures."""
    cells = []
    for name in ("kitchen", "sponza"):
        for seed in (1, 2, 3):
            cells += [cell(name, "path", seed, spp=spp) for spp in (1, 4, 16, 100)]
            for series in ("nrc gate", "nrc hashgrid"):
                cells += [cell(name, series, seed, steps) for steps in STEPS]
    for seed in (1, 2, 3):
        cells += [cell("kitchen", "held gate", seed, steps, kind="cache") for steps in STEPS]
    cells.append(cell("kitchen", "nrc gate stack=3", 1, 64, status="failed", error="out of memory: 9.1 GiB needed, <4 GiB> allowed",
                      errors=None, seconds=None, picture=None, error_map=None))
    return results([scene("kitchen", ("path", "cache")), scene("sponza")], cells)


def two_depths():
    """A reference for each depth. The shallow cells are quicker, and nearer to theirs than the deep ones to theirs."""
    cells = []
    for depth in (2, 8):
        changes = {"axes": {"max-depth": str(depth), "encoding": "gate"}, "reference_id": reference_id("room", "path", str(depth))}
        for made in [cell("room", f"path max-depth {depth}", 1, spp=spp, **changes) for spp in (1, 4, 16)] + [
                cell("room", f"nrc gate max-depth {depth}", seed, steps, **changes) for seed in (1, 2, 3) for steps in STEPS]:
            made["options"] = dict(made["options"], **{"max-depth": depth})
            if depth == 2:
                made["seconds"] = {key: value and value / 2 for key, value in made["seconds"].items()}
                made["errors"] = dict(made["errors"], flip=made["errors"]["flip"] / 4)
            cells.append(made)
    room = scene("room")
    room["references"] = [reference("room", "path", depth) for depth in ("2", "8")]
    return results([room], cells)


def older():
    """full() as it was before references had ids, and cells their version and processor."""
    data = full()
    for record in data["cells"] + [r for s in data["scenes"] for r in s["references"]]:
        for key in ("reference_id", "version", "cpu", "isa"):
            record.pop(key, None)
    for record in (r for s in data["scenes"] for r in s["references"]):
        del record["id"]
    del data["versions"]
    return dict(data, schema=1, version="1.0.0")


def two_exposures():
    """One reference, beside pictures of two exposures."""
    cells = []
    for exposure in (0.0, 2.0):
        for made in [cell("room", f"nrc gate exposure {exposure:g}", 1, steps) for steps in STEPS]:
            cells.append(dict(made, options=dict(made["options"], exposure=exposure)))
    return results([scene("room")], cells)


def ways():
    """Path tracing and a cache, each as traced and denoised. The denoised take 0.1 s more and have half the FLIP."""
    def denoised(made):
        flip = made["errors"]["flip"] / 2
        return dict(made, options=dict(made["options"], denoiser="oidn"), estimated_error=0.9 * flip,
                    seconds=dict(made["seconds"], denoise=0.1, total=made["seconds"]["total"] + 0.1),
                    errors=dict(made["errors"], flip=flip, rel_mse_clean=flip ** 2))

    return results([scene("room")], [
        *[cell("room", "path", 1, spp=spp) for spp in (1, 4, 16, 64)],
        *[denoised(cell("room", "path denoised", 1, spp=spp)) for spp in (1, 4, 16, 64)],
        *[cell("room", "nrc bare", 1, steps, axes={"row": "bare"}) for steps in STEPS],
        *[denoised(cell("room", "nrc standard", 1, steps, axes={"row": "standard"})) for steps in (64, 256, 1024)]])


def edges():
    """Sweeps that lack data or have more than usual, by name."""
    nothing = {key: None for key in ("mse", "rel_mse", "rel_mse_clean", "psnr", "ssim", "flip", "hdr_flip")}
    gate = [cell("room", "nrc gate", 1, steps) for steps in STEPS]
    hostile = "</script><script>window.broken = 1</script><!--\u2028\"'"
    return {
        "one series, no path tracing": results([scene("room")], gate),
        "path tracing alone": results([scene("room")], [cell("room", "path", 1, spp=n) for n in (1, 2, 4)]),
        "one picture": results([scene("room")], gate[:1]),
        "one step, three seeds": results([scene("room")], [cell("room", "nrc gate", seed, 64) for seed in (1, 2, 3)]),
        "null errors": results([scene("room")], [cell("room", "nrc gate", 1, 8, errors=nothing), *gate[1:]]),
        "all errors null": results([scene("room")], [dict(c, errors=nothing, seconds=None, memory_bytes=None, train_ms_per_step=None,
                                                          train_step_ms=None, query_ms_per_2m=None, loss=None) for c in gate]),
        "errors of zero": results([scene("room")], [cell("room", "path", 1, errors=dict(nothing, flip=0, rel_mse_clean=-1e-4)),
                                                    *gate[1:]]),
        "all failed": results([scene("room")], [dict(c, status="failed", error="no", errors=None, seconds=None, picture=None)
                                                for c in gate]),
        "nothing at all": results([], []),
        "no pictures": results([dict(scene("room"), references=[])], [dict(c, picture=None, error_map=None) for c in gate]),
        "hostile names": results([scene(hostile)], [cell(hostile, hostile, 1, steps) for steps in STEPS]),
        "two depths": two_depths(),
        "four ways": ways(),
        "older results": older(),
        "two exposures": two_exposures(),
        "wide pictures": results([scene("room")], gate[:2]),
        "two makers": results([scene("room")], [dict(c, version="0.9.0" if i < 3 else "1.0.0") for i, c in enumerate(gate)]),
        "twenty series": results([scene("room")], [cell("room", f"nrc gate features={n} with a long name of its own", 1, steps)
                                                   for n in range(20) for steps in STEPS]),
    }


SIZES = {"wide pictures": (1920, 1080)}


def write(folder, data, size=(320, 180)):
    """results.json and a picture of its own colour for each that is named."""
    os.makedirs(folder, exist_ok=True)
    files = [c[key] for c in data["cells"] for key in ("picture", "error_map") if c.get(key)]
    files += [r["file"] for s in data["scenes"] for r in s["references"]]
    for file in files:
        number = hash_of(file)
        write_png(os.path.join(folder, file), (number >> 8 & 255, number >> 16 & 255, number >> 24 & 255), *size)
    with open(os.path.join(folder, "results.json"), "w", encoding="utf-8") as file:
        json.dump(data, file)
