#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <set>

#include "apps/settings/flags.h"
#include "apps/settings/option_table.h"
#include "apps/subcommand.h"
#include "apps/sweep/presets.h"
#include "apps/sweep/request.h"
#include "apps/sweep/sweep_run.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"

namespace gatelight::apps {
namespace {

constexpr const char* kSweepFooter =
    R"(A sweep renders all combinations of the listed values and compares them with a reference. A combination is a line in the
plots, and each of its step counts is a cell with one picture. One training run gives the pictures of all step counts.
For each integrator with a cache, the integrator without one is measured too (path for nrc, ao for nao). Any other flag
of 'gatelight render' that affects the picture can be given and applies to all cells (--size, --camera, --batch, ...;
see its --help). Flags without effect in a cell, such as --features with a hash grid, are left out, and identical cells
are rendered once. Commas separate the values of a list; semicolons do if the values contain commas: --stack
"adaptive,1;adaptive,adaptive/3,1".

--run and --plan define named runs with their own flags of 'gatelight render'. Other flags and axes apply to a run
unless it sets them. For comparison, the integrator without a cache is measured with the samples of --spp, as traced
and, if a run is denoised, also denoised.

By default (without --preset, an axis, --vary, --run, --plan, --denoiser, --view, --query-at and --cache-holds), a sweep
compares 'path' as traced and 'path denoised', with the samples of --spp; 'nrc bare', which is --preset bare after 8 to
1024 steps; and 'nrc standard', which is --preset standard after 128, 512 and 2048 steps with 2, 7 and 28 samples. If a
cell with a cache is denoised, the integrator without one is measured as traced and denoised. Times include all phases:
scouting, training, rendering and denoising.

DIR contains results.csv and results.json (all cells of this call), results.md (means over the seeds, and the speed-up
over the integrator without a cache at the same error), report.html (charts, pictures and tables in one file that opens
offline), pictures and FLIP maps of the first seed, references, gate-memory.json (bytes for same-as-gate), and cells/ (a
file for each finished or failed cell). To continue a stopped sweep, repeat the command: it renders only missing and
failed cells. A cell is identified by the content of the scene, all options, the processor and its instruction set, so
several sweeps can share a DIR, one at a time. If a cell fails, the sweep reports it and continues; the exit code is
then 7. SIGINT, SIGTERM and SIGHUP end the sweep after writing the results so far (exit code 130, 143 or 129).

With --keep-exr, two seeds and two halves of a reference, errors_bias_rel_mse of the second seed is the squared bias of
the pair: the part of rel_mse that more samples do not remove ('gatelight compare --halves'). --reference-dir contains
the halves of a reference, KEY_a.exr and KEY_b.exr, and KEY.exr and KEY.json, which are computed from them. References
that exist are not rendered again.

Preset for finished pictures (2 seeds; paths with 4, 8, 32 and 128 samples unless --spp is given):
  finished        --preset preview, standard and final of 'gatelight render', as named runs
Presets of the paper (3 seeds; 1920x1080 unless --size is given; flags override them, except those that define a row):
  paper-table1    GATE and the hash grid with equal memory, 128 steps
  paper-table2    the hash grid with the memory of GATE, half of it, and 0.91 MiB
  paper-steps     table 1 with 8 to 128 steps
  paper-adaptive  resolution 4 everywhere, compared with adaptive resolutions
  paper-inputs    with and without normal and albedo as inputs
  paper-extra     storage, counters, candidates, precision, stacks, clusters, place of queries, stored light
Presets of 'gatelight render' (bare, preview, standard, final, paper-nao, paper-nrc) set its flags. To compare several
of them, vary them: --vary preset=preview,standard.

Examples:
  gatelight sweep kitchen.glb -o kitchen
  gatelight sweep kitchen.glb -o kitchen --vary denoiser=none,oidn
  gatelight sweep kitchen.glb sponza.glb -o both --encodings gate,hashgrid --cache-memory same-as-gate --seeds 3
  gatelight sweep kitchen.glb sponza.glb -o both --for sponza:camera=hall --for sponza:environment=0.65,0.8,1
  gatelight sweep kitchen.glb -o kitchen --features 2,4,8 --vary batch=4096,16384 --dry-run
  gatelight sweep kitchen.glb -o kitchen --preset finished
  gatelight sweep kitchen.glb -o kitchen --run 'bare: --preset bare' --run 'gather: --integrator nrc --query-at gather'
  gatelight sweep kitchen.glb -o kitchen --advise --max-error 0.05
  gatelight sweep -o kitchen --advise --max-time 10
  gatelight sweep kitchen.glb -o table1 --preset paper-table1 --size 960x540)";

constexpr IntegerRange kReferenceSpp{2, 1 << 24};
constexpr RealRange kErrors{0.0, 1.0};

using namespace renderer;

struct SweepCall {
  SweepArguments words;
  SweepSettings settings;
};

void add_axes(std::vector<Option>& table, SweepArguments& words) {
  OptionGroup axes{table, "Axes"};
  const auto kept = [&](const char* name, const char* unit, const char* help, const char* default_text,
                        std::string& text) {
    axes.add(any_word(name, text, unit, help)).default_text = default_text;
  };
  kept("train-steps", "LIST", "Training step counts; one training run passes through all of them",
       "8,16,32,64,128,256,512,1024", words.train_steps);
  for (const AxisFlag& flag : kAxisFlags) {
    axes.add({.name = flag.name + 2,
              .unit = "LIST",
              .help = flag.help,
              .read = [&words, flag](const std::string& text) { words.axes.emplace_back(flag, text); },
              .default_text = flag.default_text});
  }
  axes.add(any_words("vary", words.vary, "NAME=LIST",
                     "Vary any other flag of render; may be given several times"));
  axes.add(any_words("run", words.runs, "'NAME: FLAGS'",
                     "A named run with its own flags of render; may be given several times"));
  axes.add(any_words("plan", words.plans, "FILE", "File with such runs, one per line; # starts a comment"));
  axes.add(any_words("for", words.scene_flags, "SCENE:NAME=VALUE",
                     "A flag for one scene only; may be given several times"));
  kept("seeds", "N", "Number of seeds; the first one is --seed (1)", "1", words.seeds);
  kept("spp", "LIST", "Samples per pixel of integrators without a cache", "1,4,16,64", words.spp);
  axes.add(toggle("no-plain", words.no_plain, "Do not measure integrators without a cache for comparison"));
  const std::string help = fmt::format("Set axes and flags: {}", fmt::join(sweep_preset_names(), ", "));
  axes.add(any_word("preset", words.preset, "NAME", help.c_str()));
}

void add_reference_options(std::vector<Option>& table, SweepSettings& s) {
  OptionGroup references{table, "References"};
  references.add(
      any_words("reference", s.reference_files, "FILE",
                "Reference picture, for sweeps with one scene and one kind of picture. If given twice, the "
                "files are two halves with different seeds, whose difference gives the noise"));
  references.add({.name = "reference-spp",
                  .unit = "N",
                  .help = "Samples per pixel of rendered references. They are rendered as two halves, whose "
                          "difference gives the noise",
                  .read =
                      [&s](const std::string& text) {
                        const std::int64_t spp = parse_integer("reference-spp", text, kReferenceSpp);
                        s.reference_spp = static_cast<int>(spp + spp % 2);
                      },
                  .default_text = "1024"});
  references.add(any_word("reference-dir", s.reference_folder, "DIR",
                          "Folder of rendered references (default: references in DIR)"));
  references.add(choice("hdr-flip", s.hdr_flip, kOnOff, "Also measure HDR-FLIP of radiance"));
}

void add_advice_options(std::vector<Option>& table, SweepSettings& s) {
  OptionGroup advice{table, "Advice"};
  advice.add(toggle(
      "advise", s.advise,
      "Print the fastest configuration within the limits on stdout. Without SCENE, use the results in DIR"));
  advice.add(number_or("", "max-error", s.limits.max_error, kErrors, "FLIP",
                       "Largest mean FLIP of a picture, for each seed"));
  advice.add(number_or("", "max-time", s.limits.max_seconds, kPositive, "SECONDS",
                       "Longest time for training and rendering"));
}

void add_folder_options(std::vector<Option>& table, SweepSettings& s) {
  OptionGroup output{table, "Output"};
  Option& folder =
      output.add(any_word("output", s.folder, "DIR", "Folder for the results; created if it does not exist"));
  folder.letter = "-o";
  folder.required = true;
  output.add(toggle("keep-exr", s.keep_exr,
                    "Also keep each picture as EXR, and measure the squared bias of each pair of seeds"));
  output.add(toggle("dry-run", s.dry_run, "Print the plan without rendering"));
  output.add(progress_option(s.progress));
  output.add(toggle("quiet", s.quiet, "Print errors only"));
  output.add(toggle("verbose", s.verbose, "Also print all options of each run"));
}

/// Flags of render; they are not in the help.
void add_base_flags(std::vector<Option>& table, SweepArguments& words) {
  OptionGroup base{table, ""};
  for (const std::string& name : base_flag_names()) {
    base.add({.name = name.substr(2), .unit = "VALUE", .read = [&words, name](const std::string& text) {
                set_flag(words.base, name, text);
              }});
  }
}

std::vector<Option> option_table(SweepCall& call) {
  std::vector<Option> table;
  Option scenes = any_words("SCENE", call.words.scenes, "", "Scenes, .gltf or .glb");
  scenes.positional = true;
  table.push_back(scenes);
  add_folder_options(table, call.settings);
  OptionGroup{table, "Scenes"}.add(external_option(call.words.allow_external));
  add_axes(table, call.words);
  add_reference_options(table, call.settings);
  add_advice_options(table, call.settings);
  add_base_flags(table, call.words);
  return table;
}

/// Without a scene other flags have no effect.
void refuse_flags_of_scenes(const CLI::App& app) {
  const std::set<std::string> allowed = {"output",   "advise", "max-error", "max-time",
                                         "progress", "quiet",  "verbose"};
  for (const std::string& name : given_names(app)) {
    if (allowed.contains(name)) continue;
    throw BadOption(
        {name, "", "has no effect without SCENE", "SCENE, or only `advise`, its limits and `output`"});
  }
}

void check(const SweepCall& call, const CLI::App& app) {
  const SweepSettings& s = call.settings;
  const bool limited = s.limits.max_error || s.limits.max_seconds;
  if (limited && !s.advise) {
    throw BadOption(
        {s.limits.max_error ? "max-error" : "max-time", "", "has no effect without `advise`", "`advise`"});
  }
  if (s.advise && !limited)
    throw BadOption({"advise", "", "a limit is missing", "`max-error` or `max-time`"});
  if (call.words.scenes.empty() && !s.advise) {
    throw BadOption({"SCENE", "", "it is missing", "one or more scenes (without one only `advise` works)"});
  }
  if (call.words.scenes.empty()) refuse_flags_of_scenes(app);
  if (s.reference_files.size() > 2) {
    throw BadOption({"reference", s.reference_files[2], "is a third file", "one picture or two halves"});
  }
  if (s.quiet && s.verbose) throw BadOption({"quiet", "", "excludes `verbose`", "one of them"});
}

}  // namespace

Subcommand add_sweep_command(CLI::App& root, const std::vector<std::string>& command) {
  CLI::App* app = add_subcommand(
      root, "sweep", "Measure error against time and steps for combinations of options", kSweepFooter);
  const auto call = std::make_shared<SweepCall>();
  add_flags(*app, option_table(*call));
  return {.app = app, .run = [call, command, app] {
            set_json_messages(call->settings.progress == ProgressMode::json);
            check(*call, *app);
            call->settings.request = make_request(call->words);
            return run_sweep(call->settings, command);
          }};
}

}  // namespace gatelight::apps
