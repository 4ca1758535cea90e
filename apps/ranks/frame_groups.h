#pragma once
// Groups of ranks that render frames of their own (--frame-groups).

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "apps/ranks/rank_group.h"
#include "apps/settings/frame_range.h"
#include "apps/terminal/errors.h"

namespace gatelight::apps {

/// The group of this rank: neighbours, and groups that differ by one rank at most.
int number_of_group(int groups, const renderer::Ranks& all);

/// The ranks of this rank's group; all of them where there is one. Throws BadOption for more groups than
/// ranks, InputError where the ranks want different numbers of groups. All ranks call it.
RankGroup own_group(int groups, const RankGroup& all);

/// Frames of a group: every N-th one, by its place among all.
std::vector<int> frames_of_group(const std::vector<int>& all, int groups, int number);

/// The results of the frames of one group, or of all.
struct FrameResults {
  int signal = 0;  ///< that ended them; 0: none
  std::size_t done = 0;
  std::vector<std::string> warnings;
  std::optional<Failure> failure;  ///< that of the first frame which failed
};

/// Those of all groups, at each rank. All ranks call it.
FrameResults joined_results(renderer::Ranks& all, const FrameResults& mine);

}  // namespace gatelight::apps
