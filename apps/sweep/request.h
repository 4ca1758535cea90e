#pragma once
// Converts the arguments of `gatelight sweep` into the request of a sweep.

#include <string>
#include <vector>

#include "apps/sweep/advise.h"
#include "apps/sweep/plan.h"
#include "apps/terminal/progress.h"

namespace gatelight::apps {

/// A flag of `sweep` that takes the values of a flag of `render`.
struct AxisFlag {
  const char* name;    ///< "--encodings"
  const char* varies;  ///< "--encoding"
  const char* help;
  const char* default_text = "";
};
inline constexpr AxisFlag kAxisFlags[] = {
    {"--integrators", "--integrator", "nrc, nao, path, ao", "nrc"},
    {"--encodings", "--encoding", "gate, hashgrid"},
    {"--features", "--features", "gate: length of a feature vector"},
    {"--resolution", "--resolution", "gate: uniform, paper, fixed:R"},
    {"--stack", "--stack", "gate: resolutions of the levels; ';' separates several stacks"},
    {"--cache-memory", "--cache-memory",
     "Memory of the features in MiB; 0: no limit; same-as-gate: the hash grid has the memory of GATE with "
     "the same flags; same-as-gate/2: half of it"},
    {"--hidden", "--hidden", "Width of the network's hidden layers"},
    {"--learning-rate", "--learning-rate", "Size of a training step"},
    {"--cache-spp", "--spp", "Samples per pixel of pictures with a cache", "4"},
};

/// Flags of `render` that can be given for all cells of a sweep, or varied: those with a value that decide
/// the picture. Flags that `sweep` defines itself are not among them.
const std::vector<std::string>& base_flag_names();

struct SweepArguments {
  std::vector<std::string> scenes;
  std::string preset;  ///< of `sweep` or of `render`
  FlagValues base;
  std::vector<std::pair<AxisFlag, std::string>> axes;
  std::vector<std::string> vary;
  std::vector<std::string> runs;         ///< "NAME: FLAGS"
  std::vector<std::string> plans;        ///< files of such lines
  std::vector<std::string> scene_flags;  ///< "sponza:camera=hall"
  std::string train_steps;               ///< empty: not given; the same for the next two
  std::string spp;
  std::string seeds;
  bool no_plain = false;
  bool allow_external = false;
};

/// Throws BadOption. Values of axes are checked by make_plan().
SweepRequest make_request(const SweepArguments& words);

/// All settings of `gatelight sweep`.
struct SweepSettings {
  SweepRequest request;
  std::string folder;
  std::vector<std::string> reference_files;  ///< one picture or two halves; empty: they are rendered
  int reference_spp = 1024;                  ///< of both halves together
  std::string reference_folder;              ///< empty: references/ in `folder`
  bool hdr_flip = true;
  bool keep_exr = false;  ///< also measures the bias, by pairs of seeds
  bool dry_run = false;
  bool advise = false;
  AdviceLimits limits;
  ProgressMode progress = ProgressMode::automatic;
  bool quiet = false;
  bool verbose = false;
};

}  // namespace gatelight::apps
