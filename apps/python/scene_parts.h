#pragma once
// Parts of a scene as objects of Python.

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include <string>
#include <utility>
#include <vector>

#include "apps/python/scene_data.h"
#include "base/errors.h"

namespace gatelight::python {

/// An object in a list of the scene, by its number.
template <class Object, std::vector<Object> scene::Scene::*kList>
struct Part {
  ScenePointer scene;
  std::size_t index = 0;

  Object& operator*() const { return (scene->source.*kList)[index]; }
  Object* operator->() const { return &**this; }

  static Part add(const ScenePointer& to, Object object) {
    std::vector<Object>& list = to->source.*kList;
    list.push_back(std::move(object));
    to->change();
    return {to, list.size() - 1};
  }
  static pybind11::list all(const ScenePointer& of) {
    pybind11::list parts;
    for (std::size_t i = 0; i < (of->source.*kList).size(); ++i) parts.append(Part{of, i});
    return parts;
  }
};

using MaterialPart = Part<scene::Material, &scene::Scene::materials>;
using TexturePart = Part<scene::Texture, &scene::Scene::textures>;
using MeshPart = Part<scene::Mesh, &scene::Scene::meshes>;
using InstancePart = Part<scene::Instance, &scene::Scene::instances>;
using LightPart = Part<scene::PunctualLight, &scene::Scene::lights>;
using CameraPart = Part<scene::Camera, &scene::Scene::cameras>;

/// The index of a part of this scene. Throws BadOption for all else. `what`: "material".
template <class PartOf>
int index_of(const ScenePointer& scene, const char* name, pybind11::handle value, const char* what,
             const char* expected) {
  if (!pybind11::isinstance<PartOf>(value) || value.cast<PartOf>().scene != scene)
    throw BadOption({name, "", fmt::format("is not a {} of this scene", what), expected});
  return static_cast<int>(value.cast<PartOf>().index);
}

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
