#include "renderer/metrics/merge.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "base/finite_float.h"
#include "base/to_number.h"
#include "renderer/image/cryptomatte.h"

namespace gatelight::renderer {
namespace {

enum class Rule : std::uint8_t { mean, sum, variance, error, first };

Rule rule_of(const Picture& picture, const std::string& layer) {
  if (layer == "samples") return Rule::sum;
  if (layer.starts_with("variance")) return Rule::variance;
  if (layer == "error") return Rule::error;
  if (layer == "primitive" || layer == "instance" || is_cryptomatte(picture, layer)) return Rule::first;
  return Rule::mean;
}

/// Parses the samples per pixel of a picture's metadata.
std::uint64_t samples_per_pixel(const NamedPicture& named, const std::string& text) {
  const std::uint64_t spp = to_number<std::uint64_t>(text).value_or(0);
  if (spp == 0) {
    throw InputError(
        fmt::format("'{}' says it has '{}' samples per pixel, expected a positive number", named.name, text));
  }
  return spp;
}

std::string shape(const Picture& picture) {
  std::string text = fmt::format("{}x{} pixels at {},{} of {}x{}", picture.width, picture.height, picture.x0,
                                 picture.y0, picture.full_width, picture.full_height);
  for (const Layer& layer : picture.layers) {
    text += fmt::format(", {}({})", layer.name, fmt::join(layer.channels, ""));
  }
  return text;
}

}  // namespace

void PictureMerger::start(const NamedPicture& named) {
  merged_ = named.picture;
  first_name_ = named.name;
  weighted_ = named.picture.metadata.contains("spp");
  for (Layer& layer : merged_.layers) {
    layer.full_precision = true;
    sums_.emplace_back(layer.values.size(), 0.0);
  }
}

void PictureMerger::require_same_shape(const NamedPicture& named) const {
  const std::string first = shape(merged_);
  const std::string other = shape(named.picture);
  if (first != other) {
    throw InputError(fmt::format("the pictures cannot be merged: '{}' has {}, '{}' has {}", first_name_,
                                 first, named.name, other));
  }
  const auto integrator = merged_.metadata.find("integrator");
  const auto other_integrator = named.picture.metadata.find("integrator");
  if (integrator != merged_.metadata.end() && other_integrator != named.picture.metadata.end() &&
      integrator->second != other_integrator->second) {
    throw InputError(
        fmt::format("the pictures cannot be merged: '{}' was made by `integrator` {}, '{}' by {}",
                    first_name_, integrator->second, named.name, other_integrator->second));
  }
  if (weighted_ == named.picture.metadata.contains("spp")) return;
  throw InputError(
      fmt::format("the pictures cannot be weighted: '{}' states its samples per pixel, '{}' does not",
                  weighted_ ? first_name_ : named.name, weighted_ ? named.name : first_name_));
}

void PictureMerger::merge_metadata(const Picture& picture) {
  const auto seed = merged_.metadata.find("seed");
  const auto other_seed = picture.metadata.find("seed");
  if (seed != merged_.metadata.end() && other_seed != picture.metadata.end()) {
    seed->second += "," + other_seed->second;
  }
  std::erase_if(merged_.metadata, [&](const auto& entry) {
    if (entry.first == "seed") return other_seed == picture.metadata.end();
    if (entry.first == "spp") return false;
    const auto other = picture.metadata.find(entry.first);
    return other == picture.metadata.end() || other->second != entry.second;
  });
}

void PictureMerger::add(const NamedPicture& named) {
  if (sums_.empty()) {
    start(named);
  } else {
    require_same_shape(named);
    merge_metadata(named.picture);
  }
  double weight = 1.0;
  if (weighted_) {
    const std::uint64_t spp = samples_per_pixel(named, named.picture.metadata.at("spp"));
    if (__builtin_add_overflow(spp_, spp, &spp_)) {
      throw InputError(
          fmt::format("'{}' says it has {} samples per pixel: their sum exceeds 64 bits", named.name, spp));
    }
    weight = static_cast<double>(spp);
  }
  weight_ += weight;
  for (std::size_t l = 0; l < sums_.size(); ++l) {
    const Rule rule = rule_of(merged_, merged_.layers[l].name);
    if (rule == Rule::first) continue;
    const bool squared = rule == Rule::variance || rule == Rule::error;
    const double factor = rule == Rule::sum ? 1.0 : squared ? weight * weight : weight;
    const std::vector<float>& values = named.picture.layers[l].values;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto value = static_cast<double>(values[i]);
      sums_[l][i] += factor * (rule == Rule::error ? value * value : value);
    }
  }
}

Picture PictureMerger::finish() const {
  Picture picture = merged_;
  for (std::size_t l = 0; l < sums_.size(); ++l) {
    const Rule rule = rule_of(picture, picture.layers[l].name);
    if (rule == Rule::first) continue;
    const bool squared = rule == Rule::variance || rule == Rule::error;
    const double divisor = rule == Rule::sum ? 1.0 : squared ? weight_ * weight_ : weight_;
    for (std::size_t i = 0; i < sums_[l].size(); ++i) {
      const double value = sums_[l][i] / divisor;
      picture.layers[l].values[i] = finite_float(rule == Rule::error ? std::sqrt(value) : value);
    }
  }
  if (weighted_) picture.metadata["spp"] = std::to_string(spp_);
  return picture;
}

Picture merge_pictures(const std::vector<NamedPicture>& pictures) {
  PictureMerger merger;
  for (const NamedPicture& picture : pictures) merger.add(picture);
  return merger.finish();
}

}  // namespace gatelight::renderer
