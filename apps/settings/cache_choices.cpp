#include "apps/settings/cache_choices.h"

#include <fmt/format.h>

#include <string_view>

#include "apps/terminal/errors.h"

namespace gatelight::apps {
namespace {

using namespace neural;
using namespace renderer;

constexpr Choice<CachePreset> kPresets[] = {{"preview", CachePreset::preview},
                                            {"final", CachePreset::final},
                                            {"paper-nao", CachePreset::paper_nao},
                                            {"paper-nrc", CachePreset::paper_nrc}};
constexpr Choice<TrainingSource> kSources[] = {{"camera", TrainingSource::camera},
                                               {"surface", TrainingSource::surface}};
constexpr Choice<CacheHolds> kHolds[] = {
    {"all", CacheHolds::all}, {"no-delta", CacheHolds::no_delta}, {"indirect", CacheHolds::indirect}};
constexpr Choice<QueryAt> kQueryAt[] = {{"primary", QueryAt::primary},
                                        {"gather", QueryAt::gather},
                                        {"spread", QueryAt::spread},
                                        {"none", QueryAt::none}};
constexpr Choice<CacheView> kViews[] = {{"final", CacheView::final}, {"cache", CacheView::cache}};
constexpr Choice<FeatureEncoding> kEncodings[] = {{"gate", FeatureEncoding::gate},
                                                  {"hashgrid", FeatureEncoding::hash_grid}};
constexpr Choice<NodeStorage> kStorage[] = {{"shared", NodeStorage::shared},
                                            {"per-triangle", NodeStorage::per_triangle}};
constexpr Choice<Loss> kLosses[] = {{"l2", Loss::l2}, {"relative-l2", Loss::relative_l2}};
constexpr Choice<FeatureUpdate> kUpdates[] = {{"sparse", FeatureUpdate::sparse},
                                              {"dense", FeatureUpdate::dense}};
constexpr Choice<FeatureStep> kFeatureSteps[] = {{"per-node", FeatureStep::per_node},
                                                 {"per-triangle", FeatureStep::per_triangle}};
constexpr Choice<FeaturePrecision> kFeaturePrecisions[] = {{"fp32", FeaturePrecision::fp32},
                                                           {"fp16", FeaturePrecision::fp16_masters},
                                                           {"fp16-only", FeaturePrecision::fp16}};
constexpr Choice<std::uint32_t> kHiddenWidths[] = {{"16", 16}, {"32", 32}, {"64", 64}, {"128", 128}};
constexpr Choice<std::optional<bool>> kInputs[] = {{"auto", std::nullopt}, {"on", true}, {"off", false}};
constexpr Choice<bool> kOnOff[] = {{"on", true}, {"off", false}};
constexpr Choice<bool> kAutoOff[] = {{"auto", true}, {"off", false}};
constexpr Choice<bool> kQueryPrecisions[] = {{"fp32", false}, {"bf16", true}};

constexpr IntegerRange kResolution{1, kMaxResolution};
constexpr IntegerRange kDivisor{1, neural::kMaxAdaptiveDivisor};
constexpr std::string_view kFixed = "fixed:";

}  // namespace

Choices<CachePreset> preset_choices() {
  return kPresets;
}
Choices<TrainingSource> training_source_choices() {
  return kSources;
}
Choices<CacheHolds> cache_holds_choices() {
  return kHolds;
}
Choices<QueryAt> query_at_choices() {
  return kQueryAt;
}
Choices<CacheView> cache_view_choices() {
  return kViews;
}
Choices<FeatureEncoding> encoding_choices() {
  return kEncodings;
}
Choices<NodeStorage> storage_choices() {
  return kStorage;
}
Choices<Loss> loss_choices() {
  return kLosses;
}
Choices<FeatureUpdate> update_choices() {
  return kUpdates;
}
Choices<FeatureStep> feature_step_choices() {
  return kFeatureSteps;
}
Choices<FeaturePrecision> feature_precision_choices() {
  return kFeaturePrecisions;
}
Choices<std::uint32_t> hidden_width_choices() {
  return kHiddenWidths;
}
Choices<std::optional<bool>> input_choices() {
  return kInputs;
}
Choices<bool> on_off_choices() {
  return kOnOff;
}
Choices<bool> auto_off_choices() {
  return kAutoOff;
}
Choices<bool> query_precision_choices() {
  return kQueryPrecisions;
}

std::vector<std::uint32_t> parse_stack(const std::string& flag, const std::string& text) {
  const std::vector<std::string> words = split_list(flag, text);
  if (words.size() > kMaxStack) {
    throw UsageError(
        fmt::format("{}: '{}' has {} levels, expected at most {}", flag, text, words.size(), kMaxStack));
  }
  std::vector<std::uint32_t> stack;
  for (const std::string& word : words) {
    const std::string part = "adaptive/";
    if (word == "adaptive") {
      stack.push_back(kAdaptive);
    } else if (word.starts_with(part)) {
      stack.push_back(neural::adaptive_part(
          static_cast<std::uint32_t>(parse_integer(flag, word.substr(part.size()), kDivisor))));
    } else {
      stack.push_back(static_cast<std::uint32_t>(parse_integer(flag, word, kResolution)));
    }
  }
  return stack;
}

void parse_resolution(const std::string& flag, const std::string& text, GateOptions& gate) {
  if (text == "uniform") {
    gate.rule = ResolutionRule::uniform;
  } else if (text == "paper") {
    gate.rule = ResolutionRule::paper;
  } else if (text.starts_with(kFixed)) {
    gate.fixed_resolution =
        static_cast<std::uint32_t>(parse_integer(flag, text.substr(kFixed.size()), kResolution));
    gate.rule = ResolutionRule::fixed;
  } else {
    refuse_choice(flag, text, "uniform|paper|fixed:R");
  }
}

std::string resolution_text(const GateOptions& gate) {
  switch (gate.rule) {
    case ResolutionRule::uniform:
      return "uniform";
    case ResolutionRule::paper:
      return "paper";
    case ResolutionRule::fixed:
      return fmt::format("{}{}", kFixed, gate.fixed_resolution);
  }
  return "";
}

std::string parse_device(const std::string& flag, const std::string& text) {
  constexpr std::string_view kChosen = "vulkan:";
  const bool chosen = text.starts_with(kChosen) && text.size() > kChosen.size();
  if (text != "cpu" && text != "vulkan" && !chosen)
    refuse_choice(flag, text, "cpu|vulkan|vulkan:INDEX|vulkan:NAME");
  return text;
}

}  // namespace gatelight::apps
