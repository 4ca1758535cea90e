"""Error against time on your own scene: presets, and paths of several numbers of samples."""

import time

from common import arguments, gatelight, pyplot, stage

chosen = arguments(__doc__, scene="scene file, .glb or .gltf; default: a sphere on a floor")
scene = gatelight.load(chosen.scene) if chosen.scene else stage()
size = (96, 54) if chosen.small else (480, 270)
reference = gatelight.render(scene, size=size, preset=None, spp=256 if chosen.small else 4096, seed=7)


def measure(**options):
    start = time.perf_counter()
    picture = gatelight.render(scene, size=size, **options)
    return time.perf_counter() - start, gatelight.compare(reference, picture, ("rel_mse",))["rel_mse"]


counts = (2, 8, 32) if chosen.small else (4, 16, 64, 256)
paths = [measure(preset=None, spp=spp) for spp in counts]
presets = {name: measure(preset=name) for name in (("preview",) if chosen.small else ("preview", "standard", "final"))}
pyplot.loglog(*zip(*paths), "o-", label="paths")
for name, (seconds, error) in presets.items():
    pyplot.loglog(seconds, error, "s", label=name)
pyplot.xlabel("seconds")
pyplot.ylabel("relative MSE")
pyplot.legend()
pyplot.savefig(chosen.folder / "trade.png")
print(f"paths: {counts[0]} samples {paths[0][1]:.3g}, {counts[-1]} samples {paths[-1][1]:.3g}; {chosen.folder / 'trade.png'}")
