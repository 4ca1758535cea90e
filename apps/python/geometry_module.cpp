#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstring>

#include "apps/python/arrays.h"
#include "apps/python/conversions.h"
#include "apps/python/fields.h"
#include "apps/python/module.h"
#include "base/errors.h"
#include "scene/mesh_arrays.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;

constexpr renderer::Choice<scene::Wrap> kWraps[] = {{"repeat", scene::Wrap::repeat},
                                                    {"mirror", scene::Wrap::mirrored_repeat},
                                                    {"clamp", scene::Wrap::clamp_to_edge}};
constexpr int kLargestTexture = 65536;

scene::Mesh& get(const MeshPart& part) {
  return part.scene->source.meshes[part.index];
}
scene::Instance& get(const InstancePart& part) {
  return part.scene->source.instances[part.index];
}

[[noreturn]] void fail(const char* name, const std::string& problem, const std::string& expected) {
  throw BadOption({name, "", problem, expected});
}

/// Copies an array over rows in place: views of them stay valid.
template <class Rows>
void fill(const char* name, py::handle values, Rows& rows_to) {
  constexpr auto columns = static_cast<py::ssize_t>(sizeof(rows_to[0]) / sizeof(float));
  const Array<float> array = rows<float>(name, values, columns);
  if (static_cast<std::size_t>(array.shape(0)) != rows_to.size())
    throw BadOption(
        {name, shape_of(array), "is the array's shape", fmt::format("({}, {})", rows_to.size(), columns)});
  std::memcpy(static_cast<void*>(rows_to.data()), array.data(), rows_to.size() * sizeof(rows_to[0]));
}

template <class Rows>
void read_rows(const char* name, py::handle values, std::size_t count, Rows& rows_to) {
  if (values.is_none()) return;
  Rows read(count);
  fill(name, values, read);
  rows_to = std::move(read);
}

/// The texture coordinates and normals are repaired later, as those of a file are.
void expect_finite(const scene::Mesh& mesh) {
  const ErrorParts wrong = scene::wrong_position(mesh);
  if (!wrong.problem.empty()) fail("positions", wrong.problem, wrong.expected);
}

/// (n, 3) or (n, 4); three are opaque.
void read_colors(py::handle values, std::size_t count, std::vector<Vec4>& colors) {
  if (values.is_none()) return;
  const py::array given = py::array::ensure(values);
  PyErr_Clear();
  if (given && given.ndim() == 2 && given.shape(1) == 4) {
    read_rows("colors", values, count, colors);
  } else {
    std::vector<Vec3> opaque;
    read_rows("colors", values, count, opaque);
    colors.clear();
    for (const Vec3& c : opaque) colors.emplace_back(c.x(), c.y(), c.z(), 1.0f);
  }
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const Vec4& c = colors[i];
    if (c.allFinite() && c.minCoeff() >= 0.0f) continue;
    fail("colors", fmt::format("row {} is ({}, {}, {}, {})", i, c.x(), c.y(), c.z(), c.w()),
         "finite numbers, not negative");
  }
}

int material_index(const ScenePointer& scene, py::handle material) {
  if (material.is_none()) return -1;
  if (!py::isinstance<MaterialPart>(material) || material.cast<MaterialPart>().scene != scene)
    fail("material", "is not a material of this scene", "one of scene.materials or None");
  return static_cast<int>(material.cast<MaterialPart>().index);
}

void place(scene::Instance& instance, const Affine& transform) {
  instance.transform = transform;
  instance.swaps_handedness = transform.linear().cast<double>().determinant() < 0.0;
}

template <class Rows>
py::object view_of(const MeshPart& part, const Rows& values, py::ssize_t columns) {
  if (values.empty()) return py::none();
  return view(values.data()->data(), static_cast<py::ssize_t>(values.size()), columns, py::cast(part.scene));
}

template <class Rows>
void replace(const MeshPart& part, const char* name, Rows& values, const py::object& given) {
  const std::size_t count = get(part).positions.size();
  if (values.empty()) {
    read_rows(name, given, count, values);
  } else {
    fill(name, given, values);
  }
  part.scene->change();
}

