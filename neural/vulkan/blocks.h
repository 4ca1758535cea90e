#pragma once
// The data of a model and of a batch that shaders read: shaders/block_fields.glsl as C++ structs.

#include <cstddef>
#include <cstdint>

#include "neural/layout/hash_grid.h"
#include "neural/model/model.h"

namespace gatelight::neural::vulkan {

using Address = std::uint64_t;

/// The names of the shaders.
namespace glsl {
using uint = std::uint32_t;
using Words = Address;
using Pairs = Address;
using Floats = Address;
using Vectors = Address;
using Parts = Address;
using HashLevel = HashGridLevel;
#define GATELIGHT_BLOCK(name) struct name
#include "neural/vulkan/shaders/block_fields.glsl"
#undef GATELIGHT_BLOCK
}  // namespace glsl

using TableBlock = glsl::Table;
using AuxiliaryBlock = glsl::Auxiliary;
using AdamBlock = glsl::Adam;

// Blocks begin with zeros.
struct ModelBlock : glsl::Model {
  ModelBlock() : glsl::Model{} {}
};
struct BatchBlock : glsl::Batch {
  BatchBlock() : glsl::Batch{} {}
};

struct PushBlock {
  Address model = 0, batch = 0;
  std::uint32_t argument = 0, other = 0;
};

static_assert(sizeof(HashGridLevel) == 20 && offsetof(glsl::Model, hash_levels) == 304);
static_assert(sizeof(glsl::Model) == 1056 && sizeof(glsl::Batch) == 240);

}  // namespace gatelight::neural::vulkan
