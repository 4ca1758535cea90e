#include "scene/gltf/vertices.h"

#include <fmt/format.h>

#include <utility>

#include "scene/gltf/model.h"

namespace gatelight::scene::gltf {

Vertices::Vertices(const Document& document, const tinygltf::Primitive& primitive,
                   const DracoPrimitive* draco, std::string where, Warnings& warnings)
    : document_(document), attributes_(primitive.attributes), draco_(draco), where_(std::move(where)) {
  if (!has("POSITION")) document.fail(where_ + ".attributes", "no POSITION, expected one");
  count_ = draco ? draco->vertex_count() : AccessorReader(document, attributes_.at("POSITION")).count();
  if (count_ > 0xffffffffu)
    document.fail(where_, fmt::format("{} vertices, expected at most 2^32 - 1", count_));
  drop("NORMAL", {3}, warnings);
  drop("TANGENT", {4}, warnings);
  drop("TEXCOORD_0", {2}, warnings);
  drop("TEXCOORD_1", {2}, warnings);
  drop("COLOR_0", {3, 4}, warnings);
}

/// Draco's data have their own form.
void Vertices::drop(const std::string& semantic, std::initializer_list<int> components, Warnings& warnings) {
  const auto found = attributes_.find(semantic);
  if (found == attributes_.end() || (draco_ && draco_->has(semantic))) return;
  const AccessorReader source(document_, found->second);
  if (source.fits_attribute(components) && source.count() == count_) return;
  warnings.add(fmt::format("{}: {} elements of {} components of type {} for {} of {} vertices; it is ignored",
                           source.where(), source.count(), source.components(), source.component_type(),
                           semantic, count_));
  attributes_.erase(found);
}

void Vertices::read(const std::string& semantic, std::initializer_list<int> components, Selection selection,
                    int width, float* out, bool force_normalized) const {
  if (!draco_ || !draco_->has(semantic)) {
    read(attributes_.at(semantic), semantic, components, selection, width, out, force_normalized);
    return;
  }
  bool normalized = force_normalized;
  if (attributes_.contains(semantic)) {
    normalized |= element(document_.model().accessors, attributes_.at(semantic)).normalized;
  }
  draco_->read_floats(semantic, selection, width, normalized, out);
}

void Vertices::read(int accessor, const std::string& semantic, std::initializer_list<int> components,
                    Selection selection, int width, float* out, bool force_normalized) const {
  const AccessorReader source(document_, accessor);
  source.expect_attribute(semantic, components);
  if (source.count() != count_) {
    document_.fail(source.where(), fmt::format("count {} for {} of {}, expected {} as POSITION",
                                               source.count(), semantic, where_, count_));
  }
  source.read_floats(selection, width, out, force_normalized);
}

}  // namespace gatelight::scene::gltf
