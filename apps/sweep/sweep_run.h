#pragma once
// A call of `gatelight sweep`, from the plan to the files.

#include <string>
#include <vector>

#include "apps/sweep/advise.h"
#include "apps/sweep/plan.h"
#include "apps/terminal/progress.h"

namespace gatelight::apps {

/// All settings of `gatelight sweep`.
struct SweepSettings {
  SweepRequest request;
  std::string folder;
  std::string reference_file;    ///< empty: references are rendered
  int reference_spp = 1024;      ///< of both halves together
  std::string reference_folder;  ///< empty: references/ in `folder`
  bool hdr_flip = true;
  bool dry_run = false;
  bool advise = false;
  AdviceLimits limits;
  ProgressMode progress = ProgressMode::automatic;
  bool quiet = false;
  bool verbose = false;
};

/// Returns the exit code, or throws what errors.h handles. command: the program's arguments.
int run_sweep(const SweepSettings& settings, const std::vector<std::string>& command);

}  // namespace gatelight::apps
