#pragma once
// A cache's part of a file: the model's tensors and metadata (neural/file/model_file.h) and the renderer's
// own.

#include <array>
#include <set>
#include <span>
#include <string>

#include "neural/model/model_file.h"
#include "renderer/cache/cache_state.h"

namespace gatelight::renderer {

/// A tensor with one axis; the caller keeps the values.
template <class Values>
TensorView view_array(const char* name, TensorType type, const Values& values) {
  return {name, type, {values.size()}, std::as_bytes(std::span(values))};
}

/// Reads a tensor with one axis and as many elements as `values`.
template <class Values>
void read_array(SafetensorsReader& file, const char* name, TensorType type, Values&& values) {
  const std::uint64_t shape[] = {values.size()};
  file.read(name, type, shape, std::as_writable_bytes(std::span(values)));
}

/// The views point into the state and into this struct.
struct CacheContent {
  neural::ModelContent model;
  std::vector<std::uint32_t> sides;
  std::vector<float> spacing_scales;
  std::array<float, 4> scales{};
  std::vector<TensorView> tensors;  ///< the model's and the renderer's
};

/// Fills `content`, which must not move while its views are used. Throws BadConfiguration for a state
/// that is not the model's.
void fill_cache_content(CacheContent& content, const neural::Model& model,
                        const neural::TrainingOptions& options, const CacheState& state);

/// Reads the setup that is needed to build the model. Throws CacheFileError.
CacheSetup read_cache_setup(SafetensorsReader& file);

/// Reads the state of the model that was built from the setup. Throws CacheFileError, also where the
/// file has tensors that are neither of the cache nor one of `others`.
CacheState read_cache_state(SafetensorsReader& file, const neural::Model& model,
                            const neural::TrainingOptions& options, std::set<std::string> others = {});

}  // namespace gatelight::renderer
