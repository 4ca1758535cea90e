#pragma once
// The primitives that a scene shows, each once for every pose of its mesh.

#include <string>
#include <vector>

#include "scene/gltf/nodes.h"

namespace gatelight::scene::gltf {

struct MeshPart {
  int pose;  ///< into Graph::poses
  int mesh;  ///< index in the file
  int primitive;
  int material;  ///< into Parts::materials()
};

class Parts {
 public:
  /// `variant`: an index of KHR_materials_variants, or -1.
  Parts(const Document& document, const Graph& graph, int variant);

  std::size_t size() const { return parts_.size(); }
  const MeshPart& operator[](std::size_t i) const { return parts_[i]; }
  /// The materials of all parts, by their indices in the file, in the order of their first use.
  const std::vector<int>& materials() const { return materials_; }

  /// Calls function(number of a part) for all parts of a pose.
  template <typename Function>
  void for_each_of(int pose, Function function) const {
    const auto first = static_cast<std::size_t>(first_[static_cast<std::size_t>(pose)]);
    for (std::size_t i = first; i < parts_.size() && parts_[i].pose == pose; ++i) function(i);
  }

  /// Claims the memory of the parts and their instances from the document. Throws InputError.
  void claim(const Document& document, const Graph& graph, bool baked) const;

 private:
  std::vector<MeshPart> parts_;
  std::vector<int> first_;  ///< by the pose; its parts are consecutive
  std::vector<int> materials_;
};

/// The index of the variant with this name. Throws InputError for one that is not there.
int find_variant(const Document& document, const std::vector<std::string>& names, const std::string& name);

/// The names of KHR_materials_variants.
std::vector<std::string> variant_names(const Document& document);

}  // namespace gatelight::scene::gltf
