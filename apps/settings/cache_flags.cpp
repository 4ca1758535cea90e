#include "apps/settings/cache_flags.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "apps/settings/cache_choices.h"
#include "apps/settings/flags.h"
#include "apps/settings/render_settings.h"
#include "renderer/settings/option_words.h"

namespace gatelight::apps {
namespace {

using neural::GateOptions;
using neural::HashGridOptions;
using renderer::CacheOptions;

constexpr RealRange kNotNegative{0.0, 3.4e38};
constexpr RealRange kFraction{0.0, 1.0};
constexpr RealRange kGrowth{1.0, 1024.0};
constexpr RealRange kMebibytes{0.0, 1099511627776.0};
constexpr IntegerRange kSteps{0, std::numeric_limits<int>::max()};
constexpr IntegerRange kRecords{1, 1 << 24};
constexpr IntegerRange kEvents{0, 65536};
constexpr IntegerRange kPaths{1, 65536};
constexpr IntegerRange kCandidates{1, 1024};
constexpr IntegerRange kFeatures{1, 16};
constexpr IntegerRange kResolution{1, neural::kMaxResolution};
constexpr IntegerRange kHashLevels{1, neural::kMaxHashLevels};
constexpr IntegerRange kHashLog2Size{3, 31};
constexpr IntegerRange kHashBase{1, 1 << 20};
constexpr IntegerRange kLayers{1, neural::kMaxLayers - 1};

/// With its value as the default in the help.
template <typename Real>
CLI::Option* add_number(CLI::App& app, const std::string& flag, Real& value, const RealRange& range,
                        const std::string& unit, const std::string& help) {
  return add_real(app, flag, value, range, unit, help, fmt::format("{}", value));
}

/// A number, or a word that stands for none.
template <typename Read>
CLI::Option* add_word_or(CLI::App& app, const std::string& flag, const std::string& unit,
                         const std::string& help, const std::string& default_text, const std::string& word,
                         Read read) {
  return add_word(app, flag, unit + "|" + word, help, default_text, [word, read](const std::string& text) {
    read(text == word ? std::nullopt : std::optional<std::string>(text));
  });
}

void add_self_training_flags(CLI::App& app, renderer::SelfTrainingOptions& o, const std::string& group) {
  add_word_or(app, "--self-training", "STEP",
              "From this step on training paths end in the cache's own answer; off: all run to their end",
              std::to_string(o.start_step), "off",
              [&o](const std::optional<std::string>& text) {
                o.start_step = text ? static_cast<int>(parse_integer("--self-training", *text, kSteps)) : -1;
              })
      ->group(group);
  add_integer(app, "--self-training-vertices", o.vertices, kPaths, "N",
              "Vertices that become records before the cache answers for the rest of the path")
      ->group(group);
  add_number(app, "--self-training-full", o.full_fraction, kFraction, "FRACTION",
             "Part of the training paths that run to their end all the same, 0 to 1")
      ->group(group);
  add_number(app, "--self-training-attenuation", o.attenuation, kFraction, "FACTOR",
             "Multiplies the cache's answer at the end of a training path, 0 to 1")
      ->group(group);
}

void add_learning_flags(CLI::App& app, CacheOptions& o) {
  const std::string group = "Cache, learning";
  add_word_or(app, "--train-steps", "N",
              "Training steps before the picture; auto: by its pixels and samples; 0: none", "auto", "auto",
              [&o](const std::optional<std::string>& text) {
                o.train_steps.reset();
                if (text) o.train_steps = static_cast<int>(parse_integer("--train-steps", *text, kSteps));
              })
      ->group(group);
  add_number(app, "--train-time", o.train_seconds, kNotNegative, "SECONDS",
             "No further step after this time of training; 0: no limit")
      ->group(group);
  add_integer(app, "--batch", o.batch, kRecords, "N",
              "Records (points with their light) that a step learns from")
      ->group(group);
  add_integer(
      app, "--train-path-length", o.path_length, kEvents, "N",
      "0: Russian roulette alone ends a training path, and each vertex becomes a record; N: paths of N "
      "segments, and only the first vertex does, as in the paper")
      ->group(group);
  add_integer(app, "--samples-per-point", o.samples_per_point, kPaths, "N",
              "Paths whose mean becomes the record of a training point")
      ->group(group);
  add_choice(app, "--training-points", o.source, training_source_choices(),
             "Where training paths start: at what the camera sees, or anywhere on the surfaces")
      ->group(group);
  add_integer(app, "--candidates", o.candidates, kCandidates, "M",
              "Points to choose a training point from; the more, the more even are the triangles trained")
      ->group(group);
  add_self_training_flags(app, o.self_training, group);
  add_number(app, "--learning-rate", o.training.adam.learning_rate, kNotNegative, "X",
             "Size of a training step (of Adam)")
      ->group(group);
  add_number(app, "--learning-decay", o.training.adam.decay_steps, kNotNegative, "STEPS",
             "The learning rate falls with 1/sqrt(1 + step/STEPS); 0: it stays")
      ->group(group);
  add_choice(app, "--loss", o.training.loss, loss_choices(),
             "Squared error, as it is or relative to the squared luminance of the answer")
      ->group(group);
  add_choice(app, "--update", o.training.update, update_choices(),
             "Which feature vectors a step changes: those that its records touch, or all")
      ->group(group);
  add_choice(app, "--feature-step", o.training.feature_step, feature_step_choices(),
             "What counts the steps of a feature vector (for Adam): itself, or its triangles as in the paper")
      ->group(group);
  add_word(app, "--average", choice_names(on_off_choices()),
           "Answer with a running average of features and weights instead of the last ones",
           name_of(on_off_choices(), o.training.average.network),
           [&average = o.training.average](const std::string& text) {
             average.network = average.features = parse_choice("--average", text, on_off_choices());
           })
      ->group(group);
}

void add_gate_flags(CLI::App& app, CacheOptions& o, const std::string& group) {
  GateOptions& gate = o.gate;
  add_integer(app, "--features", gate.features, kFeatures, "L", "gate: numbers in a feature vector")
      ->group(group);
  add_word(app, "--stack", "LIST",
           "gate: resolutions of the levels, separated by commas, at most 4; 'adaptive' is what --resolution "
           "finds, 'adaptive/4' a fourth of it",
           renderer::stack_text(gate.stack),
           [&gate](const std::string& text) { gate.stack = parse_stack("--stack", text); })
      ->group(group);
  add_word(
      app, "--resolution", "uniform|paper|fixed:R",
      "gate: feature vectors along a triangle's edge, for each instance: by --node-spacing, by the paper's "
      "rule, or R everywhere",
      resolution_text(gate),
      [&gate](const std::string& text) { parse_resolution("--resolution", text, gate); })
      ->group(group);
  add_number(app, "--resolution-scale", gate.resolution_scale, kPositive, "X",
             "gate: factor of the paper's rule")
      ->group(group);
  add_word_or(app, "--node-spacing", "METRES",
              "gate: distance between feature vectors; auto: by the size of what paths meet", "auto", "auto",
              [&o](const std::optional<std::string>& text) {
                o.node_spacing.reset();
                if (text) o.node_spacing = parse_float("--node-spacing", *text, kPositive);
              })
      ->group(group);
  add_integer(app, "--max-resolution", gate.max_resolution, kResolution, "R",
              "gate: largest adaptive resolution")
      ->group(group);
  add_choice(app, "--cluster", gate.cluster, auto_off_choices(),
             "gate: share feature vectors where triangles are smaller than the node spacing")
      ->group(group);
  add_choice(app, "--storage", gate.storage, storage_choices(),
             "gate: feature vectors on common edges and corners are shared by the triangles, or not")
      ->group(group);
}

void add_hash_flags(CLI::App& app, HashGridOptions& hash, const std::string& group) {
  add_integer(app, "--hash-levels", hash.levels, kHashLevels, "N", "hashgrid: levels")->group(group);
  add_integer(app, "--hash-features", hash.features, kFeatures, "N", "hashgrid: numbers in an entry")
      ->group(group);
  add_integer(app, "--hash-log2-size", hash.log2_table_size, kHashLog2Size, "N",
              "hashgrid: a level has at most 2^N entries; --cache-memory overrides it")
      ->group(group);
  add_integer(app, "--hash-base", hash.base_resolution, kHashBase, "N",
              "hashgrid: resolution of the first level")
      ->group(group);
  add_number(app, "--hash-growth", hash.growth, kGrowth, "X",
             "hashgrid: factor of the resolution from level to level")
      ->group(group);
}

void add_shape_flags(CLI::App& app, CacheOptions& o) {
  const std::string group = "Cache, what it is";
  add_choice(app, "--encoding", o.encoding, encoding_choices(),
             "Where features lie: on the triangles, or in a hash grid in space")
      ->group(group);
  add_gate_flags(app, o, group);
  add_hash_flags(app, o.hash_grid, group);
  add_word(app, "--cache-memory", "MIB",
           "Features take at most so much, in MiB, and are as fine as fits; 0: no limit", "0",
           [&o](const std::string& text) {
             const double bytes = parse_real("--cache-memory", text, kMebibytes) * 1048576.0;
             o.memory_bytes = static_cast<std::uint64_t>(std::ceil(bytes));
           })
      ->group(group);
  add_choice(
      app, "--feature-precision", o.training.precision, feature_precision_choices(),
      "fp16: features are read as 16 bits but trained as 32; fp16-only: half the memory in training too")
      ->group(group);
  add_choice(app, "--hidden", o.mlp.width, hidden_width_choices(), "Width of the network's hidden layers")
      ->group(group);
  add_integer(app, "--layers", o.mlp.hidden_layers, kLayers, "N", "Hidden layers of the network")
      ->group(group);
  add_choice(app, "--bias", o.mlp.biases, on_off_choices(), "Whether the network's layers have biases")
      ->group(group);
  add_choice(app, "--direction-input", o.direction_input, input_choices(),
             "The network reads the direction of view; auto: where a material of the scene depends on it and "
             "--cache-roughness is below 0.5")
      ->group(group);
  add_choice(app, "--normal-input", o.normal_input, input_choices(),
             "The network reads the normal; auto: yes, but as in the paper where gate has --resolution paper")
      ->group(group);
  add_choice(app, "--albedo-input", o.albedo_input, input_choices(),
             "The network reads the albedo; auto: with the hash grid")
      ->group(group);
  add_choice(app, "--scout", o.scout, on_off_choices(),
             "Trace some paths first and keep features only for the sides of instances that they meet")
      ->group(group);
}

void add_answer_flags(CLI::App& app, CacheOptions& o) {
  const std::string group = "Cache, answers";
  add_choice(
      app, "--cache-holds", o.holds, cache_holds_choices(),
      "Reflected light that the cache stands for: all, all but what comes straight from point, spot and "
      "directional lights, or what has been scattered once more")
      ->group(group);
  add_choice(
      app, "--query-at", o.query_at, query_at_choices(),
      "Where a path ends in the cache's answer: first hit (fast), next hit after a wide scattering event "
      "(accurate), where the path has spread out, or nowhere")
      ->group(group);
  add_choice(app, "--view", o.view, cache_view_choices(),
             "final: the picture; cache: the bare answer at the first hit, without emission and reflectance")
      ->group(group);
  add_number(app, "--cache-roughness", o.min_roughness, kFraction, "X",
             "Reflections at least this rough come from the cache, sharper ones are traced, 0 to 1")
      ->group(group);
  add_number(app, "--spread-threshold", o.spread_threshold, kNotNegative, "X",
             "For --query-at spread: spread of the path over that of its first segment; more is later")
      ->group(group);
  add_choice(app, "--query-precision", o.bf16_queries, query_precision_choices(),
             "Arithmetic of answers in the picture; bf16 is faster where the processor has it")
      ->group(group);
  add_word(app, "--device", "cpu|vulkan[:INDEX|NAME]", "What trains and answers", o.device,
           [&o](const std::string& text) { o.device = parse_device("--device", text); })
      ->group(group);
}

}  // namespace

void add_cache_flags(CLI::App& app, RenderSettings& settings) {
  const std::size_t others = app.get_options().size();
  add_learning_flags(app, settings.render.cache);
  add_shape_flags(app, settings.render.cache);
  add_answer_flags(app, settings.render.cache);
  const std::vector<CLI::Option*> options = app.get_options();
  for (std::size_t i = others; i < options.size(); ++i) settings.cache_flags.insert(options[i]->get_name());
}

void add_cache_file_flags(CLI::App& app, RenderSettings& settings) {
  const std::string group = "Files";
  app.add_option("--cache-in", settings.render.cache.cache_in,
                 "Start from a cache that --cache-out wrote, of the same scene and cache flags")
      ->type_name("FILE")
      ->group(group);
  app.add_option("--cache-out", settings.render.cache.cache_out, "Write the trained cache (safetensors)")
      ->type_name("FILE")
      ->group(group);
  settings.cache_flags.insert({"--cache-in", "--cache-out"});
}

void add_preset_flag(CLI::App& app, RenderSettings& settings) {
  add_word(app, "--preset", choice_names(preset_choices()),
           "Values for many flags at once; flags beside it win: nrc in seconds, nrc with a final gather, "
           "or the paper's nao and nrc (with its size and samples)",
           "",
           [&settings](const std::string& text) {
             settings.preset = parse_choice("--preset", text, preset_choices());
           })
      ->group("Light transport");
  settings.cache_flags.insert("--preset");
}

void finish_flags(CLI::App& app, RenderSettings& settings) {
  if (settings.preset) renderer::apply_preset(*settings.preset, settings.render);
  for (CLI::Option* option : app.get_options()) {
    if (option->count() == 0) continue;
    // They were read once already, in an order of the library's own: before the preset.
    if (settings.preset) option->run_callback();
    settings.given.insert(option->get_name());
  }
  const CLI::Option* config = app.get_parent() ? app.get_parent()->get_config_ptr() : nullptr;
  if (config != nullptr && config->count() > 0) settings.config = config->as<std::string>();
}

}  // namespace gatelight::apps
