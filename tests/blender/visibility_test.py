"""Ray visibility and light linking of Blender become extensions of glTF."""

import types
import unittest

from support import main, module

visibility = module("visibility")


def thing(name="thing", parent=None, layer="", **values):
    """An object whose collection has a mark in the view layer."""
    marks = {f"{mark}_get": lambda view_layer, mark=mark: layer == mark for mark in ("holdout", "indirect_only")}
    given = dict(name_full=name, parent=parent, type="MESH", instance_type="NONE", is_holdout=False, is_shadow_catcher=False)
    return types.SimpleNamespace(**{**given, **marks, **values})


def collection(states, inside=()):
    """A collection with a state of each object, and pairs of a collection inside and its state."""
    def links(found):
        return [types.SimpleNamespace(light_linking=types.SimpleNamespace(link_state=state)) for state in found]
    objects = [thing(name) for name in states]
    return types.SimpleNamespace(objects=objects, all_objects=objects, collection_objects=links(states.values()),
                                 children=[child for child, _ in inside], collection_children=links(state for _, state in inside))


def lamp(receivers=None, blockers=None, shadow=True):
    return thing("lamp", type="LIGHT", data=types.SimpleNamespace(use_shadow=shadow),
                 light_linking=types.SimpleNamespace(receiver_collection=receivers, blocker_collection=blockers))


PLACES = {"a": {1}, "b": {2, 3}, "c": {4}}


class Visibility(unittest.TestCase):
    def seen(self, made, holder=None):
        return visibility.of_object(made, holder or made, "layer")

    def test_only_what_differs_is_written(self):
        self.assertEqual(self.seen(thing()), {})
        self.assertEqual(self.seen(thing(visible_volume_scatter=False, visible_shadow=False, is_shadow_catcher=True)),
                         {"volume": False, "shadow": False, "shadowCatcher": True})

    def test_lamps_have_no_shadow(self):
        self.assertEqual(visibility.of_lamp(thing(visible_camera=False, visible_shadow=False)), {"camera": False})

    def test_worlds(self):
        self.assertEqual(visibility.of_world(None), {})
        rays = types.SimpleNamespace(camera=True, diffuse=False, scatter=False, shadow=False)
        self.assertEqual(visibility.of_world(types.SimpleNamespace(cycles_visibility=rays)), {"diffuse": False, "volume": False})

    def test_collections_are_marked_in_a_layer(self):
        self.assertEqual(self.seen(thing(layer="indirect_only")), {"camera": False})
        self.assertEqual(self.seen(thing(layer="holdout")), {"holdout": True})
        self.assertEqual(self.seen(thing(), thing(layer="holdout", visible_glossy=False)), {"glossy": False, "holdout": True})


class Holders(unittest.TestCase):
    def test_parents_hold_nothing(self):
        parent = thing()
        self.assertIs(visibility.holder_of(child := thing(parent=parent), [parent]), child)

    def test_the_outermost_place_counts(self):
        outer = thing()
        inner = thing(parent=outer)
        place = thing(parent=thing())
        parent = thing()
        self.assertIs(visibility.holder_of(thing(parent=parent), [parent, inner, outer, place, place.parent]), place)

    def test_vertices_hold_children(self):
        parent = thing(instance_type="VERTS")
        self.assertIs(visibility.holder_of(thing(parent=parent), [parent]), parent)


class Links(unittest.TestCase):
    def test_a_lamp_lights_all(self):
        self.assertEqual(visibility.links_of(lamp(collection({})), PLACES), {})

    def test_included_objects_leave_out_all_others(self):
        links = visibility.links_of(lamp(collection({"a": "EXCLUDE", "b": "INCLUDE", "not here": "INCLUDE"})), PLACES)
        self.assertEqual(links, {"receivers": {"nodes": [2, 3]}})

    def test_excluded_objects_alone_leave_the_others_in(self):
        links = visibility.links_of(lamp(blockers=collection({"a": "EXCLUDE", "c": "EXCLUDE"})), PLACES)
        self.assertEqual(links, {"blockers": {"nodes": [1, 4], "exclude": True}})

    def test_a_state_of_a_collection_is_that_of_its_objects_unless_they_have_their_own(self):
        inside = collection({"a": "EXCLUDE", "b": "EXCLUDE"})
        links = visibility.links_of(lamp(collection({"b": "EXCLUDE"}, [(inside, "INCLUDE")])), PLACES)
        self.assertEqual(links, {"receivers": {"nodes": [1]}})

    def test_nothing_blocks_light_without_shadows(self):
        self.assertEqual(visibility.links_of(lamp(shadow=False), PLACES), {"blockers": {"nodes": []}})


if __name__ == "__main__":
    main()
