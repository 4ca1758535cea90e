#include "scene/gltf/appearance.h"

#include "scene/gltf/images.h"
#include "scene/gltf/load_each.h"
#include "scene/gltf/materials.h"
#include "scene/gltf/model.h"
#include "scene/material_fields.h"

namespace gatelight::scene::gltf {
namespace {

/// Which images are normal maps in all their uses.
std::vector<char> normal_maps(const Scene& scene, std::size_t images) {
  std::vector<char> result(images, 1);
  for (const Material& material : scene.materials) {
    for_each_slot(material, [&](const TextureSlot& slot, bool) {
      if (!slot || is_normal_map(material, slot)) return;
      const int image = scene.textures[static_cast<std::size_t>(slot.texture)].image;
      if (image >= 0) result[static_cast<std::size_t>(image)] = 0;
    });
  }
  return result;
}

}  // namespace

/// The file's first image with the same URI and buffer view, so that equal images are decoded once.
int Appearance::first_alike(int image) {
  const tinygltf::Image& source = element(document_.model().images, image);
  if (source.uri.empty() && source.bufferView < 0) return image;
  return alike_.try_emplace({source.uri, source.bufferView}, image).first->second;
}

void Appearance::load_materials(const std::vector<int>& materials, const LoadOptions& options, Scene& scene,
                                Warnings& warnings) {
  scene.materials.clear();
  for (const int original : materials) {
    Material material = convert_material(document_, original, warnings);
    for_each_slot(material, [&](TextureSlot& slot, bool) {
      if (slot) slot.texture = textures_.number_of(slot.texture);
    });
    const bool one_sided = !material.double_sided && !material.transmits();
    material.culled = one_sided && options.back_faces == BackFaces::cull;
    material.double_sided |= material.emits() && options.back_faces == BackFaces::light;
    scene.materials.push_back(std::move(material));
  }
  for (std::size_t i = scene.textures.size(); i < textures_.order().size(); ++i) {
    Texture texture = convert_texture(document_, textures_.order()[i]);
    texture.image = images_.number_of(first_alike(texture.image));
    scene.textures.push_back(texture);
  }
}

void Appearance::load_images(const LoadOptions& options, Scene& scene, Warnings& warnings) const {
  const std::size_t before = scene.images.size();
  scene.images.resize(images_.order().size());
  const std::vector<char> normal = normal_maps(scene, scene.images.size());
  load_each(
      scene.images.size() - before,
      [&](std::size_t i, Warnings& own) {
        const std::size_t image = before + i;
        scene.images[image] =
            load_image(document_, images_.order()[image],
                       {.missing_is_error = options.missing_is_error, .normal_map = normal[image] != 0}, own);
      },
      warnings);
}

}  // namespace gatelight::scene::gltf
