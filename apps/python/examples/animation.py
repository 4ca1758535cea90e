"""An animation: the frames of a file, or of a ball that is moved by hand, on one sheet."""

import numpy

from common import arguments, gatelight, pyplot, stage

chosen = arguments(__doc__, scene="scene file with animations; default: a ball that jumps")
size = (64, 36) if chosen.small else (320, 180)
count = 4 if chosen.small else 12


def frames_of_file(path):
    yield from gatelight.frames(path, size=size, preset="preview", frames=range(count), fps=8)


def frames_by_hand():
    scene = stage()
    ball = scene.instances[1]
    renderer = gatelight.Renderer(scene, size=size, preset=None, spp=8 if chosen.small else 64)
    for frame in range(count):
        matrix = numpy.eye(4)
        matrix[1, 3] = 0.5 + 0.5 * abs(numpy.sin(numpy.pi * frame / count))
        ball.transform = matrix
        yield renderer.render()


sheet = [picture.display(exposure=0.5) for picture in (frames_of_file(chosen.scene) if chosen.scene else frames_by_hand())]
rows = [numpy.concatenate(sheet[i:i + 4], axis=1) for i in range(0, count, 4)]
pyplot.imsave(chosen.folder / "animation.png", numpy.concatenate(rows, axis=0))
print(f"{len(sheet)} frames: {chosen.folder / 'animation.png'}")