void add_mesh_class(py::module_& module) {
  py::class_<MeshPart> mesh(module, "Mesh",
                            "Triangles of one material. Arrays that are read are views without a copy.");
  mesh.def("__repr__", [](const MeshPart& part) {
    return fmt::format("<gatelight.Mesh '{}', {} triangles>", get(part).name, get(part).triangles.size());
  });
  mesh.def_property_readonly("index", [](const MeshPart& part) { return part.index; });
  mesh.def_property(
      "name", [](const MeshPart& part) { return get(part).name; },
      [](const MeshPart& part, const std::string& name) { get(part).name = name; });
  mesh.def_property(
      "positions", [](const MeshPart& part) { return view_of(part, get(part).positions, 3); },
      [](const MeshPart& part, const py::object& given) {
        scene::Mesh next;
        next.positions.resize(get(part).positions.size());
        fill("positions", given, next.positions);
        expect_finite(next);
        std::copy(next.positions.begin(), next.positions.end(), get(part).positions.begin());
        part.scene->change();
      },
      "(n, 3) float32, metres; a new array has as many rows");
  mesh.def_property(
      "normals", [](const MeshPart& part) { return view_of(part, get(part).normals, 3); },
      [](const MeshPart& part, const py::object& given) {
        replace(part, "normals", get(part).normals, given);
      },
      "(n, 3) float32, or None: flat");
  mesh.def_property(
      "uvs", [](const MeshPart& part) { return view_of(part, get(part).uv0, 2); },
      [](const MeshPart& part, const py::object& given) { replace(part, "uvs", get(part).uv0, given); },
      "(n, 2) float32, or None");
  mesh.def_property(
      "colors", [](const MeshPart& part) { return view_of(part, get(part).colors, 4); },
      [](const MeshPart& part, const py::object& given) {
        std::vector<Vec4> colors;
        read_colors(given, get(part).positions.size(), colors);
        std::vector<Vec4>& own = get(part).colors;
        if (own.size() == colors.size()) {
          std::copy(colors.begin(), colors.end(), own.begin());  // views of them stay valid
        } else if (own.empty()) {
          own = std::move(colors);
        } else {
          fail("colors", "None would leave views without their memory", "an array");
        }
        part.scene->change();
      },
      "(n, 4) float32, linear, that multiply the base colour, or None; (n, 3) are opaque");
  mesh.def_property_readonly(
      "triangles", [](const MeshPart& part) { return view_of(part, get(part).triangles, 3); },
      "(m, 3) uint32");
  mesh.def_property(
      "material",
      [](const MeshPart& part) -> py::object {
        const int index = get(part).material;
        if (index < 0) return py::none();
        return py::cast(MaterialPart{{part.scene, static_cast<std::size_t>(index)}});
      },
      [](const MeshPart& part, const py::object& material) {
        get(part).material = material_index(part.scene, material);
        part.scene->change();
      });
}

const std::vector<Field<scene::Instance>>& instance_fields() {
  using I = scene::Instance;
  static const std::vector<Field<I>> fields = {
      {"transform", [](const I& i) { return matrix_of(i.transform); },
       [](I& i, py::handle matrix) { place(i, transform("transform", matrix)); },
       "(4, 4) float32, mesh to world, for column vectors; a copy"},
      {"dielectric_priority", &I::dielectric_priority, apps::kAnyFloat, ""},
  };
  return fields;
}

void add_instance_class(py::module_& module) {
  py::class_<InstancePart> instance(module, "Instance", "A mesh in the world.");
  instance.def("__repr__", [](const InstancePart& part) {
    return fmt::format("<gatelight.Instance '{}'>", get(part).name);
  });
  instance.def_property_readonly("name", [](const InstancePart& part) { return get(part).name; });
  instance.def_property_readonly("mesh", [](const InstancePart& part) {
    return MeshPart{{part.scene, static_cast<std::size_t>(get(part).mesh)}};
  });
  add_fields(instance, instance_fields(), &scene::Scene::instances);
}

}  // namespace

