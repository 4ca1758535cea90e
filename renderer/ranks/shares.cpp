#include "renderer/ranks/shares.h"

#include <algorithm>
#include <numeric>

namespace gatelight::renderer {

Shares::Shares(int tiles, std::span<const double> speeds)
    : begins_(speeds.size() + 1, tiles), density_(static_cast<std::size_t>(tiles), 1.0) {
  deal(speeds);
}

int Shares::owner(int tile) const {
  return static_cast<int>(std::upper_bound(begins_.begin() + 1, begins_.end() - 1, tile) - begins_.begin()) - 1;
}

double Shares::imbalance(std::span<const RankWork> measured) {
  double sum = 0.0, most = 0.0;
  for (const RankWork& work : measured) {
    sum += work.seconds;
    most = std::max(most, work.seconds);
  }
  return sum > 0.0 ? most * static_cast<double>(measured.size()) / sum : 1.0;
}

void Shares::rebalance(std::span<const RankWork> measured) {
  // A ray is not the same work everywhere, but its part of a second is known: so the work of a tile is that of
  // its rank in rays, and the time of a ray belongs to the rank's speed.
  std::vector<double> speeds;
  double usual = 0.0;  // rays of a second, over all ranks
  double rays = 0.0, seconds = 0.0;
  for (const RankWork& work : measured) {
    rays += static_cast<double>(work.rays);
    seconds += work.seconds;
  }
  if (!(rays > 0.0 && seconds > 0.0)) return;
  usual = rays / seconds;
  for (std::size_t r = 0; r < measured.size(); ++r) {
    const RankWork& work = measured[r];
    const bool known = work.rays > 0 && work.seconds > 0.0;
    speeds.push_back(known ? static_cast<double>(work.rays) / work.seconds : usual);
    const auto first = density_.begin() + begins_[r], end = density_.begin() + begins_[r + 1];
    const double expected = std::accumulate(first, end, 0.0);
    if (!known || expected <= 0.0) continue;
    std::for_each(first, end, [&](double& d) { d *= static_cast<double>(work.rays) / expected; });
  }
  deal(speeds);
}

void Shares::deal(std::span<const double> speeds) {
  const double all_work = std::accumulate(density_.begin(), density_.end(), 0.0);
  const double all_speed = std::accumulate(speeds.begin(), speeds.end(), 0.0);
  double speed = 0.0, work = 0.0;
  std::size_t tile = 0;
  for (std::size_t r = 0; r < speeds.size(); ++r) {
    begins_[r] = static_cast<int>(tile);
    speed += speeds[r];
    const double goal = all_work * speed / all_speed;
    // A tile goes to the rank that has more than half of it.
    while (tile < density_.size() && work + 0.5 * density_[tile] < goal) work += density_[tile++];
  }
  begins_.back() = static_cast<int>(density_.size());
}

}  // namespace gatelight::renderer
