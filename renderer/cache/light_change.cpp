#include "renderer/cache/light_change.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace gatelight::renderer {
namespace {

/// Cells along the scene's diagonal. Where the records of a small one leave it open whether its light has
/// changed, the larger one around decides.
constexpr std::array<float, 2> kCells = {16.0f, 4.0f};
constexpr double kLeastRecords = 64.0;
/// A cell has changed where its mean error is this much of its light, and this many standard errors.
constexpr double kLeastError = 0.3;
constexpr double kStandardErrors = 4.0;
/// Noise of light has a long tail, which few records seldom meet: a cell's relative variance is at least this
/// share of that of all records.
constexpr double kShareOfAll = 0.5;

struct Cell {
  double records = 0.0;
  double errors = 0.0, squares = 0.0;  ///< of the differences to the targets
  double answers = 0.0, targets = 0.0;

  double light() const { return std::max(answers, targets) / records; }
  /// Over the square of the light.
  double relative_variance() const {
    const double mean = errors / records, brightness = light();
    return brightness > 0.0 ? std::max(squares / records - mean * mean, 0.0) / (brightness * brightness)
                            : 0.0;
  }
  /// The error's mean over the light; 0 where it is small, nothing where that is not certain.
  std::optional<double> change(double least_variance) const {
    if (records < kLeastRecords) return std::nullopt;
    const double brightness = light();
    if (!(brightness > 0.0)) return 0.0;
    const double error = std::abs(errors) / records / brightness;
    const double noise = kStandardErrors * std::sqrt(std::max(relative_variance(), least_variance) / records);
    if (error > noise && error > kLeastError) return std::min(error, 1.0);
    if (error + noise < kLeastError) return 0.0;
    return std::nullopt;
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

bool is_finite(const std::pair<double, double>& values) {
  return std::isfinite(values.first) && std::isfinite(values.second);
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
  Cell all;
  std::vector<std::pair<double, double>> values(records);  // answer and target
  for (std::size_t i = 0; i < records; ++i) {
    values[i] = {mean_of(&answers[outputs * i], outputs), mean_of(&group.targets[outputs * i], outputs)};
    if (is_finite(values[i])) all.add(values[i].first, values[i].second);
  }
  if (!(all.records > 0.0)) return 0.0;
  const double least_variance = kShareOfAll * all.relative_variance();
  std::vector<std::optional<double>> changes(records);
  for (const float cells_across : kCells) {
    const float size = std::max(scene.bounds.diagonal().norm() / cells_across, 1e-30f);
    std::map<std::uint64_t, Cell> cells;
    std::vector<const Cell*> cell_of_record(records, nullptr);
    for (std::size_t i = 0; i < records; ++i) {
      if (!is_finite(values[i])) continue;
      Cell& cell = cells[cell_of(position_of(scene, group.records, i), scene.bounds, size)];
      cell.add(values[i].first, values[i].second);
      cell_of_record[i] = &cell;
    }
    for (std::size_t i = 0; i < records; ++i) {
      if (!changes[i] && cell_of_record[i]) changes[i] = cell_of_record[i]->change(least_variance);
    }
  }
  double sum = 0.0;
  for (const std::optional<double>& change : changes) sum += change.value_or(0.0);
  return sum / all.records;
}

}  // namespace gatelight::renderer
