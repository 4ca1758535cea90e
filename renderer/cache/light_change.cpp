#include "renderer/cache/light_change.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/parallel/loops.h"

namespace gatelight::renderer {
namespace {

/// Cells along the scene's diagonal. Where the records of a small one leave it open whether its light has
/// changed, the larger one around decides.
constexpr std::array<float, 2> kCells = {16.0f, 4.0f};
constexpr double kMinRecords = 64.0;
/// A cell has changed where its mean error is this much of its light, and this many standard errors.
constexpr double kMinError = 0.3;
/// The same for the whole scene: answers may be far off in a cell, but not in the mean of all. Only many
/// records of even light decide it: a mean that lacks its rare bright samples is as dark as if a lamp had
/// been dimmed.
constexpr double kMinErrorOfAll = 0.05, kMinRecordsOfAll = 8192.0, kMaxVarianceOfAll = 4.0;
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
  std::optional<double> change(double least_variance, double least_error) const {
    if (records < kMinRecords) return std::nullopt;
    const double brightness = light();
    if (!(brightness > 0.0)) return 0.0;
    const double error = std::abs(errors) / records / brightness;
    const double noise = kStandardErrors * std::sqrt(std::max(relative_variance(), least_variance) / records);
    if (error > noise && error > least_error) return std::min(error, 1.0);
    if (error + noise < least_error) return 0.0;
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
  struct Met {
    Vec3 position;
    std::pair<double, double> values;  ///< answer and target
    std::uint64_t cell = 0;
    Cell* of = nullptr;
    std::optional<double> change;
  };
  std::vector<Met> met(records);
  const auto each = [&](const auto& visit) {
    for_each_range(records, 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) visit(i, met[i]);
    });
  };
  each([&](std::size_t i, Met& m) {
    m.position = position_of(scene, group.records, i);
    m.values = {mean_of(&answers[outputs * i], outputs), mean_of(&group.targets[outputs * i], outputs)};
  });
  Cell all;
  for (const Met& m : met) {
    if (is_finite(m.values)) all.add(m.values.first, m.values.second);
  }
  if (!(all.records > 0.0)) return 0.0;
  const double least_variance = kShareOfAll * all.relative_variance();
  for (const float cells_across : kCells) {
    const float size = std::max(scene.bounds.diagonal().norm() / cells_across, 1e-30f);
    each([&](std::size_t, Met& m) { m.cell = cell_of(m.position, scene.bounds, size); });
    std::unordered_map<std::uint64_t, Cell> cells;
    for (Met& m : met) {
      if (!is_finite(m.values)) continue;
      m.of = &cells[m.cell];
      m.of->add(m.values.first, m.values.second);
    }
    each([&](std::size_t, Met& m) {
      if (!m.change && m.of) m.change = m.of->change(least_variance, kMinError);
      m.of = nullptr;
    });
  }
  double sum = 0.0;
  for (const Met& m : met) sum += m.change.value_or(0.0);
  const bool is_even = all.records >= kMinRecordsOfAll && all.relative_variance() <= kMaxVarianceOfAll;
  const double of_all = is_even ? all.change(least_variance, kMinErrorOfAll).value_or(0.0) : 0.0;
  return std::max(sum / all.records, of_all);
}

}  // namespace gatelight::renderer
