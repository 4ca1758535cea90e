// write_seeds FOLDER: the first files of the corpora whose formats are only ours. Run it after a format has
// changed.

#include <cstdio>
#include <filesystem>

#include "renderer/cache/cache_file.h"
#include "renderer/film/camera_sample.h"
#include "tests/fuzz/made_cache.h"

using namespace gatelight;

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: gatelight_fuzz_write_seeds tests/fuzz/corpus\n");
    return 1;
  }
  const std::filesystem::path corpus = argv[1];
  const fuzz::MadeCache& made = fuzz::made_cache();
  const renderer::CacheState state = made.state();
  const auto model = made.model(state.setup);
  for (const char* name : {"cache_file", "checkpoint"}) std::filesystem::create_directories(corpus / name);
  renderer::write_cache_file(corpus / "cache_file" / "cache", state, *model, made.training(),
                             {made.options, made.options.ao_distance}, fuzz::kFingerprint);

  renderer::Film film = fuzz::made_film();
  for (int pixel = 0; pixel < 4; ++pixel) {
    film.add(film.take({pixel % 2, pixel / 2}), Color(0.25f, 0.5f, 1.0f));
    renderer::FirstHit hit;
    hit.hit = true;
    hit.normal = Vec3(0, 0, 1);
    hit.depth = 2.0f;
    film.add(film.take({pixel % 2, pixel / 2}), hit);
  }
  renderer::RenderStatistics statistics;
  statistics.render_seconds = 0.5;
  statistics.nonfinite_samples = {{1, 0, 3, 4}};
  const neural::TrainingOptions training = made.training();
  using renderer::Phase;
  renderer::write_checkpoint(corpus / "checkpoint" / "plain", fuzz::made_identity(), {Phase::render, 1},
                             statistics, film, {});
  renderer::write_checkpoint(corpus / "checkpoint" / "cached", fuzz::made_identity(), {Phase::render, 1},
                             statistics, film, renderer::CheckpointCache{state, *model, training});
  renderer::write_checkpoint(corpus / "checkpoint" / "training", fuzz::made_identity(), {Phase::train, 0, 3},
                             {}, film, renderer::CheckpointCache{state, *model, training});
  return 0;
}
