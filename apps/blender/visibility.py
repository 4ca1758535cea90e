"""Which rays see what, and which objects a light concerns: the extensions GATELIGHT_visibility and GATELIGHT_light_linking of glTF, with
what differs from their defaults."""

VISIBILITY, LINKS = "GATELIGHT_visibility", "GATELIGHT_light_linking"
# Properties of worlds and objects, by the names of rays in the file.
WORLD = {"camera": "camera", "diffuse": "diffuse", "glossy": "glossy", "transmission": "transmission", "volume": "scatter"}
LAMP = {ray: "visible_" + name.replace("scatter", "volume_scatter") for ray, name in WORLD.items()}
OBJECT = {**LAMP, "shadow": "visible_shadow"}


def _unseen(owner, names):
    """The rays that the owner's properties leave out."""
    return {ray: False for ray, name in names.items() if not getattr(owner, name, True)}


def of_lamp(thing):
    return _unseen(thing, LAMP)


def of_world(world):
    return _unseen(getattr(world, "cycles_visibility", None), WORLD)


def of_object(thing, holder, view_layer):
    """`holder`: what places the object in the view layer (holder_of)."""
    found = {**_unseen(thing, OBJECT), **_unseen(holder, OBJECT)}
    if holder.is_holdout or holder.holdout_get(view_layer=view_layer):
        found["holdout"] = True
    elif holder.indirect_only_get(view_layer=view_layer):
        found["camera"] = False
    if thing.is_shadow_catcher or holder.is_shadow_catcher:
        found["shadowCatcher"] = True
    return found


def holder_of(thing, above):
    """The outermost object that places the object, in its collection or on its vertices or faces, or the object itself. `above`: the
    objects of the nodes above its node, the nearest first, which are its parents and what places it."""
    for other in above:
        if other not in _parents(thing) or other.instance_type in ("VERTS", "FACES"):
            thing = other
    return thing


def _parents(thing):
    while thing := thing.parent:
        yield thing


def links_of(thing, places):
    """Of a light. `places`: sets of indices of nodes, by names of objects."""
    links = {}
    for name, collection in (("receivers", thing.light_linking.receiver_collection), ("blockers", thing.light_linking.blocker_collection)):
        states = _states(collection) if collection else {}
        included = [other for other, state in states.items() if state == "INCLUDE"]
        nodes = sorted(set().union(*(places.get(other, ()) for other in included or states)))
        if included or nodes:
            links[name] = {"nodes": nodes} if included else {"nodes": nodes, "exclude": True}
    if thing.type == "LIGHT" and not thing.data.use_shadow:
        links["blockers"] = {"nodes": []}
    return links


def _states(collection):
    """INCLUDE or EXCLUDE, by names of objects. That of a collection inside counts for all that it holds."""
    states = {}
    for child, link in zip(collection.children, collection.collection_children):
        states.update((thing.name_full, link.light_linking.link_state) for thing in child.all_objects)
    for thing, link in zip(collection.objects, collection.collection_objects):
        states[thing.name_full] = link.light_linking.link_state
    return states
