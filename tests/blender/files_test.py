"""Pictures survive writing and reading, and documents that are patched are loaded by the program."""

import json
import pathlib
import subprocess
import tempfile
import unittest

import numpy
from support import DATA, PROGRAM, main, module

exr, gltf_document, shapes, units, visibility = (module(name) for name in ("exr", "gltf_document", "shapes", "units", "visibility"))


def program(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=True).stdout


class Pictures(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def file(self, name):
        return pathlib.Path(self.folder.name, name)

    def test_written_values_are_read(self):
        pixels = numpy.random.default_rng(1).random((5, 7, 3), numpy.float32)
        exr.write(self.file("a.exr"), pixels)
        self.assertTrue((exr.read(self.file("a.exr")).layers[""] == pixels).all())

    def test_pictures_of_the_program_agree_in_both_precisions(self):
        for kind in ("half", "float"):
            program("render", DATA / "cornell-box.glb", "-o", self.file(f"{kind}.exr"), "--exr", kind, "--size", "40x24", "--spp", "1",
                    "--aov", "normal,depth", "--region", "8,4,38,20", "--quiet")
        half, whole = (exr.read(self.file(f"{kind}.exr")) for kind in ("half", "float"))
        self.assertEqual((whole.corner, whole.layers[""].shape), ((8, 4), (16, 30, 3)))
        self.assertEqual(set(whole.layers), {"", "normal", "depth"})
        for name in whole.layers:
            self.assertTrue(numpy.allclose(half.layers[name], whole.layers[name], rtol=1e-3, atol=1e-4), name)
        self.assertGreater(whole.layers[""].mean(), 0.0)

    def test_other_files_are_refused_in_one_line(self):
        for content in (b"", b"not a picture", b"\x76\x2f\x31\x01\x02\0\0\0channels\0"):
            self.file("bad.exr").write_bytes(content)
            with self.assertRaises(exr.BadPicture) as caught:
                exr.read(self.file("bad.exr"))
            self.assertEqual(len(str(caught.exception).splitlines()), 1)


class Documents(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name, "scene.gltf")
        self.path.write_text(json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [
            {"name": "lamp", "extras": {"tag": "Lamp"}, "extensions": {"KHR_lights_punctual": {"light": 0}}}],
            "extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 9}]}}}))
        self.document = gltf_document.Document(self.path)

    def test_lights_replace_those_of_the_exporter(self):
        (node, name), = self.document.tagged("nodes", "tag")
        self.assertEqual(name, "Lamp")
        self.document.drop_lights()
        self.document.add_child(node, {"name": "new", **self.document.add_light({"name": "new", "type": "point", "intensity": 2.0})})
        material = self.document.add_clear_emitter("glow", [3.0, 1.5, 0.0])
        self.document.add_child(node, {"mesh": self.document.add_mesh("glow", shapes.rectangle(), material)})
        self.document.save()
        found = json.loads(program("info", self.path, "--json", "-"))
        self.assertEqual([(light["name"], light["intensity"][0]) for light in found["lights"]], [("new", 2.0)])
        self.assertEqual(found["requirements"]["emissive_triangles"], 2)

    def test_the_program_reads_what_rays_see_and_lights_concern(self):
        node = self.document.json["nodes"][0]
        material = self.document.add_clear_emitter("glow", [1.0, 1.0, 1.0])
        wall = {"name": "wall", "mesh": self.document.add_mesh("glow", shapes.rectangle(), material)}
        self.document.extend(wall, visibility.VISIBILITY, {"camera": False, "holdout": True})
        self.document.extend(node, visibility.LINKS, {"receivers": {"nodes": [1]}, "blockers": {"nodes": []}})
        self.document.extend(self.document.scene, visibility.VISIBILITY, {"volume": False})
        self.document.extend(self.document.scene, "NOT_used", {})
        self.document.add_child(node, wall)
        self.document.save()
        self.assertNotIn("NOT_used", self.document.json["extensionsUsed"])
        found = json.loads(program("info", self.path, "--json", "-"))
        seen = {thing.get("name"): thing for thing in found["visibility"]}
        self.assertNotIn("camera", seen["wall"]["rays"])
        self.assertTrue(seen["wall"]["holdout"])
        self.assertNotIn("volume", seen[None]["rays"])
        (link,) = found["light_links"]
        self.assertEqual((link["name"], link["receivers"], link["blockers"]), ("lamp", {"only": ["wall"]}, {"only": []}))

    def test_a_square_shines_on_a_wall_by_its_watts(self):
        node = self.document.json["nodes"][0]
        self.document.drop_lights()
        size = 0.02
        material = self.document.add_clear_emitter("glow", [units.surface_radiance(10.0, size * size)] * 3)
        self.document.add_child(node, {"mesh": self.document.add_mesh("glow", shapes.rectangle(), material), "scale": [size, size, 1.0]})
        wall = self.document.add("materials", {"doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0.0}})
        self.document.extend(self.document.json["materials"][wall], "KHR_materials_specular", {"specularFactor": 0.0})
        self.document.add_child(node, {"mesh": self.document.add_mesh("wall", shapes.rectangle(), wall), "translation": [0.0, 0.0, -2.0]})
        self.document.save()
        picture = pathlib.Path(self.folder.name, "a.exr")
        program("render", self.path, "-o", picture, "--size", "4x4", "--spp", "64", "--environment", "none", "--quiet",
                "--eye", "0,0,-1", "--target", "0,0,-2", "--fov", "0.1")
        expected = 10.0 / numpy.pi / 4.0 / numpy.pi  # irradiance at 2 m of a Lambert emitter, and a white wall
        self.assertAlmostEqual(float(exr.read(picture).layers[""].mean()), expected, delta=0.005 * expected)


if __name__ == "__main__":
    main()
