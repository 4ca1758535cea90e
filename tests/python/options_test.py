"""Options by name, errors, pictures of the same bits as the program's, stubs."""

import ast
import inspect
import pathlib
import subprocess
import sys
import tempfile
import types
import unittest

import numpy
from support import DATA, PROGRAM, SMALL, SOURCE, gatelight, lit_square, main, square

sys.path.insert(0, str(SOURCE / "scripts/scenes"))


class Options(unittest.TestCase):
    def test_forms(self):
        scene = lit_square()
        forms = (dict(size=(24, 16), environment=(1, 0.5, 0), mis="power"), dict(size="24x16", environment="1,0.5,0", mis="power"))
        pictures = [numpy.asarray(gatelight.render(scene, preset=None, spp="2", **form)) for form in forms]
        self.assertTrue((pictures[0] == pictures[1]).all())

    def test_errors_have_fields(self):
        for options, option, value, expected in (
            (dict(spp=-1), "spp", "-1", "an integer from 1 to 16777216"),
            (dict(mis="powr"), "mis", "powr", "one of"),
            (dict(sppp=3), "sppp", None, "one of gatelight.options()"),
            (dict(eye=(0, 0, 0)), "target", None, None),
            (dict(time=1), "time", None, "it in gatelight.load"),
            (dict(checkpoint=""), "checkpoint", "", "a value or None"),
        ):
            with self.assertRaises(gatelight.Error) as caught:
                gatelight.render(lit_square(), **{**SMALL, **options})
            error = caught.exception
            self.assertEqual((error.option, error.value), (option, value), str(error))
            self.assertTrue(str(error).startswith(f"{option}: "), str(error))
            self.assertTrue(expected is None or error.expected.startswith(expected), str(error))
        with self.assertRaises(gatelight.Error) as caught:
            gatelight.load("/nothing.glb")
        self.assertEqual((caught.exception.option, caught.exception.code), (None, 2))

    def test_bits_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            ours, theirs = pathlib.Path(folder, "a.exr"), pathlib.Path(folder, "b.exr")
            gatelight.render(DATA / "cornell-box.glb", size=(48, 32), preset=None, integrator="nrc", spp=4, train_steps=16,
                             denoiser="none", aov="albedo", reproducible=True, output=ours)
            subprocess.run([PROGRAM, "render", DATA / "cornell-box.glb", "-o", theirs, "--size", "48x32", "--spp", "4",
                            "--integrator", "nrc", "--train-steps", "16", "--denoiser", "none", "--aov", "albedo",
                            "--reproducible", "--quiet"], check=True)
            self.assertEqual(ours.read_bytes(), theirs.read_bytes())
            self.assertEqual(gatelight.read(ours).metadata["spp"], "4")

    def test_other_options_give_the_bits_of_a_new_renderer(self):
        scene = lit_square()
        renderer = gatelight.Renderer(scene, **SMALL)
        renderer.render()
        options = dict(SMALL)
        for change in (dict(spp=2), dict(size=(16, 16), environment=(1, 1, 1)), dict(eye=(0, 3, 1), target=(0, 0, 0)), dict(eye=None, target=None),
                       dict(integrator="nrc", train_steps=8), dict(environment=None)):
            renderer.set_options(**change)
            options.update(change)
            fresh = gatelight.Renderer(scene, **options).render()
            self.assertTrue((numpy.asarray(renderer.render()) == numpy.asarray(fresh)).all(), str(change))
        with self.assertRaises(gatelight.Error):
            renderer.set_options(spp=-1)
        renderer.render()

    def test_options_of_the_program_are_refused(self):
        for options in (dict(frame_groups=2), dict(skip_existing=True)):
            with self.assertRaises(gatelight.Error) as caught:
                gatelight.render(lit_square(), **SMALL, **options)
            self.assertEqual(caught.exception.option, next(iter(options)))
        with self.assertRaises(gatelight.Error):
            gatelight.frames(DATA / "turntable.glb", frames="0:1", checkpoint="a.safetensors")

    def test_words_of_other_tools(self):
        for options, hint in ((dict(samples=4), "here it is 'spp'"), (dict(width=64), "here it is 'size'"), (dict(camera="no"), "see help(gatelight.render)")):
            with self.assertRaises(gatelight.Error) as caught:
                gatelight.render(lit_square(), **{**SMALL, **options})
            self.assertIn(hint, str(caught.exception))

    def test_warnings_are_those_of_python(self):
        scene = gatelight.Scene()
        square(scene)
        with self.assertWarnsRegex(UserWarning, "no instance"):
            picture = gatelight.render(scene, **SMALL)
        self.assertTrue(any("no instance" in text for text in picture.statistics["warnings"]))
        self.assertEqual(repr(scene), "<gatelight.Scene, 1 meshes, 0 instances, 0 lights>")

    def test_frames(self):
        pictures = list(gatelight.frames(DATA / "turntable.glb", size=(32, 18), preset=None, spp=1, frames=range(2)))
        self.assertEqual(len(pictures), 2)

    def test_a_frame_is_the_same_in_any_range(self):
        def last(frames):
            picture = list(gatelight.frames(DATA / "moving-room.glb", size=(32, 18), preset=None, spp=1, exposure="auto",
                                            aov="motion,motion-next", frames=frames))[-1]
            return picture.statistics["exposure"], *(numpy.asarray(picture[name]) for name in picture.layers)

        whole = last(range(3, 7))
        self.assertGreater(numpy.abs(whole[2]).max(), 0.1)
        for frames in (6, [1, 6], "2,5-6"):
            for of_part, of_whole in zip(last(frames), whole, strict=True):
                self.assertTrue(numpy.array_equal(of_part, of_whole), str(frames))

    def test_scene_of_arrays_equals_the_glb(self):
        from glb import Glb
        square = types.SimpleNamespace(
            positions=[(-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1)], normals=[], uvs=[], triangles=[(0, 2, 1), (0, 3, 2)])
        glb = Glb("square")
        glb.place("square", square, glb.material("red", (0.8, 0.2, 0.1), 0.0, 0.5), at=(0.1, 0.2, 0.3), turn=30)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "square.glb")
            glb.write(path)
            loaded = gatelight.load(path)
        made = gatelight.Scene()
        source = loaded.meshes[0]
        material = made.add_material(base_color=(0.8, 0.2, 0.1), metallic=0, roughness=0.5)
        mesh = made.add_mesh(source.positions, source.triangles, material=material)
        made.add_instance(mesh, loaded.instances[0].transform)
        view = dict(eye=(0, 2, 3), target=(0, 0, 0), environment=(1, 1, 1))
        a, b = (numpy.asarray(gatelight.render(scene, **SMALL, **view)) for scene in (loaded, made))
        self.assertTrue((a == b).all() and a.sum() > 0)


