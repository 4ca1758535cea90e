#include "scene/gltf/appearance.h"

#include <optional>

#include "scene/gltf/images.h"
#include "scene/gltf/load_each.h"
#include "scene/gltf/materials.h"
#include "scene/gltf/model.h"
#include "scene/material_fields.h"

namespace gatelight::scene::gltf {
namespace {

/// What images are in all their uses.
std::vector<ImageUse> find_uses(const Scene& scene, std::size_t images) {
  std::vector<std::optional<ImageUse>> found(images);
  for (const Material& material : scene.materials) {
    for_each_slot(material, [&](const TextureSlot& slot, bool) {
      if (!slot) return;
      const int image = scene.textures[static_cast<std::size_t>(slot.texture)].image;
      if (image < 0) return;
      ImageUse use = ImageUse::any;
      if (is_normal_map(material, slot)) use = ImageUse::normal_map;
      if (&slot == &material.emission_texture) use = ImageUse::emission;
      std::optional<ImageUse>& known = found[static_cast<std::size_t>(image)];
      known = known.value_or(use) == use ? use : ImageUse::any;
    });
  }
  std::vector<ImageUse> uses;
  for (const std::optional<ImageUse>& use : found) uses.push_back(use.value_or(ImageUse::any));
  return uses;
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
  const std::vector<ImageUse> uses = find_uses(scene, scene.images.size());
  load_each(
      scene.images.size() - before,
      [&](std::size_t i, Warnings& own) {
        const std::size_t image = before + i;
        scene.images[image] =
            load_image(document_, images_.order()[image],
                       {.missing_is_error = options.missing_is_error, .use = uses[image]}, own);
      },
      warnings);
}

}  // namespace gatelight::scene::gltf
