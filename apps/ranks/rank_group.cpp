#include "apps/ranks/rank_group.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/terminal/signals.h"

namespace gatelight::apps {

std::string name_of_rank(int rank, int count, const std::string& host) {
  return fmt::format("rank {} of {} ({})", rank, count, host);
}

int RankGroup::signal() const {
  const std::vector<int> signals = ranks.of_each(stop_signal());
  return *std::max_element(signals.begin(), signals.end());
}

}  // namespace gatelight::apps
