#pragma once
// Statistics of a run: filled by the renderer, written by the application.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gatelight::renderer {

/// A sample that was not finite. It can be reproduced from these values.
struct NonFiniteSample {
  int x = 0;
  int y = 0;
  std::uint32_t sample = 0;
  std::uint32_t seed = 0;
};

struct RayCounts {
  std::uint64_t camera = 0;
  std::uint64_t bounce = 0;
  std::uint64_t shadow = 0;
  double seconds = 0.0;           ///< of tracing, summed over threads
  std::uint64_t walk = 0;         ///< the part of `bounce` between events in media
  std::uint64_t ended_walks = 0;  ///< paths that ended after kMaxWalk events in a medium

  void add(const RayCounts& other) {
    camera += other.camera;
    bounce += other.bounce;
    shadow += other.shadow;
    seconds += other.seconds;
    walk += other.walk;
    ended_walks += other.ended_walks;
  }
  void subtract(const RayCounts& other) {
    camera -= other.camera;
    bounce -= other.bounce;
    shadow -= other.shadow;
    seconds -= other.seconds;
    walk -= other.walk;
    ended_walks -= other.ended_walks;
  }
};

/// The times by which CacheOptions::choose_device chose.
struct DeviceTrial {
  std::string device;        ///< the one that was tried besides the CPU
  double cpu_seconds = 0.0;  ///< of a step
  double device_seconds = 0.0;
};

/// Statistics of the cache; zero for integrators without one. Seconds are wall time.
struct CacheStatistics {
  int steps = 0;  ///< trained for this picture, excluding those of a loaded cache
  int steps_wanted = 0;
  bool steps_chosen = false;   ///< by the renderer, from pixels and samples, instead of by the caller
  std::uint64_t records = 0;   ///< trained with
  std::uint64_t rejected = 0;  ///< left out because they were not finite
  std::uint64_t unstored = 0;  ///< on surfaces without storage
  std::uint64_t training_paths = 0;
  std::uint64_t touched_nodes = 0;  ///< by the last step
  double loss = 0.0;                ///< mean of the last steps, at most 64
  double scout_seconds = 0.0;
  double setup_seconds = 0.0;  ///< from scouting to the first step: layout, parameters, optimiser
  double train_seconds = 0.0;  ///< the whole phase, without scouting and setup
  // Its parts, which overlap: the time of all threads, divided by their number.
  double train_trace_seconds = 0.0;
  double train_query_seconds = 0.0;   ///< answers at the ends of training paths
  double train_step_seconds = 0.0;    ///< everything else: the steps and waiting threads
  double render_trace_seconds = 0.0;  ///< the same for the passes
  double render_query_seconds = 0.0;
  std::uint64_t queries = 0;           ///< of the rendering phase
  std::uint64_t negative_answers = 0;  ///< points with a negative channel, which is clamped to zero
  std::uint64_t unstored_hits = 0;     ///< vertices without storage, where paths continued
  std::uint64_t nodes = 0;
  std::uint64_t surfaces_stored = 0;    ///< sides of instances with storage
  std::uint64_t surfaces_possible = 0;  ///< two per instance if its material shows both
  float node_spacing = 0.0f;            ///< metres, resolved
  float target_scale = 1.0f;            ///< targets are radiance times this
  double records_per_path = 0.0;        ///< found by scouting
  bool direction_input = false;         ///< inputs of the network besides the features
  bool normal_input = false;
  bool albedo_input = false;
  std::vector<std::uint64_t> resolution_histogram;  ///< instances by R
  std::size_t parameter_bytes = 0;
  std::size_t optimizer_bytes = 0;
  std::size_t layout_bytes = 0;
  std::string backend;
  std::string device;                ///< CacheOptions::device, as it was given or chosen
  std::optional<DeviceTrial> trial;  ///< if a device was tried
  double light_change = 0.0;         ///< in an animation, since the previous frame (cache/light_change.h)
  std::string diverged;              ///< why training returned to its last good state (`steps`); else empty
};

/// Statistics of one of several processes that make a picture together.
struct ProcessStatistics {
  int threads = 0;
  std::uint64_t samples = 0;  ///< camera paths of the picture
  std::uint64_t training_paths = 0;
  std::uint64_t record_bytes = 0;  ///< of this process's training records, packed
  double seconds = 0.0;            ///< since the start of the picture
  std::uint64_t bytes_sent = 0;    ///< to all other processes together
  double waiting_seconds = 0.0;    ///< for other processes, including transfers
};

/// The reason why rendering ended.
enum class EndedBy : std::uint8_t { spp, max_error, time_limit, caller, device };

struct RenderStatistics {
  double build_seconds = 0.0;  ///< acceleration structure, lights, textures
  double render_seconds = 0.0;
  double resumed_seconds = 0.0;  ///< part of render_seconds from a checkpoint
  double denoise_seconds = 0.0;
  std::string denoiser;         ///< name and version of the denoiser that ran; empty: none
  std::string denoise_failure;  ///< why denoising failed; else empty
  double cryptomatte_seconds = 0.0;
  int width = 0;
  int height = 0;
  int spp = 0;                ///< finished in every pixel
  std::uint64_t samples = 0;  ///< total of camera paths
  int threads = 0;
  std::string isa;                         ///< that Embree chose
  std::vector<std::string> warnings;       ///< about input that could not be used as given
  std::optional<double> bounces_of_paths;  ///< by which the integrator was chosen, if it was
  double steps_in_media = 0.0;             ///< of these paths, between events in a medium
  /// By which Watertight::automatic was chosen, if it was: the light if nothing cast a shadow, over the
  /// picture's.
  std::optional<double> light_behind_walls;
  RayCounts rays;
  std::size_t geometry_bytes = 0;
  std::size_t bvh_bytes = 0;
  std::size_t texture_bytes = 0;
  std::size_t light_bytes = 0;
  std::uint64_t nonfinite = 0;
  std::vector<NonFiniteSample> nonfinite_samples;  ///< the first 16, in the order of (y, x, sample)
  std::uint64_t clamped = 0;
  CacheStatistics cache;
  std::optional<double> estimated_error;  ///< of the picture, relative RMS (metrics/estimated_error.h)
  EndedBy ended_by = EndedBy::spp;
  bool interrupted = false;  ///< stopped before `spp` was reached, by the time limit or by the caller
  std::vector<ProcessStatistics> team;  ///< of each process, if there are several
  double reused = 0.0;                  ///< share of the pixels that reused samples of earlier frames
  std::string device_lost;              ///< why the device was lost, if that ended the picture; else empty
};

}  // namespace gatelight::renderer
