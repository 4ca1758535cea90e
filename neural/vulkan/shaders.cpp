#include "neural/vulkan/shaders.h"

namespace gatelight::neural::vulkan {

namespace {

constexpr std::uint32_t kCountTriangles[] = {
#include "count_triangles.inc"
};
constexpr std::uint32_t kEncode[] = {
#include "encode.inc"
};
constexpr std::uint32_t kFinishStep[] = {
#include "finish_step.inc"
};
constexpr std::uint32_t kForward[] = {
#include "forward.inc"
};
constexpr std::uint32_t kLimitFma[] = {
#include "limit_fma.inc"
};
constexpr std::uint32_t kLimitRead[] = {
#include "limit_read.inc"
};
constexpr std::uint32_t kMarkCount[] = {
#include "mark_count.inc"
};
constexpr std::uint32_t kMarkWrite[] = {
#include "mark_write.inc"
};
constexpr std::uint32_t kPackNetwork[] = {
#include "pack_network.inc"
};
constexpr std::uint32_t kScan[] = {
#include "scan.inc"
};
constexpr std::uint32_t kSortCount[] = {
#include "sort_count.inc"
};
constexpr std::uint32_t kSortScatter[] = {
#include "sort_scatter.inc"
};
constexpr std::uint32_t kStartMean[] = {
#include "start_mean.inc"
};
constexpr std::uint32_t kSumPieces[] = {
#include "sum_pieces.inc"
};
constexpr std::uint32_t kTrainNetwork[] = {
#include "train_network.inc"
};
constexpr std::uint32_t kUpdateNetwork[] = {
#include "update_network.inc"
};
constexpr std::uint32_t kUpdateNodes[] = {
#include "update_nodes.inc"
};

}  // namespace

std::span<const std::uint32_t> shader_code(Shader shader) {
  switch (shader) {
    case Shader::count_triangles:
      return kCountTriangles;
    case Shader::encode:
      return kEncode;
    case Shader::finish_step:
      return kFinishStep;
    case Shader::forward:
      return kForward;
    case Shader::limit_fma:
      return kLimitFma;
    case Shader::limit_read:
      return kLimitRead;
    case Shader::mark_count:
      return kMarkCount;
    case Shader::mark_write:
      return kMarkWrite;
    case Shader::pack_network:
      return kPackNetwork;
    case Shader::scan:
      return kScan;
    case Shader::sort_count:
      return kSortCount;
    case Shader::sort_scatter:
      return kSortScatter;
    case Shader::start_mean:
      return kStartMean;
    case Shader::sum_pieces:
      return kSumPieces;
    case Shader::train_network:
      return kTrainNetwork;
    case Shader::update_network:
      return kUpdateNetwork;
    case Shader::update_nodes:
      return kUpdateNodes;
  }
  return {};
}

}  // namespace gatelight::neural::vulkan