class Stubs(unittest.TestCase):
    def test_stubs_agree_with_the_module(self):
        tree = ast.parse(pathlib.Path(gatelight.__file__).with_name("__init__.pyi").read_text())
        functions = {n.name: n for n in tree.body if isinstance(n, ast.FunctionDef)}
        classes = {n.name: n for n in tree.body if isinstance(n, ast.ClassDef)}
        options = {n.target.id for n in classes.pop("Options").body if isinstance(n, ast.AnnAssign)}
        self.assertEqual(options, set(gatelight.options()) - {"size", "preset", "spp", "progress"})
        self.assertEqual(set(functions) | set(classes), set(gatelight.__all__))
        for name in ("render", "frames", "load", "denoise", "compare", "sample_points"):
            a = functions[name].args
            stub = [x.arg for x in a.args + a.kwonlyargs] + ([a.kwarg.arg] if a.kwarg else [])
            self.assertEqual(stub, list(inspect.signature(getattr(gatelight, name)).parameters), name)
        for name, node in classes.items():
            stub = {n.name for n in node.body if isinstance(n, ast.FunctionDef)}
            stub |= {n.target.id for n in node.body if isinstance(n, ast.AnnAssign)}
            real = {m for m in vars(getattr(gatelight, name)) if not m.startswith("_")}
            public = {m for m in stub if not m.startswith("_")}
            if name == "Points":
                continue
            self.assertEqual(public, real, name)

    def test_help_is_a_page(self):
        self.assertLess(len(gatelight.render.__doc__.splitlines()), 70)
        self.assertTrue(all(len(line) < 125 for line in gatelight.render.__doc__.splitlines()))


if __name__ == "__main__":
    main()
