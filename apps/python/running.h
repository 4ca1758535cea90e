#pragma once
// A renderer of Python: options, the scene, and what is built for it.

#include <pybind11/pybind11.h>

#include <atomic>
#include <memory>

#include "apps/python/picture_data.h"
#include "apps/python/scene_data.h"
#include "apps/reports/run_report.h"
#include "apps/settings/render_settings.h"
#include "renderer/render.h"

namespace gatelight::python {

/// The complete settings of a render of this scene. Throws BadOption.
apps::RenderSettings settings_for(const SceneData& scene, const pybind11::dict& keywords);

/// The picture with its recipe and statistics, and in the files of the options.
PicturePointer finish_picture(renderer::Picture picture, const renderer::RenderStatistics& statistics,
                              const apps::RenderSettings& settings, apps::RunReport report);

/// As Python's own warnings. Throws error_already_set where the user made them errors.
void show_warnings(const PictureData& picture);

class Running {
 public:
  Running(ScenePointer scene, const pybind11::dict& keywords);

  PicturePointer render(const pybind11::object& progress, const pybind11::object& stop);
  void set_camera(const pybind11::dict& keywords);
  void set_options(const pybind11::dict& keywords);
  /// Another thread may call it: the picture so far ends the render that is under way.
  void stop() { stop_ = true; }
  const ScenePointer& scene() const { return scene_; }

 private:
  void take(const pybind11::dict& keywords, const apps::RenderSettings& settings);
  void build(SceneContent copy);

  ScenePointer scene_;
  pybind11::dict keywords_;
  apps::RenderSettings settings_;
  std::shared_ptr<const scene::Scene> built_;  ///< outlives renderer_
  std::unique_ptr<renderer::Renderer> renderer_;
  std::uint64_t revision_ = 0;
  bool has_new_options_ = false;  ///< renderer_ does not know them yet
  std::atomic<bool> stop_ = false;
  std::atomic<bool> busy_ = false;
};

}  // namespace gatelight::python
