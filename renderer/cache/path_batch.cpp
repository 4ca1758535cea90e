#include "renderer/cache/path_batch.h"

#include <algorithm>

namespace gatelight::renderer {
namespace {

/// Three floats as a colour.
Eigen::Map<Color> color_at(std::vector<float>& values, std::int32_t index) {
  return Eigen::Map<Color>(&values[3 * static_cast<std::size_t>(index)]);
}
Eigen::Map<const Color> color_at(std::span<const float> values, std::int32_t index) {
  return Eigen::Map<const Color>(&values[3 * static_cast<std::size_t>(index)]);
}

}  // namespace

void PathBatch::resolve(std::span<const float> answers, std::span<Color> radiance) {
  targets.resize(3 * records.size());
  // A vertex is made after the one that looked at it.
  for (std::size_t i = vertices.size(); i-- > 0;) {
    PathVertex& v = vertices[i];
    if (v.record != kNone) {
      const Color held =
          v.held_direct + v.held_emission_weight * v.emission + v.held_scattered_weight * v.scattered;
      color_at(targets, v.record) = held / v.reflectance;
    }
    Color reflected = v.direct + v.emission_weight * v.emission + v.scattered_weight * v.scattered;
    if (v.query != kNone) reflected += v.reflectance * color_at(answers, v.query);
    if (v.previous != kNone) {
      vertices[static_cast<std::size_t>(v.previous)].scattered += v.passed * reflected;
    } else if (i < radiance.size()) {
      radiance[i] = reflected;
    }
  }
}

std::vector<std::uint32_t> PathBatch::paths_of_vertices() const {
  std::vector<std::uint32_t> paths(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    const std::int32_t previous = vertices[i].previous;
    paths[i] = previous == kNone ? i : paths[static_cast<std::size_t>(previous)];
  }
  return paths;
}

void PathBatch::average_first_records(std::size_t times) {
  const std::vector<std::int32_t>& first = first_records;
  const std::size_t paths = first.size();
  const auto same_point = [&](std::int32_t a, std::int32_t b) {
    return records.same_point(static_cast<std::size_t>(a), records, static_cast<std::size_t>(b));
  };
  std::vector<bool> dropped(records.size(), false);
  for (std::size_t begin = 0; begin < paths; begin += times) {
    const std::size_t end = std::min(begin + times, paths);
    for (std::size_t p = begin; p < end; ++p) {
      if (first[p] == kNone || dropped[static_cast<std::size_t>(first[p])]) continue;
      Color sum = color_at(targets, first[p]);
      float count = 1.0f;
      for (std::size_t q = p + 1; q < end; ++q) {
        if (first[q] == kNone || dropped[static_cast<std::size_t>(first[q])] ||
            !same_point(first[p], first[q]))
          continue;
        sum += color_at(targets, first[q]);
        count += 1.0f;
        dropped[static_cast<std::size_t>(first[q])] = true;
      }
      color_at(targets, first[p]) = sum / count;
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (dropped[i]) continue;
    if (kept != i) {
      records.copy(records, i, 1, kept);
      std::copy_n(&targets[3 * i], 3, &targets[3 * kept]);
    }
    ++kept;
  }
  records.resize(kept);
  targets.resize(3 * kept);
}

}  // namespace gatelight::renderer
