#include "apps/python/running.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <atomic>
#include <memory>
#include <utility>

#include "apps/job/finished_picture.h"
#include "apps/python/keywords.h"
#include "apps/python/module.h"
#include "apps/python/waiting.h"
#include "apps/settings/complete_settings.h"
#include "apps/terminal/terminal.h"
#include "apps/terminal/text.h"
#include "base/clock.h"
#include "base/errors.h"
#include "renderer/denoise/oidn_library.h"
#include "renderer/render.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;
using apps::Option;
using apps::OptionStage;

/// A flag during its lifetime.
class Busy {
 public:
  explicit Busy(std::atomic<bool>& flag) : flag_(flag) {
    if (flag_.exchange(true))
      throw BadOption("the renderer is busy in another thread, expected one render at a time");
  }
  ~Busy() { flag_ = false; }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;

 private:
  std::atomic<bool>& flag_;
};

/// A renderer of Python: options, the scene, and what is built for it.
class Running {
 public:
  Running(ScenePointer scene, const py::dict& keywords);

  PicturePointer render(const py::object& progress, const py::object& stop);
  void set_camera(const py::dict& keywords);
  void set_options(const py::dict& keywords);
  /// Another thread may call it: the picture so far ends the render that is under way.
  void stop() { stop_ = true; }
  const ScenePointer& scene() const { return scene_; }

 private:
  void take(const py::dict& keywords, const apps::RenderSettings& settings);
  void build(SceneContent copy);

  ScenePointer scene_;
  py::dict keywords_;
  apps::RenderSettings settings_;
  std::shared_ptr<const scene::Scene> built_;  ///< outlives renderer_
  std::unique_ptr<renderer::Renderer> renderer_;
  std::uint64_t revision_ = 0;
  bool has_new_options_ = false;  ///< renderer_ does not know them yet
  std::atomic<bool> stop_ = false;
  std::atomic<bool> busy_ = false;
};

}  // namespace

apps::RenderSettings settings_for(const SceneData& scene, const py::dict& keywords) {
  apps::RenderSettings settings = read_keywords(keywords);
  require_given(
      settings, [](const Option& option) { return option.marks.stage != OptionStage::program; },
      "is not available in Python", "`gatelight render` for it");
  require_given(
      settings, [](const Option& option) { return option.marks.stage != OptionStage::load; },
      "applies to loading", "it in gatelight.load");
  settings.scene = scene.source.path;
  settings.load = scene.loading.load;
  if (!settings.given.contains("fps")) settings.frames.fps = scene.loading.frames.fps;
  if (!settings.given.contains("shutter")) settings.frames.shutter = scene.loading.frames.shutter;
  if (settings.frames.any()) settings.load.time.reset();
  apps::apply_display_defaults(settings);
  apps::complete_settings(settings);
  // The scene is loaded: its file may be gone.
  const std::string path = std::exchange(settings.scene, "");
  apps::check_inputs(settings);
  settings.scene = path;
  apps::check_outputs(settings);
  if (settings.render.camera.name == "all" && !settings.render.camera.look_at)
    throw BadOption({"camera", "all", "is for several pictures", "one camera"});
  if (scene.shown) settings.load.time = scene.shown;
  return settings;
}

PicturePointer finish_picture(renderer::Picture picture, const renderer::RenderStatistics& statistics,
                              const apps::RenderSettings& settings, apps::RunReport report) {
  apps::require_good_end(statistics, false);
  auto data = std::make_shared<PictureData>();
  report.statistics = statistics;
  for (const std::vector<std::string>& more : {statistics.warnings, apps::warnings_of(statistics)})
    report.warnings.insert(report.warnings.end(), more.begin(), more.end());
  data->image = apps::finish_picture(picture, settings, statistics, report.total_seconds, report);
  data->picture = std::move(picture);
  apps::write_pictures(data->picture, settings.outputs, data->image);
  data->statistics = apps::stats_json(settings, report);
  data->warnings = report.warnings;
  if (!settings.stats.empty()) apps::write_text(settings.stats, data->statistics);
  return data;
}

