"""A light rig that is solved: intensities of three lights for a wanted picture, over light groups."""

import numpy
from scipy import optimize

from common import arguments, gatelight, pyplot, stage

chosen = arguments(__doc__)
size = (64, 36) if chosen.small else (320, 180)
scene = stage()
names = [light.name for light in scene.lights]
picture = gatelight.render(
    scene, size=size, preset=None, integrator="path", spp=16 if chosen.small else 128, environment="none",
    light_groups={name: [name] for name in names},
)
# Light is linear: the picture is the sum of its groups, each times the factor of its light.
groups = numpy.stack([picture[f"light-{name}"].ravel() for name in names], axis=1)
wanted = groups @ numpy.array([0.3, 2.0, 1.1])
factors, residual = optimize.nnls(groups.astype(float), wanted.astype(float))
print("factors:", ", ".join(f"{name} {factor:.3f}" for name, factor in zip(names, factors)), f"residual {residual:.2g}")
for light, factor in zip(scene.lights, factors):
    light.intensity = tuple(factor * c for c in light.intensity)
solved = gatelight.render(scene, size=size, preset=None, spp=16 if chosen.small else 128, environment="none")
figure, axes = pyplot.subplots(1, 2, figsize=(9, 3))
for axis, shown, title in zip(axes, (picture, solved), ("before", "solved")):
    axis.imshow(shown.display(exposure="auto"))
    axis.set_title(title)
figure.savefig(chosen.folder / "light_rig.png")
