#include "scene/gltf/node_content.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/gltf/accessors.h"
#include "scene/gltf/model.h"

namespace gatelight::scene::gltf {
namespace {

/// The first of two names that is not empty.
const std::string& name_of(const std::string& own, const std::string& other) {
  return own.empty() ? other : own;
}

/// The rigid part of a camera's transform. It keeps the direction of view and the plane of "up". Scale, shear
/// and mirroring have no meaning for a camera.
Affine rigid(const Document& document, int node, const Eigen::Affine3d& world) {
  const Eigen::Vector3d z = world.linear().col(2).stableNormalized();
  const Eigen::Vector3d x = world.linear().col(1).cross(z).stableNormalized();
  if (!(z.norm() > 0.5) || !(x.norm() > 0.5)) {
    document.fail(fmt::format("nodes[{}]", node), "a camera with a scale of 0, expected a view direction");
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
  const tinygltf::Node& node = element(document.model().nodes, node_index);
  const int index = node.camera;
  const tinygltf::Camera& source = element(document.model().cameras, index);
  const std::string where = fmt::format("cameras[{}]", index);
  Camera camera;
  camera.name = name_of(source.name, node.name);
  camera.node = node.name;
  camera.transform = rigid(document, node_index, world);
  if (source.type == "orthographic") {
    camera.orthographic = true;
    camera.half_height = static_cast<float>(std::abs(source.orthographic.ymag));
    camera.half_width = static_cast<float>(std::abs(source.orthographic.xmag));
    if (camera.half_height == 0.0f || camera.half_width == 0.0f) {
      document.fail(where, "xmag or ymag is 0, expected a size");
    }
  } else {
    camera.vertical_fov = static_cast<float>(source.perspective.yfov);
    camera.aspect = static_cast<float>(source.perspective.aspectRatio);
  }
  return camera;
}

std::optional<PunctualLight> make_light(const Document& document, int node_index, int light_index,
                                        const Eigen::Affine3d& world, Warnings& warnings) {
  const tinygltf::Light& source = element(document.model().lights, light_index);
  PunctualLight light;
  light.name = name_of(source.name, element(document.model().nodes, node_index).name);
  const std::string where = fmt::format("extensions.KHR_lights_punctual.lights[{}]", light_index);
  if (source.type == "directional") {
    light.type = LightType::directional;
  } else if (source.type == "spot") {
    light.type = LightType::spot;
  } else if (source.type != "point") {
    warnings.add(where + ": a light of unknown type is ignored");
    return std::nullopt;
  }
  light.intensity = vector_or<Color>(source.color, Color::Ones()).max(0.0f);
  light.intensity *= static_cast<float>(source.intensity);
  if (!light.intensity.allFinite()) document.fail(where, "intensity too large, expected finite numbers");
  light.position = world.translation().cast<float>();
  const Eigen::Vector3d direction = -world.linear().col(2).stableNormalized();
  if (direction.norm() > 0.5) light.direction = direction.cast<float>();
  const Vec3 side = world.linear().col(0).stableNormalized().cast<float>();
  const Vec3 across = side - light.direction * light.direction.dot(side);
  light.side = across.norm() > 1e-3f ? Vec3(across.normalized()) : any_perpendicular(light.direction);
  light.range = source.range > 0.0 ? static_cast<float>(source.range) : kInfinity;
  if (light.type == LightType::spot) {
    const double outer = std::min(source.spot.outerConeAngle, static_cast<double>(kPi) / 2.0);
    const double inner = source.spot.innerConeAngle;
    if (!(inner < outer)) {
      warnings.add(fmt::format(
          "{}.spot: innerConeAngle {}, expected less than outerConeAngle {}; the cone gets a hard edge",
          where, inner, outer));
    }
    light.cos_inner = static_cast<float>(std::cos(std::min(inner, outer)));
    light.cos_outer = static_cast<float>(std::cos(outer));
  }
  return light;
}

std::map<std::string, int> instance_attributes(const tinygltf::Value& extension) {
  std::map<std::string, int> accessors;
  if (const tinygltf::Value* attributes = find_member(extension, "attributes")) {
    for (const auto& [semantic, accessor] : attributes->Get<tinygltf::Value::Object>())
      accessors[semantic] = accessor.GetNumberAsInt();
  }
  return accessors;
}

std::vector<Eigen::Affine3d> read_instances(const Document& document,
                                            const std::map<std::string, int>& attributes,
                                            const std::string& where, Warnings& warnings) {
  // Custom attributes must have the same count, too.
  std::size_t count = 0;
  for (const auto& [semantic, accessor] : attributes) {
    const AccessorReader reader(document, accessor);
    if (count != 0 && reader.count() != count) {
      document.fail(reader.where(), fmt::format("count {} for {} of {}, expected {}", reader.count(),
                                                semantic, where, count));
    }
    count = reader.count();
  }
  const auto read = [&](const std::string& semantic, int components) {
    std::vector<float> rows;
    if (!attributes.contains(semantic)) return rows;
    const AccessorReader reader(document, attributes.at(semantic));
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
      if (q.norm() > 1e-6) {
        t.rotate(q.normalized());
      } else {
        warnings.add(where + ": a ROTATION of length 0, expected a unit quaternion; it is ignored");
      }
    }
    if (!scales.empty()) t.scale(Eigen::Map<const Vec3>(&scales[i * 3]).cast<double>());
  }
  return transforms;
}

std::vector<Eigen::Affine3d> read_inverse_bind_matrices(const Document& document, int accessor,
                                                        std::size_t joints) {
  std::vector<Eigen::Affine3d> matrices(joints, Eigen::Affine3d::Identity());
  if (accessor < 0) return matrices;
  const AccessorReader reader(document, accessor);
  if (reader.components() != 16 || reader.component_type() != kFloat) {
    document.fail(reader.where(), "inverse bind matrices that are not MAT4 of floats, expected those");
  }
  if (reader.count() < joints) {
    document.fail(reader.where(), fmt::format("{} inverse bind matrices, expected {}, one for each joint",
                                              reader.count(), joints));
  }
  std::vector<Eigen::Matrix4f> rows(reader.count());
  reader.read_floats({}, 16, rows.data()->data());
  for (std::size_t i = 0; i < joints; ++i)
    matrices[i].matrix().topRows<3>() = rows[i].topRows<3>().cast<double>();
  return matrices;
}

}  // namespace gatelight::scene::gltf
