#pragma once
// All that `gatelight sweep` can be told.

#include <optional>
#include <string>

#include "apps/sweep/plan.h"
#include "apps/terminal/progress.h"

namespace gatelight::apps {

struct AdviceLimits {
  std::optional<double> max_error;    ///< mean FLIP of a picture, with every seed
  std::optional<double> max_seconds;  ///< of scouting, training and rendering
};

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

}  // namespace gatelight::apps
