#pragma once
// The materials of a scene, with their textures and images.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scene/gltf/document.h"
#include "scene/gltf/numbering.h"

namespace gatelight::scene::gltf {

/// Textures and images keep their numbers over all calls, so that each image is decoded once.
class Appearance {
 public:
  /// The document must outlive it.
  explicit Appearance(const Document& document) : document_(document) {}

  /// Replaces the materials of the scene by those of the file's indices, and adds the textures that are new.
  void load_materials(const std::vector<int>& materials, const LoadOptions& options, Scene& scene,
                      Warnings& warnings);
  /// Adds the images that are new. Throws InputError.
  void load_images(const LoadOptions& options, Scene& scene, Warnings& warnings) const;

 private:
  int first_alike(int image);

  const Document& document_;
  Numbering textures_, images_;
  std::map<std::pair<std::string, int>, int> alike_;  ///< by URI and buffer view
};

}  // namespace gatelight::scene::gltf
