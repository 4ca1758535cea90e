#pragma once
// The frames of an animation: what all of them share, and the order of calls that the renderer needs.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/settings/render_settings.h"
#include "renderer/render.h"

namespace gatelight::apps {

class FrameSequence {
 public:
  /// Shows the scene at a time in seconds.
  using ShowTime = std::function<void(double seconds)>;

  /// Builds the renderer with frame 0, which decides what is chosen for the scene (the integrator) whichever
  /// frames are rendered, and chooses one soft sky for the whole animation. `displayed`: the frames are
  /// shown, and need an exposure. `scene`, which `show_time` changes, must outlive it. Throws as Renderer's
  /// constructor does.
  FrameSequence(const RenderSettings& settings, const scene::Scene& scene, ShowTime show_time,
                bool displayed);

  /// Those of all frames, with what was chosen for them.
  const RenderSettings& settings() const { return settings_; }
  const renderer::Renderer& renderer() const { return renderer_; }

  bool needs_exposure() const { return needs_exposure_; }
  /// Measures one exposure for the whole animation. Call it before begin() where it is needed.
  void measure_exposure(const std::function<bool()>& stop);
  /// The frames by which the exposure and the sky of the animation are chosen; the last one is its end.
  const std::vector<int>& sample() const { return sample_; }

  /// Makes the cache that the frames share.
  void begin();
  /// Takes the cache and the light of a file. Returns the frame that the file ends with, if it is of frames.
  std::optional<int> begin_from(const std::string& file);
  /// Shows the renderer a frame, and where all is in the frames beside it if layers need that.
  void show(int frame);
  renderer::Picture render(int frame, const renderer::Callbacks& callbacks);
  /// Writes what the frames after the last one need.
  void write(const std::string& file) const { renderer_.write_frame(file, settings_.exposure); }

 private:
  renderer::Renderer build(const scene::Scene& scene);
  void choose_sky();
  void keep_choices();
  void show_time(int frame);
  void move_to(int frame);

  RenderSettings settings_;
  ShowTime show_time_;
  bool needs_exposure_;
  std::vector<int> sample_;
  std::optional<int> shown_;  ///< by the renderer
  renderer::Renderer renderer_;
};

}  // namespace gatelight::apps
