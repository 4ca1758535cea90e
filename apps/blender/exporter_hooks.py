"""Tags for Blender's own glTF exporter: which object and which material of Blender an element of the file comes from."""

OBJECT, MATERIAL = "gatelight_object", "gatelight_material"

_state = {"tagging": False}


class Tagging:
    """While this is entered, exported files carry the tags."""

    def __enter__(self):
        _state["tagging"] = True

    def __exit__(self, *_):
        _state["tagging"] = False


def _tag(element, name, value):
    if _state["tagging"] and value is not None:
        element.extras = {**(element.extras or {}), name: value.name_full}


class glTF2ExportUserExtension:  # the exporter looks for this name
    def gather_node_hook(self, node, blender_object, export_settings):
        _tag(node, OBJECT, blender_object)

    def gather_material_hook(self, material, blender_material, export_settings):
        _tag(material, MATERIAL, blender_material)
