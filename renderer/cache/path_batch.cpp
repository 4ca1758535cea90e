#include "renderer/cache/path_batch.h"

#include <algorithm>

namespace gatelight::renderer {
namespace {

/// Three floats as a colour.
Eigen::Map<const Color> color_at(std::span<const float> values, std::int32_t index) {
  return Eigen::Map<const Color>(&values[3 * static_cast<std::size_t>(index)]);
}

}  // namespace

void PathBatch::begin(std::size_t paths) {
  emission.assign(paths, Color::Zero());
  vertices.clear();
  queries.clear();
  records.clear();
  targets.clear();
  first_queries.assign(paths, kNone);
  first_records.assign(paths, kNone);
  ends.clear();
  guides.clear();
  parts.begin({}, 0, 0);
  answer_lobes.clear();
  unstored_hits = 0;
}

void PathBatch::write_guides(std::span<const float> answers, std::span<FirstHit> first_hits) const {
  // The last vertex of each path before its guide, or of the whole path without a guide.
  std::vector<std::int32_t> last(paths(), kNone);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const PathVertex& v = vertices[i];
    const std::int32_t end = guides[v.path].vertex;
    if (end == kNone || static_cast<std::int32_t>(i) < end) last[v.path] = static_cast<std::int32_t>(i);
  }
  for (std::size_t p = 0; p < paths(); ++p) {
    const PathGuide& guide = guides[p];
    std::int32_t at = last[p];
    Color light = Color::Zero();
    if (guide.vertex != kNone) {
      light = guide.separate;
      if (guide.query != kNone) light += guide.reflectance * color_at(answers, guide.query);
      const PathVertex& v = vertices[static_cast<std::size_t>(guide.vertex)];
      light *= v.link;
      at = v.previous;
    }
    while (at != kNone) {
      const PathVertex& v = vertices[static_cast<std::size_t>(at)];
      light = v.link * (v.direct + light);
      at = v.previous;
    }
    FirstHit& first = first_hits[p];
    first.guided = true;
    first.cache_radiance = emission[p] + light;
  }
}

void PathBatch::add_answer(std::size_t vertex, const Color& light) {
  const std::uint32_t path = vertices[vertex].path;
  if (parts.first_scattering(path).in_medium) return parts.add_indirect(path, light);
  parts.add(path, answer_lobes[vertex], false, light);
}

void PathBatch::resolve(std::span<const float> answers, std::span<Color> radiance) {
  if (!radiance.empty()) std::copy(emission.begin(), emission.end(), radiance.begin());
  for (std::size_t i = vertices.size(); i-- > 0;) {
    const PathVertex& v = vertices[i];
    if (v.record != kNone) target(v.record) /= v.reflectance;
    Color reflected = v.direct;
    if (v.query != kNone) {
      const Color answer = v.reflectance * color_at(answers, v.query);
      reflected += answer;
      if (parts.any_passes() && v.previous == kNone) add_answer(i, v.link * answer);
    }
    if (v.previous == kNone) {
      if (!radiance.empty()) radiance[v.path] += v.link * reflected;
      continue;
    }
    PathVertex& previous = vertices[static_cast<std::size_t>(v.previous)];
    previous.direct += v.link * reflected;
    if (parts.any_passes() && previous.previous == kNone)
      parts.add_indirect(v.path, previous.link * v.link * reflected);
    if (previous.record != kNone) target(previous.record) += v.cached_link * reflected;
  }
}

std::size_t PathBatch::count_ends() const {
  return ends.size() - static_cast<std::size_t>(std::count(ends.begin(), ends.end(), kNone));
}

void PathBatch::copy_ends(SurfacePoints& points, std::size_t at) const {
  for (const std::int32_t end : ends) {
    if (end == kNone) continue;
    points.copy(records, static_cast<std::size_t>(vertices[static_cast<std::size_t>(end)].record), 1, at++);
  }
}

void PathBatch::end_samples(std::span<const float> answers, std::span<Color> radiance) {
  std::int32_t answer = 0;
  for (const std::int32_t end : ends) {
    if (end == kNone) continue;
    const PathVertex& v = vertices[static_cast<std::size_t>(end)];
    Color change = v.reflectance * (color_at(answers, answer++) - color_at(targets, v.record));
    for (std::int32_t at = end; at != kNone; at = vertices[static_cast<std::size_t>(at)].previous)
      change *= vertices[static_cast<std::size_t>(at)].link;
    const Color before = radiance[v.path];
    radiance[v.path] = (before + change).max(0.0f);
    if (!parts.any_passes()) continue;
    const Color added = radiance[v.path] - before;
    if (v.previous == kNone) {
      add_answer(static_cast<std::size_t>(end), added);
    } else {
      parts.add_indirect(v.path, added);
    }
  }
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
      Color sum = target(first[p]);
      float count = 1.0f;
      for (std::size_t q = p + 1; q < end; ++q) {
        if (first[q] == kNone || dropped[static_cast<std::size_t>(first[q])] ||
            !same_point(first[p], first[q]))
          continue;
        sum += target(first[q]);
        count += 1.0f;
        dropped[static_cast<std::size_t>(first[q])] = true;
      }
      target(first[p]) = sum / count;
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
