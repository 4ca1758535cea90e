#pragma once
// Cells that differ only in their seeds, and how much less time they take than the plain integrator.

#include <cstdint>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gatelight::apps {

/// The lines with which all others are compared: the first ones of the integrator without a cache, against
/// the same reference.
enum class Baseline : std::uint8_t { none, traced, denoised };

/// The part of the names of columns that belongs to a baseline.
constexpr const char* prefix_of(Baseline baseline) {
  return baseline == Baseline::denoised ? "denoised_" : "";
}

/// The errors of a cell with such columns.
inline constexpr const char* kEqualErrors[] = {"rel_mse_clean", "flip"};

struct Mean {
  double value = 0.0;
  double least = 0.0;
  double most = 0.0;
  std::optional<double> deviation;  ///< the standard deviation, of three values or more
};

struct MeasuredRun {
  std::vector<const nlohmann::ordered_json*> cells;  ///< those that are done, at least one
  Baseline baseline = Baseline::none;

  const nlohmann::ordered_json& cell() const { return *cells.front(); }
  std::string word(const char* key) const;  ///< such as "series"
  /// Over the cells that have the number, such as ("errors", "flip"). Nothing where none has.
  std::optional<Mean> mean(const char* object, const char* key) const;
};

/// Whether their cells have the same values of these keys.
bool same_cells(const MeasuredRun& a, const MeasuredRun& b, std::initializer_list<const char*> keys);

/// In the order of the cells, which must outlive the runs.
std::vector<MeasuredRun> measured_runs(const nlohmann::ordered_json& cells);

struct EqualSeconds {
  double seconds = 0.0;
  bool extrapolated = false;  ///< beyond the points
};

/// The seconds at which a line through the points (seconds, error) has this error. The line is straight
/// between points on logarithmic axes. Nothing where there are no two points, where an error has no
/// logarithm, or where the line would have to be continued and does not fall.
std::optional<EqualSeconds> equal_error_seconds(std::vector<std::pair<double, double>> points, double error);

/// Adds "equal_seconds", "times_faster" and "extrapolated" to the cells that are done, with a number for each
/// error and baseline; null where there is none. They compare means over the seeds, so all seeds have the
/// same. Baselines are compared with those before them.
void add_equal_error(nlohmann::ordered_json& cells);

}  // namespace gatelight::apps
