#include "neural/vulkan/answers.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/parallel/loops.h"
#include "neural/vulkan/commands.h"
#include "neural/vulkan/point_upload.h"

namespace gatelight::neural::vulkan {

namespace {

/// Chunks in progress: one computes, one waits, one is being packed or read.
constexpr std::size_t kChunks = 3;
constexpr std::size_t kChunkPoints = std::size_t{1} << 17;
/// Enough to fill a large device, and few enough that the weights are read for several tiles.
constexpr std::uint32_t kMaxGroups = 1024;
constexpr std::size_t kCopiedFloats = std::size_t{1} << 15;

std::vector<std::uint32_t> answer_constants(const Model& model, const AnswerTile& tile, bool rounded,
                                            bool halves) {
  std::vector<std::uint32_t> constants = network_constants(model);
  constants.insert(constants.end(),
                   {tile.points, std::bit_cast<std::uint32_t>(model.config.mlp.leaky_slope),
                    rounded ? 1u : 0u, tile.staged_vectors, static_cast<std::uint32_t>(model.config.encoding),
                    halves ? 1u : 0u, std::max(model.parameters.features, 1u)});
  return constants;
}

}  // namespace

AnswerTile answer_tile(const Model& model, std::uint32_t shared_bytes) {
  constexpr std::uint32_t kBlock = 32;  // values of a layer that a thread computes
  const std::uint32_t width = model.config.mlp.width;
  const std::uint32_t bytes_per_point = 4 * (std::max(model.parameters.inputs, width) + 1);
  const auto fits = [&](const AnswerTile& tile) {
    return tile.points * bytes_per_point + 16 * tile.staged_vectors <= shared_bytes;
  };
  AnswerTile tile{.points = std::min(kWorkgroupThreads, kWorkgroupThreads * kBlock / width)};
  while (!fits(tile)) tile.points /= 2;
  const AnswerTile staged{tile.points, static_cast<std::uint32_t>(forward_floats(model) / 4)};
  return fits(staged) ? staged : tile;
}

Answers::Answers(Machine& machine, const Model& model, const FeatureStore& features,
                 const NetworkStore& network)
    : machine_(machine),
      model_(model),
      features_(features),
      network_(network),
      tile_(answer_tile(model, machine.device().limits().shared_bytes)) {
  for (std::size_t i = 0; i < kChunks; ++i) chunks_.emplace_back(machine.device());
}

void Answers::run(Address model, const QueryBatch& batch, const QueryOptions& options, std::span<float> out) {
  abandon();
  const std::size_t chunks = (batch.size + kChunkPoints - 1) / kChunkPoints;
  for (std::size_t k = 0; k < chunks + kChunks; ++k) {
    Submission& chunk = chunks_[k % kChunks];
    if (chunk.under_way) read_results(chunk, (k - kChunks) * kChunkPoints, out);
    if (k < chunks) submit(chunk, model, batch, options, k * kChunkPoints);
  }
}

void Answers::abandon() {
  for (Submission& chunk : chunks_) {
    if (!chunk.under_way) continue;
    chunk.under_way = false;
    wait_for(machine_.device(), chunk.fence);
  }
}

Address Answers::packed_for(const QueryOptions& options, std::optional<PackedFor>& to_pack) const {
  const PackedFor wanted{options.averaged && network_.averages(), options.precision == QueryPrecision::bf16};
  if (wanted == PackedFor{}) return network_.forward();
  if (packed_ != wanted) to_pack = wanted;
  return network_.query_forward();
}

void Answers::submit(Submission& chunk, Address model, const QueryBatch& batch, const QueryOptions& options,
                     std::size_t begin) {
  const Device& device = machine_.device();
  const std::size_t size = std::min(kChunkPoints, batch.size - begin);
  const std::uint64_t answer_bytes = 4 * size * model_.config.mlp.outputs;
  const std::uint64_t bytes = upload_bytes(model_, size, false);
  reserve(device, chunk.staging, bytes, BufferUse::upload);
  reserve(device, chunk.batch, bytes, BufferUse::device);
  reserve(device, chunk.result, answer_bytes, BufferUse::device);
  reserve(device, chunk.readback, answer_bytes, BufferUse::readback);

  std::optional<PackedFor> to_pack;
  BatchBlock block;
  block.read = features_.readable(options.averaged);
  block.answers = chunk.result.address();
  block.forward = packed_for(options, to_pack);
  block.size = block.capacity = static_cast<std::uint32_t>(size);
  block.tiles = (block.size + tile_.points - 1) / tile_.points;
  block.groups = std::min(block.tiles, kMaxGroups);
  write_upload(model_, batch, {}, begin, chunk.batch.address(), block, chunk.staging.mapped());

  Commands commands(chunk.commands.front(), machine_, model, chunk.batch.address());
  commands.copy(chunk.staging, chunk.batch, bytes);
  commands.barrier();
  if (to_pack) {
    commands.dispatch(
        Shader::pack_network, {}, groups_for(model_.parameters.network_count()),
        (to_pack->averaged ? glsl::kPackAveraged : 0u) | (to_pack->rounded ? glsl::kPackRounded : 0u));
    commands.barrier();
  }
  const bool rounded = options.precision == QueryPrecision::bf16;
  commands.dispatch(Shader::answer, answer_constants(model_, tile_, rounded, features_.halves()),
                    block.groups, static_cast<std::uint32_t>(options.range));
  commands.barrier();
  commands.copy(chunk.result, chunk.readback, answer_bytes);
  commands.submit(chunk.fence);
  chunk.under_way = true;
  if (to_pack) packed_ = to_pack;
}

void Answers::read_results(Submission& chunk, std::size_t begin, std::span<float> out) {
  chunk.under_way = false;
  wait_for(machine_.device(), chunk.fence);
  machine_.check();
  const std::size_t outputs = model_.config.mlp.outputs;
  const std::span<float> to =
      out.subspan(begin * outputs, std::min(kChunkPoints * outputs, out.size() - begin * outputs));
  const std::byte* const from = chunk.readback.mapped();
  for_each_range(to.size(), kCopiedFloats, [&](std::size_t first, std::size_t end) {
    std::memcpy(to.data() + first, from + 4 * first, 4 * (end - first));
  });
}

}  // namespace gatelight::neural::vulkan
