#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstring>

#include "apps/python/arrays.h"
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
using scene::Mesh;

constexpr int kLargestTexture = 65536;

[[noreturn]] void fail(const char* name, const std::string& problem, const std::string& expected) {
  throw BadOption({name, "", problem, expected});
}

template <class Rows>
constexpr py::ssize_t kColumns = static_cast<py::ssize_t>(sizeof(typename Rows::value_type) / sizeof(float));

/// `count` rows of an array, or none of None.
template <class Rows>
Rows read_rows(const char* name, py::handle values, std::size_t count) {
  if (values.is_none()) return {};
  const Array<float> array = rows<float>(name, values, kColumns<Rows>);
  if (static_cast<std::size_t>(array.shape(0)) != count)
    throw BadOption(
        {name, shape_of(array), "is the array's shape", fmt::format("({}, {})", count, kColumns<Rows>)});
  Rows read(count);
  std::memcpy(static_cast<void*>(read.data()), array.data(), count * sizeof(read[0]));
  return read;
}

/// Texture coordinates and normals are repaired later, as those of a file are.
auto read_positions(const char* name, py::handle values, std::size_t count) {
  Mesh mesh;
  mesh.positions = read_rows<decltype(mesh.positions)>(name, values, count);
  const ErrorParts wrong = scene::wrong_position(mesh);
  if (!wrong.problem.empty()) fail(name, wrong.problem, wrong.expected);
  return mesh.positions;
}

/// (n, 3) or (n, 4); three are opaque.
std::vector<Vec4> read_colors(const char* name, py::handle values, std::size_t count) {
  std::vector<Vec4> colors;
  const py::array given = py::array::ensure(values);
  PyErr_Clear();
  if (given && given.ndim() == 2 && given.shape(1) == 4) {
    colors = read_rows<std::vector<Vec4>>(name, values, count);
  } else {
    for (const Vec3& c : read_rows<std::vector<Vec3>>(name, values, count))
      colors.emplace_back(c.x(), c.y(), c.z(), 1.0f);
  }
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const Vec4& c = colors[i];
    if (c.allFinite() && c.minCoeff() >= 0.0f) continue;
    fail(name, fmt::format("row {} is ({}, {}, {}, {})", i, c.x(), c.y(), c.z(), c.w()),
         "finite numbers, not negative");
  }
  return colors;
}

int material_index(const ScenePointer& scene, py::handle material) {
  if (material.is_none()) return -1;
  return index_of<MaterialPart>(scene, "material", material, "material", "one of scene.materials or None");
}

void place(scene::Instance& instance, const Affine& transform) {
  instance.transform = transform;
  instance.swaps_handedness = transform.linear().cast<double>().determinant() < 0.0;
}

template <class Rows>
py::object view_of(const ScenePointer& scene, const Rows& values) {
  if (values.empty()) return py::none();
  return view(values.data()->data(), static_cast<py::ssize_t>(values.size()), kColumns<Rows>,
              py::cast(scene));
}

/// Rows that `read` makes of the name, a value of Python and their number. Views of them stay valid.
template <class Rows, class Read>
Field<Mesh> rows_field(const char* name, Rows Mesh::*member, Read read, const char* help) {
  return {name,
          [member](const ScenePointer& scene, const Mesh& mesh) { return view_of(scene, mesh.*member); },
          [name, member, read](const ScenePointer&, Mesh& mesh, py::handle given) {
            Rows& own = mesh.*member;
            Rows next = read(name, given, mesh.positions.size());
            if (own.empty()) {
              own = std::move(next);
            } else if (own.size() == next.size()) {
              std::copy(next.begin(), next.end(), own.begin());
            } else {
              fail(name, "None would leave views without their memory", "an array");
            }
          },
          help};
}

