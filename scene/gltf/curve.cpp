#include "scene/gltf/curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/gltf/accessors.h"

namespace gatelight::scene::gltf {
namespace {

enum Part { kInTangent, kValue, kOutTangent };

Eigen::VectorXd part_of_key(const Curve& curve, std::size_t key, Part part) {
  const std::size_t row = curve.interpolation == Interpolation::cubic_spline ? 3 * key + part : key;
  const float* const values = curve.values.data() + row * curve.width;
  return Eigen::Map<const Eigen::VectorXf>(values, static_cast<Eigen::Index>(curve.width)).cast<double>();
}

/// No rotation for a quaternion of length 0.
Eigen::Quaterniond unit_quaternion(const Eigen::VectorXd& v) {
  const Eigen::Quaterniond q(v[3], v[0], v[1], v[2]);
  return q.norm() > 1e-12 ? q.normalized() : Eigen::Quaterniond::Identity();
}

/// The cubic of Hermite (glTF 2.0, appendix C.5). Tangents are changes in a second.
Eigen::VectorXd hermite(const Curve& curve, std::size_t key, double seconds, double u) {
  const double u2 = u * u;
  const double u3 = u2 * u;
  return (2.0 * u3 - 3.0 * u2 + 1.0) * part_of_key(curve, key, kValue) +
         seconds * (u3 - 2.0 * u2 + u) * part_of_key(curve, key, kOutTangent) +
         (3.0 * u2 - 2.0 * u3) * part_of_key(curve, key + 1, kValue) +
         seconds * (u3 - u2) * part_of_key(curve, key + 1, kInTangent);
}

Eigen::VectorXd between_keys(const Curve& curve, std::size_t key, double seconds, double u) {
  if (curve.interpolation == Interpolation::step || curve.shape.is_switch)
    return part_of_key(curve, key, kValue);
  if (curve.interpolation == Interpolation::cubic_spline) return hermite(curve, key, seconds, u);
  const Eigen::VectorXd from = part_of_key(curve, key, kValue);
  const Eigen::VectorXd to = part_of_key(curve, key + 1, kValue);
  // Eigen's slerp takes the shorter arc.
  if (curve.shape.is_rotation) return unit_quaternion(from).slerp(u, unit_quaternion(to)).coeffs();
  return (1.0 - u) * from + u * to;
}

/// The number of keys before a time, or until it.
std::size_t keys_before(const Curve& curve, float time) {
  const std::vector<float>& times = *curve.times;
  return static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), time) - times.begin());
}
std::size_t keys_until(const Curve& curve, float time) {
  const std::vector<float>& times = *curve.times;
  return static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
}

double seconds_after(const Curve& curve, std::size_t key) {
  return static_cast<double>((*curve.times)[key + 1]) - static_cast<double>((*curve.times)[key]);
}

Eigen::VectorXd value_at(const Curve& curve, double time, bool before) {
  const std::vector<float>& times = *curve.times;
  // Files hold times in single precision. Rounded alike, 0.1 is the key at 0.1.
  const auto rounded = static_cast<float>(time);
  const std::size_t next = before ? keys_before(curve, rounded) : keys_until(curve, rounded);
  if (next == 0 || next == times.size()) return part_of_key(curve, next == 0 ? 0 : next - 1, kValue);
  const double from = static_cast<double>(times[next - 1]);
  const double seconds = seconds_after(curve, next - 1);
  return between_keys(curve, next - 1, seconds, (static_cast<double>(rounded) - from) / seconds);
}

}  // namespace

Eigen::VectorXd evaluate(const Curve& curve, double time, bool before) {
  Eigen::VectorXd value = value_at(curve, time, before);
  if (curve.shape.is_rotation) value = unit_quaternion(value).coeffs();
  return value;
}

