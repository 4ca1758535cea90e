#include "scene/gltf/node_content.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/gltf/accessors.h"

namespace gatelight::scene::gltf {
namespace {

/// The rigid part of a camera's transform. It keeps the direction of view and the plane of "up". Scale, shear
/// and mirroring have no meaning for a camera.
Affine rigid(const Document& document, int node, const Eigen::Affine3d& world) {
  const Eigen::Vector3d z = world.linear().col(2).stableNormalized();
  const Eigen::Vector3d x = world.linear().col(1).cross(z).stableNormalized();
  if (!(z.norm() > 0.5) || !(x.norm() > 0.5)) {
    document.fail(fmt::format("nodes[{}]", node), "a camera scaled to nothing, expected a direction of view");
  }
  Affine result = Affine::Identity();
  result.linear().col(0) = x.cast<float>();
  result.linear().col(1) = z.cross(x).cast<float>();
  result.linear().col(2) = z.cast<float>();
  result.translation() = world.translation().cast<float>();
  return result;
}

}  // namespace

Camera make_camera(const Document& document, int node_index, const Eigen::Affine3d& world) {
  const tinygltf::Node& node = document.model().nodes[static_cast<std::size_t>(node_index)];
  const tinygltf::Camera& source = document.model().cameras[static_cast<std::size_t>(node.camera)];
  const std::string where = fmt::format("cameras[{}]", node.camera);
  Camera camera;
  camera.name = source.name.empty() ? node.name : source.name;
  camera.transform = rigid(document, node_index, world);
  if (source.type == "orthographic") {
    camera.orthographic = true;
    camera.half_height = std::abs(static_cast<float>(source.orthographic.ymag));
    camera.half_width = std::abs(static_cast<float>(source.orthographic.xmag));
    if (camera.half_height == 0.0f || camera.half_width == 0.0f) {
      document.fail(where, "xmag or ymag is 0, expected a size");
    }
  } else {
    camera.vertical_fov = static_cast<float>(source.perspective.yfov);
    camera.aspect = static_cast<float>(source.perspective.aspectRatio);
    if (!(camera.vertical_fov > 0.0f)) document.fail(where, "no perspective.yfov, expected an angle");
  }
  return camera;
}

PunctualLight make_light(const Document& document, int node_index, int light_index,
                         const Eigen::Affine3d& world) {
  const tinygltf::Node& node = document.model().nodes[static_cast<std::size_t>(node_index)];
  const tinygltf::Light& source = document.model().lights[static_cast<std::size_t>(light_index)];
  PunctualLight light;
  light.name = source.name.empty() ? node.name : source.name;
  if (source.type == "directional") light.type = LightType::directional;
  if (source.type == "spot") light.type = LightType::spot;
  if (source.color.size() == 3) {
    light.intensity = Color(static_cast<float>(source.color[0]), static_cast<float>(source.color[1]),
                            static_cast<float>(source.color[2]))
                          .max(0.0f);
  }
  light.intensity *= static_cast<float>(source.intensity);
  const std::string where = fmt::format("extensions.KHR_lights_punctual.lights[{}]", light_index);
  if (!light.intensity.allFinite()) document.fail(where, "intensity too large, expected finite numbers");
  light.position = world.translation().cast<float>();
  const Eigen::Vector3d direction = -world.linear().col(2).stableNormalized();
  if (direction.norm() > 0.5) light.direction = direction.cast<float>();
  if (source.range > 0.0) light.range = static_cast<float>(source.range);
  if (light.type == LightType::spot) {
    const double outer = std::min(source.spot.outerConeAngle, static_cast<double>(kPi) / 2.0);
    const double inner = source.spot.innerConeAngle;
    if (!(inner < outer)) {
      document.fail(where + ".spot",
                    fmt::format("innerConeAngle {}, expected less than outerConeAngle {}", inner, outer));
    }
    light.cos_inner = static_cast<float>(std::cos(inner));
    light.cos_outer = static_cast<float>(std::cos(outer));
  }
  return light;
}

std::vector<Eigen::Affine3d> read_instances(const Document& document, const tinygltf::Value& extension,
                                            const std::string& where) {
  const tinygltf::Value& attributes = extension.Get("attributes");
  // Custom attributes must have the same count, too.
  std::size_t count = 0;
  for (const std::string& semantic : attributes.Keys()) {
    const AccessorReader reader(document, attributes.Get(semantic).GetNumberAsInt());
    if (count != 0 && reader.count() != count) {
      document.fail(reader.where(), fmt::format("count {} for {} of {}, expected {}", reader.count(),
                                                semantic, where, count));
    }
    count = reader.count();
  }
  const auto read = [&](const std::string& semantic, int components) {
    std::vector<float> rows;
    if (!attributes.Has(semantic)) return rows;
    const AccessorReader reader(document, attributes.Get(semantic).GetNumberAsInt());
    reader.expect_attribute(semantic, {components});
    rows.resize(count * static_cast<std::size_t>(components));
    reader.read_floats({}, components, rows.data());
    return rows;
  };
  const std::vector<float> translations = read("TRANSLATION", 3);
  const std::vector<float> rotations = read("ROTATION", 4);
  const std::vector<float> scales = read("SCALE", 3);

  std::vector<Eigen::Affine3d> transforms(count, Eigen::Affine3d::Identity());
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Affine3d& t = transforms[i];
    if (!translations.empty()) t.translate(Eigen::Map<const Vec3>(&translations[i * 3]).cast<double>());
    if (!rotations.empty()) {
      const Eigen::Quaterniond q(rotations[i * 4 + 3], rotations[i * 4], rotations[i * 4 + 1],
                                 rotations[i * 4 + 2]);
      if (!(q.norm() > 1e-6)) {
        document.fail(where,
                      fmt::format("ROTATION {} of length {}, expected a unit quaternion", i, q.norm()));
      }
      t.rotate(q.normalized());
    }
    if (!scales.empty()) t.scale(Eigen::Map<const Vec3>(&scales[i * 3]).cast<double>());
  }
  return transforms;
}

Eigen::Affine3d read_first_matrix(const Document& document, int accessor) {
  const AccessorReader reader(document, accessor);
  if (reader.components() != 16 || reader.component_type() != TINYGLTF_COMPONENT_TYPE_FLOAT) {
    document.fail(reader.where(), "inverse bind matrices that are not MAT4 of floats, expected those");
  }
  const std::uint32_t first = 0;
  Eigen::Matrix4f m;
  reader.read_floats({&first, 1}, 16, m.data());
  Eigen::Affine3d t = Eigen::Affine3d::Identity();
  t.matrix().topRows<3>() = m.topRows<3>().cast<double>();
  return t;
}

}  // namespace gatelight::scene::gltf
