#include "renderer/settings/option_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "neural/model/model_description.h"

namespace gatelight::renderer {

const char* word(Integrator value) {
  switch (value) {
    case Integrator::path:
      return "path";
    case Integrator::ao:
      return "ao";
    case Integrator::nao:
      return "nao";
    case Integrator::nrc:
      return "nrc";
  }
  return "";
}

const char* word(MisHeuristic value) {
  switch (value) {
    case MisHeuristic::balance:
      return "balance";
    case MisHeuristic::power:
      return "power";
  }
  return "";
}

const char* word(DirectLight value) {
  switch (value) {
    case DirectLight::mis:
      return "mis";
    case DirectLight::nee:
      return "nee";
    case DirectLight::bsdf:
      return "bsdf";
  }
  return "";
}

const char* word(PixelFilter value) {
  switch (value) {
    case PixelFilter::box:
      return "box";
    case PixelFilter::tent:
      return "tent";
    case PixelFilter::gaussian:
      return "gaussian";
    case PixelFilter::blackman_harris:
      return "blackman-harris";
  }
  return "";
}

const char* word(SamplerKind value) {
  switch (value) {
    case SamplerKind::sobol:
      return "sobol";
    case SamplerKind::independent:
      return "independent";
  }
  return "";
}

const char* word(LightSelection value) {
  switch (value) {
    case LightSelection::tree:
      return "tree";
    case LightSelection::power:
      return "power";
  }
  return "";
}

const char* word(CacheHolds value) {
  switch (value) {
    case CacheHolds::all:
      return "all";
    case CacheHolds::no_delta:
      return "no-delta";
    case CacheHolds::indirect:
      return "indirect";
  }
  return "";
}

const char* word(QueryAt value) {
  switch (value) {
    case QueryAt::primary:
      return "primary";
    case QueryAt::gather:
      return "gather";
    case QueryAt::spread:
      return "spread";
    case QueryAt::none:
      return "none";
  }
  return "";
}

const char* word(CacheView value) {
  switch (value) {
    case CacheView::final:
      return "final";
    case CacheView::cache:
      return "cache";
  }
  return "";
}

const char* word(TrainingSource value) {
  switch (value) {
    case TrainingSource::camera:
      return "camera";
    case TrainingSource::surface:
      return "surface";
  }
  return "";
}

const char* word(neural::FeatureEncoding value) {
  switch (value) {
    case neural::FeatureEncoding::none:
      return "none";
    case neural::FeatureEncoding::gate:
      return "gate";
    case neural::FeatureEncoding::hash_grid:
      return "hashgrid";
  }
  return "";
}

const char* word(neural::ResolutionRule value) {
  switch (value) {
    case neural::ResolutionRule::uniform:
      return "uniform";
    case neural::ResolutionRule::paper:
      return "paper";
    case neural::ResolutionRule::fixed:
      return "fixed";
  }
  return "";
}

const char* word(neural::NodeStorage value) {
  switch (value) {
    case neural::NodeStorage::shared:
      return "shared";
    case neural::NodeStorage::per_triangle:
      return "per-triangle";
  }
  return "";
}

const char* word(neural::Loss value) {
  switch (value) {
    case neural::Loss::l2:
      return "l2";
    case neural::Loss::relative_l2:
      return "relative-l2";
  }
  return "";
}

const char* word(neural::FeatureUpdate value) {
  switch (value) {
    case neural::FeatureUpdate::sparse:
      return "sparse";
    case neural::FeatureUpdate::dense:
      return "dense";
  }
  return "";
}

const char* word(neural::FeatureStep value) {
  switch (value) {
    case neural::FeatureStep::per_node:
      return "per-node";
    case neural::FeatureStep::per_triangle:
      return "per-triangle";
  }
  return "";
}

const char* word(neural::FeaturePrecision value) {
  switch (value) {
    case neural::FeaturePrecision::fp32:
      return "fp32";
    case neural::FeaturePrecision::fp16_masters:
      return "fp16";
    case neural::FeaturePrecision::fp16:
      return "fp16-only";
  }
  return "";
}

std::string stack_text(const std::vector<std::uint32_t>& stack) {
  std::vector<std::string> levels;
  levels.reserve(stack.size());
  for (const std::uint32_t level : stack) levels.push_back(neural::level_text(level));
  return fmt::format("{}", fmt::join(levels, ","));
}

}  // namespace gatelight::renderer
