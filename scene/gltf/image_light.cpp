#include "scene/gltf/image_light.h"

#include <fmt/format.h>

#include "scene/gltf/images.h"

namespace gatelight::scene::gltf {
namespace {

constexpr const char* kExtension = "EXT_lights_image_based";

}  // namespace

std::optional<ImageBasedLight> load_image_light(const Document& document, int index, bool missing_is_error,
                                                Warnings& warnings) {
  const tinygltf::Value* const used =
      find_extension(element(document.model().scenes, index).extensions, kExtension);
  if (!used) return {};
  const int number = integer_or(*used, "light", 0);
  const tinygltf::Value& source =
      element(array_of(*find_extension(document.model().extensions, kExtension), "lights"), number);
  const std::string where = fmt::format("{}.lights[{}]", kExtension, number);

  ImageBasedLight light;
  light.name = text_or(source, "name", "");
  light.intensity = float_or(source, "intensity", 1.0f);
  const auto r = vector_or<Eigen::Vector4d>(source, "rotation", Eigen::Vector4d::UnitW());
  const Eigen::Quaterniond rotation(r);
  if (!(rotation.norm() > 1e-12)) document.fail(where + ".rotation", "0 0 0 0, expected a unit quaternion");
  light.rotation = rotation.normalized().toRotationMatrix().cast<float>();
  const tinygltf::Value::Array& levels = array_of(source, "specularImages");
  if (levels.empty()) document.fail(where + ".specularImages", "empty, expected six images of each level");
  for (std::size_t face = 0; face < light.faces.size(); ++face)
    light.faces[face] = load_image(document, levels[0].Get(static_cast<int>(face)).GetNumberAsInt(),
                                   {.missing_is_error = missing_is_error}, warnings);
  return light;
}

}  // namespace gatelight::scene::gltf
