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
    R"(Every combination of the lists is a line in the plots, and each of its step counts is a cell: one picture, compared
with a reference. One training gives the pictures of all its step counts. For each integrator with a cache the one
without is measured too (path for nrc, ao for nao). Any other flag of 'gatelight render' that decides a picture can be
given and applies to all cells (--size, --camera, --batch ...; see its --help). A flag without effect in a cell, such as
--features with a hash grid, is left out there, and equal cells are made once. Lists are separated by commas, or by
semicolons where a value holds commas: --stack "adaptive,1;adaptive,adaptive/3,1".

With --run and --plan pictures have names and flags of their own, as 'gatelight render' has them; flags for all cells
and axes apply where a run does not set them. Beside them the integrator without a cache is measured at the samples of
--spp, as traced and, for denoised runs, denoised.

Without --preset, an axis, --vary, --run, --plan, --denoiser, --view, --query-at and --cache-holds, a sweep compares
these by error and time: 'path' as traced and 'path denoised' at the samples of --spp; 'nrc bare', which is --preset
bare after 8 to 1024 steps; and 'nrc standard', the finished pictures of --preset standard after 128, 512 and 2048 steps
with 2, 7 and 28 samples. Wherever a cell with a cache is denoised, the integrator without one is measured both as
traced and denoised. Time counts all phases: scouting, training, rendering, denoising.

DIR has results.csv and results.json (all cells of this call), results.md (tables of means over the seeds, and how many
times less time than the integrator without a cache they take for the same error), report.html (charts, pictures and
tables of the cells: one file that opens offline), pictures and FLIP maps of the first seed, references,
gate-memory.json (bytes for same-as-gate), and cells/, a file for each cell that is done or has failed. The same command
continues where it was stopped: it makes missing and failed cells, but none that is done. Cells are identified by the
scene's content, all options, the processor and its instruction set, so that a DIR can serve several sweeps, one at a
time. A cell that fails is reported, and the others continue; the exit code is 7 then. SIGINT, SIGTERM and SIGHUP end
the sweep after writing the results so far (130, 143 or 129).

With --keep-exr, two seeds and two halves of a reference, errors_bias_rel_mse of the second seed is the squared bias of
the pair: the part of rel_mse that more samples would not remove ('gatelight compare --halves'). A reference in
--reference-dir is KEY_a.exr and KEY_b.exr, its halves, and KEY.exr and KEY.json, made of them; what is there is used.

Preset of finished pictures (2 seeds; paths with 4, 8, 32 and 128 samples unless --spp is given):
  finished        --preset preview, standard and final of 'gatelight render', as named runs
Presets of the paper (3 seeds, 1920x1080 unless --size is given; flags override them, except those that a row is named
after):
  paper-table1    GATE and the hash grid at the same memory, 128 steps
  paper-table2    the hash grid with GATE's memory, a half of it, and 0.91 MiB
  paper-steps     the same as table 1 from 8 to 128 steps
  paper-adaptive  resolution 4 everywhere against adaptive ones
  paper-inputs    with and without normal and albedo
  paper-extra     storage, counters, candidates, precision, stacks, clusters, place of queries, what the cache stores
Those of 'gatelight render' (bare, preview, standard, final, paper-nao, paper-nrc) stand for their flags. Several of them are
an axis: --vary preset=preview,standard.

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
  kept("train-steps", "LIST", "Training steps, all from one training", "8,16,32,64,128,256,512,1024",
       words.train_steps);
  for (const AxisFlag& flag : kAxisFlags) {
    axes.add({.name = flag.name + 2,
              .unit = "LIST",
              .help = flag.help,
              .read = [&words, flag](const std::string& text) { words.axes.emplace_back(flag, text); },
              .default_text = flag.default_text});
  }
  axes.add(any_words("vary", words.vary, "NAME=LIST",
                     "Any other flag of render as an axis; may be given several times"));
  axes.add(any_words("run", words.runs, "'NAME: FLAGS'",
                     "A picture with flags of render of its own; may be given several times"));
  axes.add(any_words("plan", words.plans, "FILE", "Such runs, one a line; # begins a comment"));
  axes.add(any_words("for", words.scene_flags, "SCENE:NAME=VALUE",
                     "A flag for one scene only; may be given several times"));
  kept("seeds", "N", "Seeds, from --seed (1) on", "1", words.seeds);
  kept("spp", "LIST", "Samples per pixel of integrators without a cache", "1,4,16,64", words.spp);
  axes.add(
      toggle("no-plain", words.no_plain, "Do not measure integrators without a cache beside those with one"));
  const std::string help = fmt::format("Axes and flags at once: {}", fmt::join(sweep_preset_names(), ", "));
  axes.add(any_word("preset", words.preset, "NAME", help.c_str()));
}

void add_reference_options(std::vector<Option>& table, SweepSettings& s) {
  OptionGroup references{table, "References"};
  references.add(
      any_words("reference", s.reference_files, "FILE",
                "Compare with this picture; for one scene and one kind of picture. Given twice, the "
                "files are two halves with different seeds, and give its noise"));
  references.add(
      {.name = "reference-spp",
       .unit = "N",
       .help = "Samples per pixel of rendered references: two halves, whose difference gives their noise",
       .read =
           [&s](const std::string& text) {
             const std::int64_t spp = parse_integer("reference-spp", text, kReferenceSpp);
             s.reference_spp = static_cast<int>(spp + spp % 2);
           },
       .default_text = "1024"});
  references.add(any_word("reference-dir", s.reference_folder, "DIR",
                          "Folder of rendered references (default: references in DIR)"));
  references.add(choice("hdr-flip", s.hdr_flip, kOnOff, "Measure HDR-FLIP of radiance, too"));
}

void add_advice_options(std::vector<Option>& table, SweepSettings& s) {
  OptionGroup advice{table, "Advice"};
  advice.add(toggle("advise", s.advise,
                    "Name the fastest configuration within the limits, on stdout. Without SCENE it uses the "
                    "results in DIR"));
  advice.add(number_or("", "max-error", s.limits.max_error, kErrors, "FLIP",
                       "Largest mean FLIP of a picture, with every seed"));
  advice.add(number_or("", "max-time", s.limits.max_seconds, kPositive, "SECONDS",
                       "Longest time to train and render"));
}

void add_folder_options(std::vector<Option>& table, SweepSettings& s) {
  OptionGroup output{table, "Output"};
  Option& folder = output.add(
      any_word("output", s.folder, "DIR", "Folder of the results; it is made if it does not exist"));
  folder.letter = "-o";
  folder.required = true;
  output.add(toggle("keep-exr", s.keep_exr,
                    "Keep every picture as EXR too, and measure the squared bias of each pair of seeds"));
  output.add(toggle("dry-run", s.dry_run, "Print the plan and stop"));
  output.add(progress_option(s.progress));
  output.add(toggle("quiet", s.quiet, "Print errors only"));
  output.add(toggle("verbose", s.verbose, "Print more: all options of each run"));
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
    throw BadOption({name, "", "without SCENE it has no effect",
                     "SCENE with it, or only `advise`, its limits and `output`"});
  }
}

void check(const SweepCall& call, const CLI::App& app) {
  const SweepSettings& s = call.settings;
  const bool limited = s.limits.max_error || s.limits.max_seconds;
  if (limited && !s.advise) {
    throw BadOption(
        {s.limits.max_error ? "max-error" : "max-time", "", "it is for advice", "`advise` with it"});
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
  CLI::App* app =
      add_subcommand(root, "sweep", "Measure error against time and steps over options", kSweepFooter);
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
