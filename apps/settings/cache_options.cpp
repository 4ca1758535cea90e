#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "apps/settings/picture_options.h"
#include "base/errors.h"

// Structured bindings name every member, as in picture_options.cpp.

namespace gatelight::apps {
namespace {

using namespace renderer;

using neural::FeatureEncoding;

constexpr RealRange kFraction{0.0, 1.0};
constexpr IntegerRange kSteps{0, std::numeric_limits<int>::max()};
constexpr IntegerRange kPaths{1, 65536};
constexpr IntegerRange kFeatures{1, 16};
constexpr IntegerRange kResolution{1, neural::kMaxResolution};
constexpr IntegerRange kDivisor{1, neural::kMaxAdaptiveDivisor};

constexpr Choice<std::uint32_t> kHiddenWidths[] = {{"16", 16}, {"32", 32}, {"64", 64}, {"128", 128}};
constexpr Choice<std::optional<bool>> kInputs[] = {{"auto", std::nullopt}, {"on", true}, {"off", false}};
constexpr Choice<bool> kAutoOff[] = {{"auto", true}, {"off", false}};
constexpr Choice<bool> kPrecisions[] = {{"fp32", false}, {"bf16", true}};

bool is_nrc(const RenderOptions& o) {
  return o.integrator == Integrator::nrc;
}
bool is_gate(const RenderOptions& o) {
  return o.cache.encoding == FeatureEncoding::gate;
}
constexpr Requirement kNrc{is_nrc, "`integrator` nrc"};
constexpr Requirement kGate{is_gate, "`encoding` gate"};
constexpr Requirement kHashGrid{[](const RenderOptions& o) { return !is_gate(o); }, "`encoding` hashgrid"};
constexpr Requirement kNrcOrHashGrid{[](const RenderOptions& o) { return is_nrc(o) || !is_gate(o); },
                                     "`integrator` nrc or `encoding` hashgrid"};
constexpr Requirement kSelfTraining{
    [](const RenderOptions& o) { return o.cache.self_training.start_step >= 0; }, "`self-training` STEP"};
constexpr Requirement kSpread{[](const RenderOptions& o) { return o.cache.query_at == QueryAt::spread; },
                              "`query-at` spread"};
/// The view of the cache is at the first vertex, or its reference.
constexpr Requirement kFinalView{[](const RenderOptions& o) {
                                   return o.cache.view == CacheOutput::final ||
                                          o.cache.query_at == QueryAt::primary ||
                                          o.cache.query_at == QueryAt::none;
                                 },
                                 "`view` final"};
constexpr Requirement kPicturePoints{
    [](const RenderOptions& o) { return o.cache.source == TrainingSource::picture; },
    "`training-points` picture"};
constexpr Requirement kTriangles{[](const RenderOptions& o) { return is_gate(o) || o.cache.candidates == 1; },
                                 "`encoding` gate"};
constexpr Requirement kPaperRule{
    [](const RenderOptions& o) { return o.cache.gate.rule == neural::ResolutionRule::paper; },
    "`resolution` paper"};
constexpr Requirement kUniformRule{
    [](const RenderOptions& o) { return o.cache.gate.rule == neural::ResolutionRule::uniform; },
    "`resolution` uniform"};

/// "adaptive,adaptive/4,1": kAdaptive, adaptive_part(4) and 1.
std::vector<std::uint32_t> read_stack(const std::string& option, const std::string& text) {
  const std::string part = "adaptive/";
  const std::vector<std::string> words = split_list(option, text);
  if (words.size() > neural::kMaxStack) {
    throw BadOption({option, text, fmt::format("has {} levels", words.size()),
                     fmt::format("at most {}", neural::kMaxStack)});
  }
  const auto number = [&](const std::string& word, const IntegerRange& range) {
    return static_cast<std::uint32_t>(parse_integer(option, word, range));
  };
  std::vector<std::uint32_t> stack;
  for (const std::string& word : words) {
    if (word == "adaptive") {
      stack.push_back(neural::kAdaptive);
    } else if (word.starts_with(part)) {
      stack.push_back(neural::adaptive_part(number(word.substr(part.size()), kDivisor)));
    } else {
      stack.push_back(number(word, kResolution));
    }
  }
  return stack;
}

constexpr std::string_view kFixed = "fixed:";

OptionValue resolution_value(const neural::GateOptions& gate) {
  const bool fixed = gate.rule == neural::ResolutionRule::fixed;
  return fixed ? fmt::format("{}{}", kFixed, gate.fixed_resolution) : enum_name(gate.rule);
}

void read_resolution(neural::GateOptions& gate, const std::string& option, const std::string& text) {
  if (text.starts_with(kFixed)) {
    gate.fixed_resolution =
        static_cast<std::uint32_t>(parse_integer(option, text.substr(kFixed.size()), kResolution));
    gate.rule = neural::ResolutionRule::fixed;
  } else if (text == "uniform" || text == "paper") {
    gate.rule = parse_choice(option, text, kEnumNames<neural::ResolutionRule>);
  } else if (!text.empty() && text.find_first_not_of("0123456789x") == std::string::npos) {
    throw BadOption({option, text, "is not a resolution of a cache",
                     "uniform, paper or fixed:R; the size of the picture is `size` WxH"});
  } else {
    refuse_choice(option, text, "uniform|paper|fixed:R");
  }
}

Option device_option(std::string& device, bool& choose) {
  constexpr const char* kAuto = "auto";
  const auto value = [&]() -> OptionValue { return choose ? kAuto : device; };
  const auto read = [&](const std::string& text) {
    constexpr std::string_view kNamed = "vulkan:";
    const bool named = text.starts_with(kNamed) && text.size() > kNamed.size();
    if (text != kAuto && text != "cpu" && text != "vulkan" && !named)
      refuse_choice("device", text, "auto|cpu|vulkan|vulkan:INDEX|vulkan:NAME");
    choose = text == kAuto;
    device = choose ? "cpu" : text;
  };
  return {.name = "device",
          .unit = "auto|cpu|vulkan[:INDEX|NAME]",
          .help =
              "Device that trains and evaluates the cache; auto (default of presets): a graphics device if "
              "some steps are faster there",
          .value = value,
          .read = read};
}

int read_start_step(const std::string& option, const std::string& text) {
  return text == "off" ? -1 : static_cast<int>(parse_integer(option, text, kSteps));
}

void add_self_training_options(OptionGroup& group, SelfTrainingOptions& options) {
  auto& [start_step, vertices, full_fraction, attenuation] = options;
  group.add(read_by(
                "self-training", start_step, "STEP|off",
                "First step whose training paths end with an answer of the cache itself; off: all paths are "
                "traced to their end",
                [](int step) { return step < 0 ? OptionValue("off") : value_of(step); }, read_start_step),
            {.needs = {kNrc}});
  group.add(number("self-training-vertices", vertices, kPaths, "N",
                   "Vertices that become records before the cache answers for the rest of the path"),
            {.needs = {kNrc, kSelfTraining}});
  group.add(number("self-training-full", full_fraction, kFraction, "FRACTION",
                   "Share of the training paths that are still traced to their end, 0 to 1"),
            {.needs = {kNrc, kSelfTraining}});
  group.add(number("self-training-attenuation", attenuation, kFraction, "FACTOR",
                   "Factor of the cache's answer at the end of a training path, 0 to 1"),
            {.needs = {kNrc, kSelfTraining}});
}

/// Two of its flags are in another group.
void add_training_options(OptionGroup& group, neural::TrainingOptions& options) {
  auto& [loss, adam, update, feature_step, precision, average, start_at_mean, max_target, count_triangles,
         seed] = options;
  auto& [learning_rate, beta1, beta2, epsilon, l2_network, decay_steps] = adam;
  auto& [average_network, average_features, average_decay, average_ramp] = average;
  const auto add = [&](Option option, std::vector<Requirement> needs = {}) -> Option& {
    return group.add(std::move(option), {.of_field = true, .needs = std::move(needs)});
  };
  add(number("learning-rate", learning_rate, kNotNegative, "X", "Size of a training step (of Adam)"));
  add(number("learning-decay", decay_steps, kNotNegative, "STEPS",
             "The learning rate falls with 1/sqrt(1 + step/STEPS); 0: it is constant"));
  add(choice("loss", loss, "Squared error, absolute or relative to the squared luminance of the answer"));
  add(choice("update", update,
             "Feature vectors that a step changes: those that its records read (sparse), or all (dense)"));
  add(choice("feature-step", feature_step,
             "Step count of a feature vector (for Adam): counted for each vector, or for each triangle as in "
             "the paper"),
      {kGate});
  Option& averaged =
      add(choice("average", average_network, kOnOff,
                 "Answer with running averages of features and weights instead of the latest values"));
  averaged.read = [&options = average, read = averaged.read](const std::string& text) {
    read(text);
    options.features = options.network;
  };
}

void add_learning_options(std::vector<Option>& table, CacheOptions& options) {
  OptionGroup group{table, "Cache, learning"};
  group.add(number_or("auto", "train-steps", options.train_steps, kSteps, "N",
                      "Training steps before rendering; auto: from pixels and samples; 0: none"),
            {.common = true});
  group.add(number("train-time", options.train_seconds, kNotNegative, "SECONDS",
                   "Start no further training step after this time; 0: no limit"),
            {.in_sweep = false});
  group.add(number("batch", options.batch, {1, 1 << 24}, "N",
                   "Records (surface points with their light) in a training step"),
            {.of_field = true});
  group.add(number("train-path-length", options.path_length, {0, 65536}, "N",
                   "0: only Russian roulette ends a training path, and each vertex becomes a record; N: a "
                   "path has N segments, and only its first vertex becomes a record, as in the paper"),
            {.needs = {kNrc}});
  group.add(number("samples-per-point", options.samples_per_point, kPaths, "N",
                   "Number of paths that are averaged for the record of a training point"));
  group.add(choice("training-points", options.source,
                   "Training paths are samples that stay in the picture (picture), or start at hits of "
                   "camera rays (camera) or anywhere on the surfaces (surface)"));
  group.add(number("samples-from-step", options.samples_from_step, kSteps, "N",
                   "First training step whose paths stay in the picture as samples; they end with answers of "
                   "the cache at that step"),
            {.needs = {kPicturePoints}});
  group.add(number("candidates", options.candidates, {1, 1024}, "M",
                   "Candidates for each training point; more candidates train triangles more evenly"),
            {.needs = {kTriangles}});
  add_self_training_options(group, options.self_training);
  add_training_options(group, options.training);
}

void add_gate_options(OptionGroup& group, neural::GateOptions& options, std::optional<float>& spacing) {
  auto& [features, stack, rule, node_spacing, resolution_scale, fixed_resolution, max_resolution, storage,
         cluster, memory_budget, budget_is_cap, bytes_per_feature] = options;
  const auto add = [&](Option option, std::vector<Requirement> needs = {kGate}) {
    group.add(std::move(option), {.of_field = true, .needs = std::move(needs)});
  };
  add(number("features", features, kFeatures, "L", "gate: length of a feature vector"));
  add(read_by("stack", stack, "LIST",
              "gate: resolutions of the levels, separated by commas, at most 4; 'adaptive' is the result of "
              "--resolution, 'adaptive/4' a quarter of it",
              neural::stack_text, read_stack));
  add(read_by("resolution", options, "uniform|paper|fixed:R",
              "gate: number of feature vectors along a triangle's edge, for each instance: from "
              "--node-spacing, by the paper's rule, or R everywhere",
              resolution_value, read_resolution));
  add(number("resolution-scale", resolution_scale, kPositive, "X", "gate: factor in the paper's rule"),
      {kGate, kPaperRule});
  add(number_or("auto", "node-spacing", spacing, kPositive, "METRES",
                "gate: distance between feature vectors; auto: from the width of pixels on the surfaces"),
      {kGate, kUniformRule});
  add(number("max-resolution", max_resolution, kResolution, "R", "gate: largest adaptive resolution"));
  add(choice("cluster", cluster, kAutoOff,
             "gate: share feature vectors where triangles are smaller than the node spacing"));
  add(choice("storage", storage,
             "gate: triangles share the feature vectors on common edges and corners, or have their own"));
}

void add_hash_grid_options(OptionGroup& group, neural::HashGridOptions& options) {
  auto& [levels, features, base_resolution, growth, log2_table_size, memory_target, bytes_per_feature,
         bounds_min, bounds_max] = options;
  const auto add = [&](Option option) {
    group.add(std::move(option), {.of_field = true, .needs = {kHashGrid}});
  };
  add(number("hash-levels", levels, {1, neural::kMaxHashLevels}, "N", "hashgrid: levels"));
  add(number("hash-features", features, kFeatures, "N", "hashgrid: numbers in an entry"));
  add(number("hash-log2-size", log2_table_size, {3, 31}, "N",
             "hashgrid: a level has at most 2^N entries; --cache-memory overrides it"));
  add(number("hash-base", base_resolution, {1, 1 << 20}, "N", "hashgrid: resolution of the first level"));
  add(number("hash-growth", growth, {1.0, 1024.0}, "X",
             "hashgrid: ratio of the resolutions of successive levels"));
}

void add_shape_options(std::vector<Option>& table, CacheOptions& options) {
  auto& [width, hidden_layers, outputs, leaky_slope, biases] = options.mlp;
  OptionGroup group{table, "Cache, model"};
  const auto add = [&](Option option) { group.add(std::move(option), {.of_field = true}); };
  add(choice("encoding", options.encoding,
             // The first encodes nothing.
             Choices<FeatureEncoding>(kEnumNames<FeatureEncoding>).subspan(1),
             "Location of the features: on the triangles, or in a hash grid in space"));
  add_gate_options(group, options.gate, options.node_spacing);
  add_hash_grid_options(group, options.hash_grid);
  add(read_by(
      "cache-memory", options.memory_bytes, "MIB",
      "Memory limit of the features in MiB; within it, they are as fine as possible; 0: no limit",
      [](std::uint64_t bytes) { return static_cast<double>(bytes) / 1048576.0; },
      [](const std::string& option, const std::string& text) {
        const double bytes = parse_real(option, text, {0.0, 1099511627776.0}) * 1048576.0;
        return static_cast<std::uint64_t>(std::ceil(bytes));
      }));
  add(choice("feature-precision", options.training.precision,
             "fp16: queries read features of 16 bits, training changes copies of 32 bits; fp16-only: 16 bits "
             "in training too, for half the memory"));
  add(choice("hidden", width, kHiddenWidths, "Width of the network's hidden layers"));
  add(number("layers", hidden_layers, {1, neural::kMaxLayers - 1}, "N", "Hidden layers of the network"));
  add(choice("bias", biases, kOnOff, "Whether the network's layers have biases"));
  group.add(choice("direction-input", options.direction_input, kInputs,
                   "Whether the network reads the view direction; auto: if a material of the scene depends "
                   "on it and --cache-roughness is below 0.5"),
            {.needs = {kNrc}});
  add(choice("normal-input", options.normal_input, kInputs,
             "Whether the network reads the normal; auto: yes, but not for gate with --resolution paper, as "
             "in the paper"));
  group.add(choice("albedo-input", options.albedo_input, kInputs,
                   "Whether the network reads the albedo; auto: only with the hash grid"),
            {.needs = {kNrcOrHashGrid}});
  group.add(
      choice("scout", options.scout, kOnOff,
             "Trace some paths first, and store features only for the sides of instances that they hit"));
}

void add_answer_options(std::vector<Option>& table, CacheOptions& options) {
  OptionGroup group{table, "Cache, answers"};
  group.add(choice("cache-holds", options.component,
                   "Reflected light that the cache stores: all; all except direct light of point, spot and "
                   "directional lights; or indirect light only"),
            {.needs = {kNrc}});
  group.add(choice("query-at", options.query_at,
                   "Where a path ends with the cache's answer: at the first hit (fast), at the hit after a "
                   "wide scattering event (accurate), once the path has spread out, or nowhere"),
            {.needs = {kNrc, kFinalView}});
  group.add(
      choice("view", options.view,
             "final: the picture; cache: only the answer at the first hit, without emission and reflectance"),
      {.needs = {kNrc}});
  group.add(
      number("cache-roughness", options.min_roughness, kFraction, "X",
             "Reflections of at least this roughness come from the cache; sharper ones are traced; 0 to 1"),
      {.needs = {kNrc}});
  group.add(number("spread-threshold", options.spread_threshold, kNotNegative, "X",
                   "For --query-at spread: ratio of the path's spread to that of its first segment; paths "
                   "end later with a larger ratio"),
            {.needs = {kNrc, kSpread}});
  group.add(choice("query-precision", options.bf16_queries, kPrecisions,
                   "Arithmetic of answers in the picture; bf16 is faster if the processor supports it"),
            {.of_field = true});
  group.add(device_option(options.device, options.choose_device), {.of_field = true});
}

}  // namespace

void add_cache_options(std::vector<Option>& table, CacheOptions& options) {
  [[maybe_unused]] const auto& [train_steps, train_seconds, batch, path_length, samples_per_point, source,
                                samples_from_step, candidates, self_training, node_spacing, encoding, gate,
                                hash_grid, memory_bytes, mlp, training, direction_input, normal_input,
                                albedo_input, scout, component, query_at, view, min_roughness,
                                spread_threshold, bf16_queries, device, choose_device, cache_in, cache_out] =
      options;
  const std::size_t others = table.size();
  add_learning_options(table, options);
  add_shape_options(table, options);
  add_answer_options(table, options);
  for (std::size_t i = others; i < table.size(); ++i) table[i].marks.of_cache = true;
}

void add_cache_file_options(std::vector<Option>& table, CacheOptions& options) {
  OptionGroup files{table, "Files"};
  files.add(any_word("cache-in", options.cache_in, "FILE",
                     "Start from a cache that --cache-out wrote for the same scene and cache flags"),
            {.common = true, .in_sweep = false, .of_cache = true});
  files.add(
      any_word("cache-out", options.cache_out, "FILE", "Write the trained cache to a .safetensors file"),
      {.common = true, .in_sweep = false, .of_cache = true, .in_recipe = InRecipe::unless_reproducible});
}

}  // namespace gatelight::apps
