#include "renderer/run/checkpoint_keeper.h"

#include <filesystem>
#include <utility>

#include "renderer/machine/atomic_file.h"

namespace gatelight::renderer {

CheckpointKeeper::CheckpointKeeper(const CheckpointOptions& options, CheckpointIdentity identity)
    : options_(options), identity_(std::move(identity)) {
  check_writable(options_.file);
}

std::optional<Checkpoint> CheckpointKeeper::find(int spp) const {
  if (!options_.resume || !std::filesystem::exists(options_.file)) return std::nullopt;
  std::optional<Checkpoint> checkpoint(options_.file);
  checkpoint->expect(identity_, spp);
  return checkpoint;
}

bool CheckpointKeeper::due() const {
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - last_;
  return passed.count() >= options_.every_seconds;
}

void CheckpointKeeper::write(const CheckpointProgress& progress, const RenderStatistics& statistics,
                             const Film& film, const CacheSession* session,
                             const neural::TrainingOptions& training) {
  last_ = std::chrono::steady_clock::now();  // after one that fails, too: the next is not tried at once
  if (session) {
    const CacheState state = session->export_state();
    write_checkpoint(options_.file, identity_, progress, statistics, film,
                     CheckpointCache{state, session->model(), training});
  } else {
    write_checkpoint(options_.file, identity_, progress, statistics, film, std::nullopt);
  }
  last_ = std::chrono::steady_clock::now();
}

}  // namespace gatelight::renderer