MeshPart make_mesh(const ScenePointer& scene, py::handle positions, py::handle triangles, py::handle normals,
                   py::handle uvs, py::handle material, const std::string& name, py::handle colors) {
  scene::Mesh mesh;
  mesh.name = name;
  const auto vertices = static_cast<std::size_t>(rows<float>("positions", positions, 3).shape(0));
  mesh.positions.resize(vertices);
  fill("positions", positions, mesh.positions);
  expect_finite(mesh);
  const Array<std::uint32_t> indices = rows<std::uint32_t>("triangles", triangles, 3);
  if (indices.shape(0) == 0) fail("triangles", "is empty", "a triangle");
  mesh.triangles.resize(static_cast<std::size_t>(indices.shape(0)));
  std::memcpy(mesh.triangles.data(), indices.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
  const ErrorParts wrong = scene::wrong_index(mesh.triangles, vertices);
  if (!wrong.problem.empty()) fail("triangles", wrong.problem, wrong.expected);
  read_rows("normals", normals, vertices, mesh.normals);
  read_rows("uvs", uvs, vertices, mesh.uv0);
  read_colors(colors, vertices, mesh.colors);
  mesh.material = material_index(scene, material);
  scene->own_meshes.resize(scene->source.meshes.size(), 0);
  scene->source.meshes.push_back(std::move(mesh));
  scene->own_meshes.push_back(1);
  scene->change();
  return {{scene, scene->source.meshes.size() - 1}};
}

InstancePart make_instance(const ScenePointer& scene, py::handle mesh, py::handle matrix,
                           const std::string& name) {
  if (!py::isinstance<MeshPart>(mesh) || mesh.cast<MeshPart>().scene != scene)
    fail("mesh", "is not a mesh of this scene", "one of scene.meshes");
  scene::Instance instance;
  const std::size_t number = scene->source.instances.size();
  instance.mesh = static_cast<int>(mesh.cast<MeshPart>().index);
  const std::string& of_mesh = scene->source.mesh_of(instance).name;
  instance.name = !name.empty() ? name : !of_mesh.empty() ? of_mesh : fmt::format("node {}", number);
  if (!matrix.is_none()) place(instance, transform("transform", matrix));
  for (const scene::Instance& other : scene->source.instances)
    instance.placement = std::max(instance.placement, other.placement);
  ++instance.placement;
  scene->source.instances.push_back(std::move(instance));
  scene->change();
  return {{scene, number}};
}

TexturePart make_texture(const ScenePointer& scene, py::handle image, const std::string& wrap, bool nearest,
                         const std::string& name) {
  const py::array given = py::array::ensure(image);
  const auto fits = [&] {
    if (!given || !py::isinstance<py::array_t<std::uint8_t>>(given)) return false;
    if (given.ndim() != 2 && (given.ndim() != 3 || given.shape(2) < 1 || given.shape(2) > 4)) return false;
    return given.size() > 0 && given.shape(0) <= kLargestTexture && given.shape(1) <= kLargestTexture;
  };
  if (!fits()) fail("image", "is not an image", "an array of uint8 of shape (h, w) or (h, w, 1 to 4)");
  const Array<std::uint8_t> bytes(given);
  scene::Image picture;
  picture.name = name;
  picture.height = static_cast<int>(given.shape(0));
  picture.width = static_cast<int>(given.shape(1));
  picture.channels = given.ndim() == 2 ? 1 : static_cast<int>(given.shape(2));
  picture.pixels.assign(bytes.data(), bytes.data() + bytes.size());
  scene::Texture texture;
  texture.wrap_s = texture.wrap_t = apps::parse_choice("wrap", wrap, kWraps);
  texture.nearest = nearest;
  texture.image = static_cast<int>(scene->source.images.size());
  scene->source.images.push_back(std::move(picture));
  scene->source.textures.push_back(texture);
  scene->change();
  return {{scene, scene->source.textures.size() - 1}};
}

void add_geometry(py::module_& module) {
  add_mesh_class(module);
  add_instance_class(module);
}

}  // namespace gatelight::python
