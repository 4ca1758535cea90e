#pragma once
// Parts of a scene as objects of Python.

#include <pybind11/pybind11.h>

#include "apps/python/scene_data.h"

namespace gatelight::python {

struct MaterialPart : Part {};
struct TexturePart : Part {};
struct MeshPart : Part {};
struct InstancePart : Part {};
struct LightPart : Part {};
struct CameraPart : Part {};

/// Adds a material with these members. Throws BadOption.
MaterialPart make_material(const ScenePointer& scene, const pybind11::kwargs& keywords);

/// Adds the classes Mesh and Instance.
void add_geometry(pybind11::module_& module);
/// Adds the classes Light and Camera.
void add_views(pybind11::module_& module);

MeshPart make_mesh(const ScenePointer& scene, pybind11::handle positions, pybind11::handle triangles,
                   pybind11::handle normals, pybind11::handle uvs, pybind11::handle material,
                   const std::string& name, pybind11::handle colors);
InstancePart make_instance(const ScenePointer& scene, pybind11::handle mesh, pybind11::handle transform,
                           const std::string& name);
TexturePart make_texture(const ScenePointer& scene, pybind11::handle image, const std::string& wrap,
                         bool nearest, const std::string& name);
LightPart make_light(const ScenePointer& scene, const std::string& type, const pybind11::kwargs& keywords);
CameraPart make_camera(const ScenePointer& scene, const pybind11::kwargs& keywords);

}  // namespace gatelight::python
