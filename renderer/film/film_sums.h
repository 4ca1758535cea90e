#pragma once
// The exact sums of a film. One visit of its planes serves checkpoints, other processes and the memory
// estimate.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "base/platform/huge_buffer.h"
#include "renderer/distributed/packing.h"
#include "renderer/film/first_hit.h"

namespace gatelight::renderer {

/// The sums of a pixel have no padding, so that equal sums are equal bytes.
struct RadianceSum {
  std::array<double, 3> sum{};
  std::array<double, 3> square{};
  std::uint32_t count = 0;
  std::uint32_t taken = 0;  ///< including dropped samples
};

/// The samples with even numbers.
struct HalfSum {
  std::array<double, 3> sum{};
  std::uint64_t count = 0;
};

/// In single precision: rounding does not matter for the denoiser.
struct GuideSum {
  std::array<float, 3> albedo{};
  std::array<float, 3> normal{};
};

/// Planes in rows from the top; one that is not kept is empty. New ones are zero, whose memory the first
/// samples touch.
struct FilmSums {
  HugeBuffer<RadianceSum> radiance;
  HugeBuffer<HalfSum> half;
  HugeBuffer<GuideSum> guides;
  HugeBuffer<double> alpha;
  HugeBuffer<FirstHitSum> first_hits;
  HugeBuffer<std::array<double, 3>> parts;  ///< all parts of a pixel, then those of the next

  /// Calls visit(name, plane) for each plane of `sums`, a FilmSums or a const one.
  template <class Sums, class Visit>
  static void each_plane(Sums& sums, Visit&& visit) {
    visit("radiance", sums.radiance);
    visit("half", sums.half);
    visit("guides", sums.guides);
    visit("alpha", sums.alpha);
    visit("first_hits", sums.first_hits);
    visit("parts", sums.parts);
  }

  /// Appends the sums of the pixel with this index.
  void pack(std::size_t pixel, Packer& packer) const {
    each_plane(*this, [&](const char*, const auto& plane) { packer.add_all(of_pixel(plane, pixel)); });
  }
  /// Replaces the sums of the pixel.
  void unpack(std::size_t pixel, Unpacker& unpacker) {
    each_plane(*this, [&](const char*, auto& plane) { unpacker.read_all(of_pixel(plane, pixel)); });
  }
  std::size_t bytes() const {
    std::size_t bytes = 0;
    each_plane(*this,
               [&](const char*, const auto& plane) { bytes += std::as_bytes(std::span(plane)).size(); });
    return bytes;
  }

 private:
  /// The elements of a pixel in a plane.
  template <class Plane>
  auto of_pixel(Plane& plane, std::size_t pixel) const {
    const std::size_t count = plane.size() / radiance.size();
    return std::span(plane).subspan(pixel * count, count);
  }
};

}  // namespace gatelight::renderer