void show_warnings(const PictureData& picture) {
  for (const std::string& text : picture.warnings)
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

Running::Running(ScenePointer scene, const py::dict& keywords)
    : scene_(std::move(scene)), keywords_(keywords), settings_(settings_for(*scene_, keywords_)) {}

void Running::build(SceneContent copy) {
  renderer_.reset();
  built_.reset();
  built_ = std::make_shared<const scene::Scene>(finish_scene(*scene_, std::move(copy)));
  renderer_ = std::make_unique<renderer::Renderer>(*built_, settings_.render);
}

PicturePointer Running::render(const py::object& progress, const py::object& stop) {
  const Busy busy(busy_);
  if (settings_.frames.range)
    throw BadOption({"frames", "", "they are several pictures", "gatelight.frames()"});
  stop_ = false;
  const Clock::time_point start = Clock::now();
  const bool changed = !renderer_ || revision_ != scene_->revision;
  if (scene_->shown) settings_.load.time = scene_->shown;
  SceneContent copy;
  if (changed) copy = *scene_;
  revision_ = scene_->revision;
  apps::RunReport report;
  report.command = {"gatelight.render"};
  report.load_seconds = scene_->load_seconds;
  PicturePointer picture;
  Waiting waiting(progress, stop, &stop_);
  waiting.run([&] {
    if (settings_.render.denoise.denoiser == renderer::DenoiserKind::oidn)
      renderer::load_oidn(settings_.render.denoise.library);
    if (changed) {
      build(std::move(copy));
    } else if (has_new_options_) {
      renderer_->set_options(settings_.render);
    }
    has_new_options_ = false;
    apps::RenderSettings settings = settings_;
    renderer::use_chosen(settings.render, renderer_->chosen());
    report.warnings = built_->warnings;
    renderer::Picture made = renderer_->render(waiting.callbacks());
    report.total_seconds = seconds_since(start);
    picture = finish_picture(std::move(made), renderer_->statistics(), settings, report);
  });
  show_warnings(*picture);
  return picture;
}

void Running::set_camera(const py::dict& keywords) {
  const Busy busy(busy_);
  require_given(
      read_keywords(keywords),
      [](const Option& option) { return option.marks.of_view || option.name == "view-file"; },
      "is not an option of the view");
  py::dict merged = keywords_.attr("copy")();
  replace_keywords(merged, keywords);
  const apps::RenderSettings settings = settings_for(*scene_, merged);
  if (renderer_ && !has_new_options_) renderer_->set_camera(settings.render.camera);
  take(merged, settings);
}

void Running::set_options(const py::dict& keywords) {
  const Busy busy(busy_);
  py::dict merged = keywords_.attr("copy")();
  replace_keywords(merged, keywords);
  const apps::RenderSettings settings = settings_for(*scene_, merged);
  take(merged, settings);
  has_new_options_ = true;
}

void Running::take(const py::dict& keywords, const apps::RenderSettings& settings) {
  keywords_ = keywords;
  settings_ = settings;
}

void add_renderer(py::module_& module) {
  py::class_<Running> renderer(module, "Renderer",
                               "Renders one scene several times. Its data (the acceleration structure, "
                               "lights, textures) is kept until the scene changes.");
  renderer.def(py::init([](const ScenePointer& scene, const py::kwargs& options) {
                 return std::make_unique<Running>(scene, options);
               }),
               py::arg("scene"), "Options are those of gatelight.render.");
  renderer.def("render", &Running::render, py::kw_only(), py::arg("progress") = py::none(),
               py::arg("stop") = py::none(),
               "Renders a picture. If another thread calls stop(), it is the picture so far.");
  renderer.def(
      "set_camera", [](Running& running, const py::kwargs& view) { running.set_camera(view); },
      "Changes the view of the next pictures: camera, eye, target, up, fov, lens, projection, view_height, "
      "aperture, focus, blades, view_file. Nothing is rebuilt.");
  renderer.def(
      "set_options", [](Running& running, const py::kwargs& options) { running.set_options(options); },
      "Changes options of the next pictures; other options keep their values. None sets the default. Only "
      "data that depends on the changed options is rebuilt.");
  renderer.def("stop", &Running::stop, "Ends the current render of another thread.");
  renderer.def_property_readonly("scene", &Running::scene);
}

}  // namespace gatelight::python
