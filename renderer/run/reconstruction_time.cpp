#include "renderer/run/reconstruction_time.h"

#include <algorithm>

#include "renderer/film/film.h"
#include "renderer/machine/clock.h"
#include "renderer/run/finished_picture.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {
namespace {

/// As wide as the windows that the kernel fits together need; as high as the picture, because threads share
/// its rows.
constexpr int kWidth = 128;
constexpr int kMostRows = 1024;
constexpr int kSamplesOfNoise = 4;

Film film_of_noise(int width, int height, const RenderOptions& options) {
  Film film({0, 0, width, height}, width, height, film_aovs(options));
  std::uint32_t state = 1;
  const auto next = [&] {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 8) * 0x1p-24f;
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int s = 0; s < kSamplesOfNoise; ++s) {
        FirstHit first;
        first.guide.hit = true;
        first.guide.depth = 1.0f + next();
        first.guide.normal = {0.0f, 0.0f, 1.0f};
        first.guide.albedo.setConstant(0.5f);
        first.guided = true;
        first.cache_radiance.setConstant(next());
        const PixelSample sample = film.take({x, y});
        film.add(sample, first);
        film.add(sample, Color(next(), next(), next()));
      }
    }
  }
  return film;
}

}  // namespace

double expect_reconstruct_seconds(const PixelRect& region, const RenderOptions& options,
                                  tbb::task_arena& arena) {
  const int width = std::min(region.width(), kWidth), height = std::min(region.height(), kMostRows);
  RenderOptions of_noise = options;
  // A file would be read, and that does not grow with the picture.
  if (options.background.kind == BackgroundOptions::Kind::file)
    of_noise.background.kind = BackgroundOptions::Kind::color;
  const Film film = film_of_noise(width, height, of_noise);
  const Clock::time_point start = Clock::now();
  finished_picture(film, of_noise, arena);
  const double all = static_cast<double>(region.width()) * region.height();
  return seconds_since(start) * all / (static_cast<double>(width) * height);
}

}  // namespace gatelight::renderer
