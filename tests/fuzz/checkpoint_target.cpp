// --checkpoint with --resume: as cache_file_target.cpp, with the film beside the cache.

#include <cmath>

#include "base/errors.h"
#include "renderer/driver/checkpoint.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/made_cache.h"

namespace gatelight::fuzz {
namespace {

constexpr int kSamples = 8;

void resume_from(const std::filesystem::path& path) {
  const MadeCache& made = made_cache();
  read_or_refuse<CacheFileError>([&] {
    renderer::Checkpoint checkpoint(path);
    checkpoint.expect(made_identity(), kSamples);
    renderer::Film film = made_film();
    renderer::RenderStatistics statistics;
    checkpoint.restore(film, statistics);
    const renderer::Picture picture = film.resolve();
    for (const float value : picture.layers.front().values) {
      if (std::isnan(value)) throw Violation("a picture with NaN");
    }
    if (!checkpoint.has_cache()) return;
    const auto model = made.model(checkpoint.cache_setup());
    checkpoint.expect_model(*model, made.training());
    made.use(model, checkpoint.read_cache(*model, made.training()));
  });
}

}  // namespace

void checkpoint(Bytes bytes) {
  static const InputFile file("checkpoint");
  resume_from(file.write(bytes));
  resume_from(file.write(with_right_digest(bytes)));
}

}  // namespace gatelight::fuzz