Passage passage_at(const Curve& curve, float time) {
  constexpr double kStep = 1e-5, kMin = 1e-3;  // of the seconds between two keys, of a slope
  // On each side the value, its slope, and the mean slope to the next key.
  struct Side {
    Eigen::VectorXd value, slope;
    double change = 0.0;
  };
  const auto side = [&](std::size_t key, std::size_t from, bool before) {
    Side s{part_of_key(curve, key, kValue), Eigen::VectorXd::Zero(static_cast<Eigen::Index>(curve.width))};
    const bool holds = before ? key == 0 : key + 1 == curve.times->size();
    if (holds) return s;
    const double seconds = seconds_after(curve, from);
    const auto at = [&](double u) { return between_keys(curve, from, seconds, u); };
    const Eigen::VectorXd first = at(0.0), last = at(1.0);
    s.value = before ? last : first;
    s.slope = (before ? Eigen::VectorXd(last - at(1.0 - kStep)) : Eigen::VectorXd(at(kStep) - first)) /
              (kStep * seconds);
    s.change = (last - first).norm() / seconds;
    return s;
  };
  const std::size_t first = keys_before(curve, time), last = keys_until(curve, time) - 1;
  const Side before = side(first, first - 1, true);
  Side after = side(last, last, false);
  if (curve.shape.is_rotation && before.value.dot(after.value) < 0.0) {  // the same rotation
    after.value *= -1.0;
    after.slope *= -1.0;
  }
  const double size = std::max(before.value.norm(), after.value.norm());
  const double rounding = curve.shape.is_rotation ? 1e-6 : 1e-8;
  if ((after.value - before.value).norm() > rounding * size) return Passage::jump;
  const double slope = std::max({before.slope.norm(), after.slope.norm(), before.change, after.change});
  return (after.slope - before.slope).norm() > kMin * slope ? Passage::bend : Passage::smooth;
}

double turn_between(const Curve& curve, double from, double to) {
  if (curve.interpolation == Interpolation::step) return 0.0;
  const int steps = curve.interpolation == Interpolation::cubic_spline ? 8 : 1;
  double turn = 0.0;
  const std::size_t next = keys_until(curve, static_cast<float>(from));
  for (std::size_t key = next == 0 ? 0 : next - 1; key + 1 < curve.times->size(); ++key) {
    const auto start = static_cast<double>((*curve.times)[key]);
    if (start >= to) break;
    const double seconds = seconds_after(curve, key);
    if (!(seconds > 0.0)) continue;
    const double first = std::max(0.0, (from - start) / seconds),
                 last = std::min(1.0, (to - start) / seconds);
    const auto at = [&](int step) {
      return unit_quaternion(between_keys(curve, key, seconds, first + (last - first) * step / steps));
    };
    for (int step = 0; step < steps && first < last; ++step) turn += at(step).angularDistance(at(step + 1));
  }
  return turn;
}

Curve::Times CurveReader::read_times(int accessor) {
  Curve::Times& known = times_[accessor];
  if (known) return known;
  const AccessorReader reader(document_, accessor);
  if (reader.components() != 1 || reader.component_type() != kFloat) {
    document_.fail(reader.where(),
                   fmt::format("{} components of type {} for the times of keys, expected 1 of 5126",
                               reader.components(), reader.component_type()));
  }
  document_.claim(reader.count() * sizeof(float), reader.where());
  std::vector<float> times(reader.count());
  reader.read_floats({}, 1, times.data());
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i])) {
      document_.fail(reader.where(),
                     fmt::format("the time of key {} is {}, expected a finite number", i, times[i]));
    }
    if (i == 0 || times[i] > times[i - 1]) continue;
    if (times[i] < times[i - 1]) {
      document_.fail(reader.where(), fmt::format("the time of key {} is {}, expected more than {}", i,
                                                 times[i], times[i - 1]));
    }
    warnings_.add(
        fmt::format("{}: keys {} and {} at the same time, the value jumps", reader.where(), i - 1, i));
  }
  known = std::make_shared<const std::vector<float>>(std::move(times));
  return known;
}

std::optional<Curve> CurveReader::read(const Channel& channel, const CurveShape& shape) {
  Curve curve{read_times(channel.times), {}, 0, channel.interpolation, shape};
  if (curve.times->empty()) {
    warnings_.add(channel.where + ": no keys; it is ignored");
    return std::nullopt;
  }
  const AccessorReader reader(document_, channel.values);
  reader.expect_attribute(channel.where, {shape.components});
  const std::size_t parts = curve.interpolation == Interpolation::cubic_spline ? 3 : 1;
  const std::size_t count = curve.times->size() * parts * shape.elements;
  if (reader.count() != count) {
    document_.fail(reader.where(),
                   fmt::format("count {} for {}, expected {}: {} for each of {} keys", reader.count(),
                               channel.where, count, parts * shape.elements, curve.times->size()));
  }
  curve.width = static_cast<std::size_t>(shape.components) * shape.elements;
  const std::size_t floats = count * static_cast<std::size_t>(shape.components);
  document_.claim(floats * sizeof(float), channel.where);
  curve.values.resize(floats);
  reader.read_floats({}, shape.components, curve.values.data());
  if (!std::all_of(curve.values.begin(), curve.values.end(), [](float v) { return std::isfinite(v); }))
    document_.fail(reader.where(),
                   fmt::format("values of {} that are not finite, expected finite numbers", channel.where));
  return curve;
}

}  // namespace gatelight::scene::gltf
