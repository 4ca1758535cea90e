#include "renderer/cache/light_change.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <vector>

namespace gatelight::renderer {
namespace {

/// Cells along the scene's diagonal: small ones see changes nearby, large ones have the records to be
/// certain.
constexpr std::array<float, 2> kCells = {16.0f, 4.0f};
/// Fewer records of a cell say nothing: noise of light has a long tail, which few records seldom meet.
constexpr double kLeastRecords = 64.0;
/// A cell has changed where its mean error is this much of its light, and this many standard errors.
constexpr double kLeastError = 0.3;
constexpr double kStandardErrors = 4.0;

struct Cell {
  double records = 0.0;
  double errors = 0.0, squares = 0.0;  ///< of the differences to the targets
  double answers = 0.0, targets = 0.0;

  /// The error's mean over the light, where that is certain; else 0.
  double change() const {
    if (records < kLeastRecords) return 0.0;
    const double error = std::abs(errors) / records, light = std::max(answers, targets) / records;
    const double variance = std::max(squares / records - error * error, 0.0);
    const bool certain = error > kStandardErrors * std::sqrt(variance / records);
    return certain && error > kLeastError * light ? std::min(error / light, 1.0) : 0.0;
  }

  void add(double answer, double target) {
    const double error = target - answer;
    records += 1.0;
    errors += error;
    squares += error * error;
    answers += answer;
    targets += target;
  }
};

std::uint64_t cell_of(const Vec3& position, const Box& bounds, float size) {
  const Vec3 at = (position - bounds.min()) / size;
  std::uint64_t key = 0;
  for (const float x : at)
    key = key << 21 | (static_cast<std::uint64_t>(std::llround(std::floor(x))) & 0x1fffff);
  return key;
}

Vec3 position_of(const scene::Scene& scene, const SurfacePoints& points, std::size_t i) {
  const scene::Instance& instance = scene.instances[points.surface(i) / 2];
  const std::array<Vec3, 3> corners = scene::world_triangle(scene, instance, points.triangle(i));
  const auto& [u, v] = points.barycentrics(i);
  return (1.0f - u - v) * corners[0] + u * corners[1] + v * corners[2];
}

double mean_of(const float* values, std::size_t count) {
  double sum = 0.0;
  for (std::size_t o = 0; o < count; ++o) sum += static_cast<double>(values[o]);
  return sum / static_cast<double>(count);
}

}  // namespace

double light_change(const scene::Scene& scene, const RecordBatch& group, std::span<const float> answers,
                    std::size_t outputs) {
  const std::size_t records = group.records.size();
  if (records == 0 || scene.bounds.isEmpty()) return 0.0;
  std::vector<double> changes(records, 0.0);
  for (const float cells_across : kCells) {
    const float size = std::max(scene.bounds.diagonal().norm() / cells_across, 1e-30f);
    std::map<std::uint64_t, Cell> cells;
    std::vector<const Cell*> cell_of_record(records, nullptr);
    for (std::size_t i = 0; i < records; ++i) {
      const double target = mean_of(&group.targets[outputs * i], outputs);
      const double answer = mean_of(&answers[outputs * i], outputs);
      if (!std::isfinite(target) || !std::isfinite(answer)) continue;
      Cell& cell = cells[cell_of(position_of(scene, group.records, i), scene.bounds, size)];
      cell.add(answer, target);
      cell_of_record[i] = &cell;
    }
    for (std::size_t i = 0; i < records; ++i) {
      if (cell_of_record[i]) changes[i] = std::max(changes[i], cell_of_record[i]->change());
    }
  }
  return std::accumulate(changes.begin(), changes.end(), 0.0) / static_cast<double>(records);
}

}  // namespace gatelight::renderer
