#include "renderer/settings/presets.h"

namespace gatelight::renderer {
namespace {

/// A finished picture: training uses the picture's samples, and the picture is denoised. Steps are chosen by
/// the picture's pixels and samples.
void set_finished(RenderOptions& options, int spp) {
  options.integrator = Integrator::nrc;
  options.choose_integrator = true;
  options.spp = spp;
  options.spp_of_paths = spp + spp / 2;
  options.denoise.denoiser = DenoiserKind::automatic;
  options.glass_shadows = GlassShadows::straight;
  options.watertight = Watertight::automatic;
  options.sampler = SamplerKind::screen;
  // Chosen by the error after denoising (renderer/cache/README.md). Twice the steps of half the records, and
  // a learning rate that falls soon, keep the overall brightness stable.
  CacheOptions& cache = options.cache;
  cache.source = TrainingSource::picture;
  cache.query_at = QueryAt::spread;
  cache.spread_threshold = 0.3f;
  cache.component = CachedComponent::no_delta;
  cache.self_training.start_step = -1;
  cache.batch = 2048;
  cache.training.adam.decay_steps = 20.0f;
}

}  // namespace

void apply_preset(CachePreset preset, RenderOptions& options) {
  CacheOptions& cache = options.cache;
  switch (preset) {
    case CachePreset::bare:
      options.integrator = Integrator::nrc;
      options.spp = 4;
      options.glass_shadows = GlassShadows::straight;
      cache.query_at = QueryAt::primary;
      cache.component = CachedComponent::no_delta;
      break;
    case CachePreset::preview:
      set_finished(options, 4);
      options.denoise.prefilter = Prefilter::fast;
      break;
    case CachePreset::standard:
      set_finished(options, 8);
      break;
    case CachePreset::final:
      set_finished(options, 48);
      break;
    case CachePreset::paper_nao:
    case CachePreset::paper_nrc: {
      const bool ao = preset == CachePreset::paper_nao;
      options.integrator = ao ? Integrator::nao : Integrator::nrc;
      options.width = 1920;
      options.height = 1080;
      options.spp = 1;
      cache = CacheOptions{};
      cache.train_steps = ao ? 128 : 1024;
      cache.batch = 49152;
      cache.path_length = 4;
      cache.candidates = 16;
      cache.self_training.start_step = -1;
      cache.gate.features = ao ? 2 : 8;
      cache.gate.stack = {neural::kAdaptive, 1};
      cache.gate.rule = neural::ResolutionRule::paper;
      cache.gate.cluster = false;
      cache.hash_grid.levels = 8;
      cache.hash_grid.features = 4;
      cache.hash_grid.base_resolution = 2;
      cache.mlp.width = 32;
      cache.mlp.hidden_layers = 2;
      cache.mlp.leaky_slope = 0.01f;
      cache.mlp.biases = false;
      cache.training.loss = neural::Loss::l2;
      cache.training.adam.learning_rate = 1e-2f;
      cache.training.average.network = false;
      cache.training.average.features = false;
      cache.training.adam.decay_steps = 0.0f;
      cache.training.start_at_mean = false;
      cache.training.feature_step = neural::FeatureStep::per_triangle;
      cache.min_roughness = 0.0f;
      cache.component = CachedComponent::all;
      cache.query_at = QueryAt::primary;
      cache.view = CacheOutput::cache;
      break;
    }
  }
  cache.choose_device = true;
}

void apply_preset_of_frames(CachePreset preset, RenderOptions& options) {
  apply_preset(preset, options);
  const bool standard = preset == CachePreset::standard;
  if (!standard && preset != CachePreset::preview && preset != CachePreset::final) return;
  options.watertight = Watertight::on;  // a camera may go into a room that is closed
  for (int* const samples : {&options.spp, &options.spp_of_paths}) *samples = (3 * *samples + 3) / 4;
  if (standard) options.denoise.prefilter = Prefilter::fast;
}

}  // namespace gatelight::renderer
