#include "neural/reference/auxiliary.h"

#include <cmath>
#include <numbers>

#include "neural/reference/one_blob.h"

namespace gatelight::neural::reference {

namespace {

std::vector<double> coordinates(const AuxiliaryInput& input, const Point& point) {
  const auto vector = [](const auto& values) { return std::vector<double>(values.begin(), values.end()); };
  const bool blob = input.encoding == InputEncoding::one_blob;
  switch (input.source) {
    case InputSource::position:
      return vector(point.position);
    case InputSource::direction:
      return blob ? vector(spherical(point.direction)) : vector(point.direction);
    case InputSource::normal:
      return blob ? vector(spherical(point.normal)) : vector(point.normal);
    case InputSource::albedo:
      return vector(point.albedo);
    case InputSource::roughness:
      return {point.roughness};
  }
  return {};
}

}  // namespace

std::array<double, 2> spherical(const std::array<double, 3>& direction) {
  // Adding 0 turns -0 into 0: negating a direction can give (-0, -0, 1), which must be the pole.
  const double theta = std::atan2(std::hypot(direction[0], direction[1]), direction[2] + 0.0);
  const double phi = std::atan2(direction[1] + 0.0, direction[0] + 0.0);
  return {theta / std::numbers::pi, phi / (2.0 * std::numbers::pi)};
}

void append_auxiliary(const AuxiliaryInput& input, const Point& point, std::vector<double>& inputs) {
  const std::vector<double> x = coordinates(input, point);
  const bool is_direction = input.source == InputSource::direction || input.source == InputSource::normal;
  for (std::size_t c = 0; c < x.size(); ++c) {
    if (input.encoding == InputEncoding::identity) {
      inputs.push_back(x[c]);
    } else {
      inputs.resize(inputs.size() + input.size);
      one_blob(x[c], is_direction && c == 1, std::span(inputs).last(input.size));
    }
  }
}

}  // namespace gatelight::neural::reference