const std::vector<Field<Mesh>>& mesh_fields() {
  static const std::vector<Field<Mesh>> fields = {
      {"name", &Mesh::name, {}, ""},
      rows_field("positions", &Mesh::positions, read_positions,
                 "(n, 3) float32, metres; a new array has as many rows"),
      rows_field("normals", &Mesh::normals, read_rows<std::vector<Vec3>>, "(n, 3) float32, or None: flat"),
      rows_field("uvs", &Mesh::uv0, read_rows<std::vector<Vec2>>, "(n, 2) float32, or None"),
      rows_field("colors", &Mesh::colors, read_colors,
                 "(n, 4) float32, linear, that multiply the base colour, or None; (n, 3) are opaque"),
      {"material",
       [](const ScenePointer& scene, const Mesh& mesh) -> py::object {
         if (mesh.material < 0) return py::none();
         return py::cast(MaterialPart{scene, static_cast<std::size_t>(mesh.material)});
       },
       [](const ScenePointer& scene, Mesh& mesh, py::handle material) {
         mesh.material = material_index(scene, material);
       },
       ""},
  };
  return fields;
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

}  // namespace

MeshPart make_mesh(const ScenePointer& scene, py::handle positions, py::handle triangles, py::handle normals,
                   py::handle uvs, py::handle material, const std::string& name, py::handle colors) {
  Mesh mesh;
  mesh.name = name;
  const auto vertices = static_cast<std::size_t>(rows<float>("positions", positions, 3).shape(0));
  mesh.positions = read_positions("positions", positions, vertices);
  const Array<std::uint32_t> indices = rows<std::uint32_t>("triangles", triangles, 3);
  if (indices.shape(0) == 0) fail("triangles", "is empty", "a triangle");
  mesh.triangles.resize(static_cast<std::size_t>(indices.shape(0)));
  std::memcpy(mesh.triangles.data(), indices.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
  const ErrorParts wrong = scene::wrong_index(mesh.triangles, vertices);
  if (!wrong.problem.empty()) fail("triangles", wrong.problem, wrong.expected);
  mesh.normals = read_rows<std::vector<Vec3>>("normals", normals, vertices);
  mesh.uv0 = read_rows<std::vector<Vec2>>("uvs", uvs, vertices);
  mesh.colors = read_colors("colors", colors, vertices);
  mesh.material = material_index(scene, material);
  scene->own_meshes.resize(scene->source.meshes.size(), 0);
  scene->own_meshes.push_back(1);
  return MeshPart::add(scene, std::move(mesh));
}

InstancePart make_instance(const ScenePointer& scene, py::handle mesh, py::handle matrix,
                           const std::string& name) {
  scene::Instance instance;
  const std::size_t number = scene->source.instances.size();
  instance.mesh = index_of<MeshPart>(scene, "mesh", mesh, "mesh", "one of scene.meshes");
  const std::string& of_mesh = scene->source.mesh_of(instance).name;
  instance.name = !name.empty() ? name : !of_mesh.empty() ? of_mesh : fmt::format("node {}", number);
  if (!matrix.is_none()) place(instance, transform("transform", matrix));
  for (const scene::Instance& other : scene->source.instances)
    instance.placement = std::max(instance.placement, other.placement);
  ++instance.placement;
  return InstancePart::add(scene, std::move(instance));
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
  return TexturePart::add(scene, texture);
}

void add_geometry(py::module_& module) {
  add_part_class<MeshPart>(module, "Mesh",
                           "Triangles of one material. Arrays that are read are views without a copy.",
                           mesh_fields())
      .def_property_readonly(
          "triangles", [](const MeshPart& part) { return view_of(part.scene, part->triangles); },
          "(m, 3) uint32");
  add_part_class<InstancePart>(module, "Instance", "A mesh in the world.", instance_fields())
      .def_property_readonly("name", [](const InstancePart& part) { return part->name; })
      .def_property_readonly("mesh", [](const InstancePart& part) {
        return MeshPart{part.scene, static_cast<std::size_t>(part->mesh)};
      });
}

}  // namespace gatelight::python
