#pragma once
// The words that stand for what a cache can be, in help, parsing and recipes.

#include <optional>
#include <string>
#include <vector>

#include "apps/settings/values.h"
#include "renderer/settings/presets.h"

namespace gatelight::apps {

Choices<renderer::CachePreset> preset_choices();
Choices<renderer::TrainingSource> training_source_choices();
Choices<renderer::CacheHolds> cache_holds_choices();
Choices<renderer::QueryAt> query_at_choices();
Choices<renderer::CacheView> cache_view_choices();
Choices<neural::FeatureEncoding> encoding_choices();
Choices<neural::NodeStorage> storage_choices();
Choices<neural::Loss> loss_choices();
Choices<neural::FeatureUpdate> update_choices();
Choices<neural::FeatureStep> feature_step_choices();
Choices<neural::FeaturePrecision> feature_precision_choices();
Choices<std::uint32_t> hidden_width_choices();
Choices<std::optional<bool>> input_choices();  ///< auto, on, off
Choices<bool> on_off_choices();
Choices<bool> auto_off_choices();
Choices<bool> query_precision_choices();  ///< true: bf16

/// "adaptive,adaptive/4,1": kAdaptive, adaptive_part(4) and 1, at most kMaxStack levels.
std::vector<std::uint32_t> parse_stack(const std::string& flag, const std::string& text);

/// "uniform", "paper" or "fixed:R".
void parse_resolution(const std::string& flag, const std::string& text, neural::GateOptions& gate);
std::string resolution_text(const neural::GateOptions& gate);

/// "cpu", "vulkan" or "vulkan:INDEX|NAME". Answers the text.
std::string parse_device(const std::string& flag, const std::string& text);

}  // namespace gatelight::apps
