#include "renderer/distributed/shares.h"

#include <algorithm>
#include <numeric>

namespace gatelight::renderer {
namespace {

/// Shares change where a rank would take at least this many times the mean: moving sums of the film has a
/// cost.
constexpr double kImbalance = 1.02;

/// Weight of the last measurement. Speeds jump by a tenth from second to second on shared machines, and
/// shares that follow each jump lag behind.
constexpr double kNewest = 0.3;

}  // namespace

Shares::Shares(int tiles, std::span<const double> speeds)
    : begins_(speeds.size() + 1, tiles),
      density_(static_cast<std::size_t>(tiles), 1.0),
      speeds_(speeds.begin(), speeds.end()) {
  rebalance();
}

int Shares::owner(int tile) const {
  return static_cast<int>(std::upper_bound(begins_.begin() + 1, begins_.end() - 1, tile) - begins_.begin()) -
         1;
}

bool Shares::rebalance(std::span<const RankWork> measured) {
  learn(measured);
  if (imbalance() < kImbalance) return false;
  rebalance();
  return true;
}

void Shares::learn(std::span<const RankWork> measured) {
  // Rays are counted exactly, so the work of tiles is measured in them. A ray takes longer in some places
  // than in others; that counts towards the speed of the rank that has them.
  double rays = 0.0, seconds = 0.0;
  for (const RankWork& work : measured) {
    rays += static_cast<double>(work.rays);
    seconds += work.seconds;
  }
  if (!(rays > 0.0 && seconds > 0.0)) return;
  for (std::size_t r = 0; r < measured.size(); ++r) {
    const RankWork& work = measured[r];
    const bool known = work.rays > 0 && work.seconds > 0.0;
    const double speed = known ? static_cast<double>(work.rays) / work.seconds : rays / seconds;
    speeds_[r] = measured_ ? (1.0 - kNewest) * speeds_[r] + kNewest * speed : speed;
    const auto first = density_.begin() + begins_[r], end = density_.begin() + begins_[r + 1];
    const double expected = std::accumulate(first, end, 0.0);
    if (!known || expected <= 0.0) continue;
    std::for_each(first, end, [&](double& d) { d *= static_cast<double>(work.rays) / expected; });
  }
  measured_ = true;
}

double Shares::imbalance() const {
  double sum = 0.0, most = 0.0;
  for (std::size_t r = 0; r < speeds_.size(); ++r) {
    const auto first = density_.begin() + begins_[r], end = density_.begin() + begins_[r + 1];
    const double seconds = std::accumulate(first, end, 0.0) / speeds_[r];
    sum += seconds;
    most = std::max(most, seconds);
  }
  return sum > 0.0 ? most * static_cast<double>(speeds_.size()) / sum : 1.0;
}

void Shares::rebalance() {
  const double all_work = std::accumulate(density_.begin(), density_.end(), 0.0);
  const double all_speed = std::accumulate(speeds_.begin(), speeds_.end(), 0.0);
  double speed = 0.0, work = 0.0;
  std::size_t tile = 0;
  for (std::size_t r = 0; r < speeds_.size(); ++r) {
    begins_[r] = static_cast<int>(tile);
    speed += speeds_[r];
    const double goal = all_work * speed / all_speed;
    // A tile goes to the rank that has more than half of it.
    while (tile < density_.size() && work + 0.5 * density_[tile] < goal) work += density_[tile++];
  }
  begins_.back() = static_cast<int>(density_.size());
}

}  // namespace gatelight::renderer
