#pragma once
// The words that stand for options in files: those of the command line.

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/settings/options.h"

namespace gatelight::renderer {

const char* word(Integrator value);
const char* word(MisHeuristic value);
const char* word(DirectLight value);
const char* word(PixelFilter value);
const char* word(SamplerKind value);
const char* word(LightSelection value);
const char* word(CacheHolds value);
const char* word(QueryAt value);
const char* word(CacheView value);
const char* word(TrainingSource value);
const char* word(neural::FeatureEncoding value);
const char* word(neural::ResolutionRule value);
const char* word(neural::NodeStorage value);
const char* word(neural::Loss value);
const char* word(neural::FeatureUpdate value);
const char* word(neural::FeatureStep value);
const char* word(neural::FeaturePrecision value);
/// Of GateOptions::stack: "adaptive,adaptive/4,1".
std::string stack_text(const std::vector<std::uint32_t>& stack);

}  // namespace gatelight::renderer
