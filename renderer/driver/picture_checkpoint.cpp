#include "renderer/driver/picture_checkpoint.h"

#include <exception>
#include <filesystem>
#include <new>
#include <span>
#include <vector>

#include "base/errors.h"
#include "base/file/atomic_file.h"
#include "base/file/digest.h"
#include "renderer/cache/cache_backend.h"
#include "renderer/cache/cache_model.h"
#include "renderer/fingerprint/deciding_options.h"

namespace gatelight::renderer {
namespace {

CheckpointIdentity identity_of(const PreparedPicture& picture) {
  NamedTexts machine = {{"isa", picture.world->accel.isa()}};
  if (uses_cache(picture.options.integrator)) machine.push_back({"kernels", cache_machine(picture.options)});
  NamedTexts decisive = deciding_options(picture.options, picture.view, machine);
  // The fingerprint does not include names, which decide here.
  const std::vector<std::uint8_t> members = picture.world->light_groups.members();
  if (!members.empty())
    decisive.push_back({"lights-of-groups", hexadecimal(digest_of(std::as_bytes(std::span(members))))});
  if (picture.scene.shutter.is_open) decisive.push_back({"shutter", shutter_digest(picture.scene)});
  return {decisive, picture.fingerprint(), picture.scene.instances.size()};
}

}  // namespace

void write_output(const RenderContext& context, bool again, const std::function<void()>& write) {
  if (!context.team.finishes()) return;
  const Callbacks& callbacks = context.callbacks;
  if (!callbacks.output_failed) return write();
  try {
    write();
  } catch (const OutputError&) {
    callbacks.output_failed(std::current_exception(), again);
  } catch (const std::bad_alloc&) {
    callbacks.output_failed(std::current_exception(), again);
  }
}

void check_output(const RenderContext& context, const std::string& file) {
  if (context.team.finishes()) check_writable(file);
}

PictureCheckpoint::PictureCheckpoint(const RenderContext& context, Film& film, RenderStatistics& earlier)
    : context_(context), options_(context.picture.options.checkpoint) {
  if (options_.file.empty()) return;
  const PictureTeam& team = context.team;
  identity_ = identity_of(context.picture);
  check_output(context, options_.file);
  if (!options_.resume || !team.agreed(team.finishes() && std::filesystem::exists(options_.file))) return;
  shared_ = team.shared(options_.file);
  found_.emplace(shared_.path);
  found_->expect(*identity_, context.picture.options.spp);
  found_->restore(film, earlier);
}

bool PictureCheckpoint::is_due() const {
  return is_kept() && context_.team.agreed(seconds_since(last_) >= options_.every_seconds);
}

void PictureCheckpoint::write(Phase phase, int samples, Film& film, const Training* training,
                              const RenderStatistics& sum, bool again) {
  if (!is_kept()) return;
  context_.team.gather(film);
  last_ = Clock::now();
  CheckpointProgress progress{.phase = phase, .samples = samples};
  if (training) {
    progress.first_step = training->first_step();
    progress.has_training_samples = training->has_training_samples();
  }
  write_output(context_, again, [&] {
    const neural::TrainingOptions learning = training_options(context_.picture.options);
    std::optional<CacheState> state;
    std::optional<CheckpointCache> cache;
    if (training) {
      state = training->session().export_state();
      cache.emplace(CheckpointCache{*state, training->session().model(), learning});
    }
    write_checkpoint(options_.file, *identity_, progress, sum, film, cache);
  });
  last_ = Clock::now();  // after a failure too, so that the next try is not immediate
}

}  // namespace gatelight::renderer
