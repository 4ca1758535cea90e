#include "apps/view/view_session.h"

#include <algorithm>
#include <utility>

#include "apps/terminal/errors.h"
#include "renderer/image/auto_exposure.h"
#include "renderer/settings/enum_names.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::apps {
namespace {

/// A viewer that has not asked for so long has closed its page; nothing is made for it.
constexpr double kGone = 30.0;
/// Seconds from the begin of a final picture to the first look at it, and the factor of the next ones.
constexpr double kFirstLook = 1.5, kNextLook = 2.0;

Stage next_stage(Stage reached) {
  return static_cast<Stage>(static_cast<int>(reached) + 1);
}

}  // namespace

ViewSession::ViewSession(const std::string& scene, std::vector<std::string> words)
    : PictureSource(scene, std::move(words)),
      base_(settings_of(scene, words_, {})),
      scene_(scene, base_.load),
      outline_(outline_of(scene_.scene())) {
  const Task first{.stage = Stage::preview, .settings = base_};
  renderer_.emplace(scene_.scene(), options_of(first));
  chosen_ = renderer_->chosen();
  warnings_ = scene_.scene().warnings;
  const std::vector<std::string>& more = renderer_->statistics().warnings;
  warnings_.insert(warnings_.end(), more.begin(), more.end());
  thread_ = std::thread([this] { run(); });
}

ViewSession::~ViewSession() {
  stop();
  thread_.join();
}

void ViewSession::stop() {
  PictureSource::stop();
  ++changes_;
  work_.notify_all();
}

void ViewSession::welcome(Viewer& made) {
  made.settings = base_;
  ++changes_;
  work_.notify_all();
}

std::uint64_t ViewSession::change(const std::string& name, const FlagChange& flags,
                                  const std::string& layer) {
  const std::lock_guard lock(mutex_);
  Viewer& of = viewer(name);
  const LiveFlags wanted = changed(of.flags, flags);
  RenderSettings settings = settings_of(file_, words_, wanted);
  of.flags = wanted;
  of.settings = std::move(settings);
  if (!layer.empty()) of.layer = layer == "none" ? "" : layer;
  of.changed = Clock::now();
  of.reached = Stage::none;
  of.status.error.clear();
  ++of.revision;
  ++changes_;
  work_.notify_all();
  return of.revision;
}

std::string ViewSession::command(const std::string& name) {
  return render_command(file_, words_, flags(name));
}

ViewerStatus ViewSession::status(const std::string& name) {
  const std::lock_guard lock(mutex_);
  Viewer& of = viewer(name);
  ViewerStatus status = of.status;
  status.revision = of.revision;
  status.version = of.shown ? of.shown->version : 0;
  status.complete = of.reached == Stage::final;
  status.waits = !status.complete && status.stage == Stage::none;
  return status;
}

bool ViewSession::is_due(const Viewer& of) const {
  return of.reached != Stage::final && of.status.error.empty() && seconds_since(of.seen) < kGone;
}

std::optional<ViewSession::Task> ViewSession::next_task() {
  std::unique_lock lock(mutex_);
  std::pair<const std::string, Viewer>* next = nullptr;
  const auto find = [&] {
    next = nullptr;
    for (auto& named : viewers_) {
      const Viewer& of = named.second;
      if (!is_due(of)) continue;
      const auto urgency = [](const Viewer& v) {
        return std::pair(v.reached, -v.changed.time_since_epoch().count());
      };
      if (!next || urgency(of) < urgency(next->second)) next = &named;
    }
    return stopped_ || next != nullptr;
  };
  work_.wait(lock, find);
  if (stopped_) return std::nullopt;
  Viewer& of = next->second;
  const Stage stage = next_stage(of.reached);
  of.status.stage = stage;
  of.status.progress = {};
  return Task{next->first, stage, of.revision, changes_, of.settings, of.layer, of.changed};
}

void ViewSession::run() {
  while (const std::optional<Task> task = next_task()) {
    try {
      make(*task);
    } catch (const renderer::Abandoned&) {
      // The next task is more urgent.
    } catch (...) {
      fail(*task);
    }
    const std::lock_guard lock(mutex_);
    const auto found = viewers_.find(task->viewer);
    if (found != viewers_.end()) found->second.status.stage = Stage::none;
  }
}

bool ViewSession::is_overtaken(const Task& task) {
  const std::lock_guard lock(mutex_);
  if (stopped_) return true;
  for (const auto& [name, of] : viewers_) {
    if (name == task.viewer && of.revision != task.revision) return true;
    if (is_due(of) && next_stage(of.reached) < task.stage) return true;
  }
  return false;
}

renderer::RenderOptions ViewSession::options_of(const Task& task) const {
  renderer::RenderOptions final = task.settings.render;
  final.cache.choose_device = false;  // a trial would delay pictures
  // A final picture chooses by its own view, as render does; frames share a cache, or none.
  if (task.stage != Stage::final && chosen_) renderer::use_chosen(final, *chosen_);
  if (!task.layer.empty() && task.stage != Stage::draft) {
    for (const auto& [name, aov] : renderer::kEnumNames<renderer::Aov>) {
      if (name == task.layer && !renderer::has(final.aovs, aov)) final.aovs.push_back(aov);
    }
  }
  return options_of_stage(task.stage, final, new_light_, divisor_);
}

void ViewSession::prepare(const Task& task) {
  const bool moved = scene_.show(task.settings.load.time.value_or(0.0), changes_of(task.settings.load));
  const bool same_environment = environment_ == task.settings.render.environment;
  environment_ = task.settings.render.environment;
  new_light_ = new_light_ || moved || !same_environment || !shares_cache_;
  // A view keeps its soft sky while it is dragged; where it stays, it gets the one of `gatelight render`.
  const std::optional<bool> sky = renderer_->soft_sky();
  const bool keeps_sky = task.stage == Stage::draft && !moved && same_environment;
  renderer_->keep_soft_sky(keeps_sky ? sky : std::nullopt);
  const renderer::RenderOptions options = options_of(task);
  // Where the renderer cannot take the options, the next picture has to show it the scene.
  moved_ = moved_ || moved;
  renderer_->set_options(options);
  if (moved_) renderer_->scene_moved(options.camera);
  moved_ = false;
  if (!new_light_ && renderer_->soft_sky() != sky) {
    new_light_ = true;
    renderer_->set_options(options_of(task));
  }
  if (task.stage != Stage::final && !shares_cache_) {
    renderer_->begin_frames(task.settings.load.time.value_or(0.0));
    shares_cache_ = true;
  }
}

renderer::Callbacks ViewSession::callbacks(const Task& task) {
  auto next_look = std::make_shared<std::pair<Clock::time_point, double>>(Clock::now(), kFirstLook);
  auto checked = std::make_shared<std::atomic<std::uint64_t>>(task.changes);
  auto overtaken = std::make_shared<std::atomic<bool>>(false);
  return {
      .progress =
          [this, task](const renderer::Progress& progress) {
            const std::lock_guard lock(mutex_);
            const auto found = viewers_.find(task.viewer);
            if (found != viewers_.end()) found->second.status.progress = progress;
          },
      .abandon =
          [this, task, checked, overtaken] {
            // Drafts are short, and a drag would never get one.
            if (task.stage == Stage::draft) return false;
            const std::uint64_t changes = changes_.load();
            if (checked->exchange(changes) != changes) *overtaken = is_overtaken(task);
            return overtaken->load();
          },
      .snapshot_wanted =
          [next_look] {
            if (seconds_since(next_look->first) < next_look->second) return false;
            next_look->second *= kNextLook;
            return true;
          },
      .snapshot = [this, task](const renderer::Picture& picture) { publish(task, picture, false); },
  };
}

void ViewSession::make(const Task& task) {
  const std::lock_guard lock(renders_);
  const Clock::time_point start = Clock::now();
  prepare(task);
  const renderer::Callbacks calls = callbacks(task);
  renderer::Picture picture =
      task.stage == Stage::final ? renderer_->render(calls) : renderer_->render_frame(frame_++, calls);
  if (task.stage != Stage::final) new_light_ = false;
  if (task.stage == Stage::draft) divisor_ = next_divisor(divisor_, seconds_since(start));
  publish(task, std::move(picture), true);
}

void ViewSession::publish(const Task& task, renderer::Picture picture, bool complete) {
  auto shown = std::make_shared<ShownPicture>();
  shown->revision = task.revision;
  shown->stage = task.stage;
  shown->complete = complete && task.stage == Stage::final;
  shown->statistics = renderer_->statistics();
  shown->settings = task.settings;
  shown->seconds = seconds_since(task.changed);
  const float suitable = renderer::auto_exposure(picture);
  shown->picture = std::move(picture);
  const std::lock_guard lock(mutex_);
  const auto found = viewers_.find(task.viewer);
  if (found == viewers_.end()) return;
  Viewer& of = found->second;
  // The exposure of noisy drafts would flicker.
  const bool keeps = task.stage == Stage::draft && of.shown && !of.shown->settings.exposure;
  shown->exposure = task.settings.exposure.value_or(keeps ? of.shown->exposure : suitable);
  shown->version = ++version_;
  of.shown = shown;
  if (task.stage != Stage::draft) of.whole = shown;
  if (complete && of.revision == task.revision) of.reached = task.stage;
  news_.notify_all();
}

void ViewSession::fail(const Task& task) {
  const std::string message = describe_current_exception().message;
  const std::lock_guard lock(mutex_);
  const auto found = viewers_.find(task.viewer);
  if (found == viewers_.end() || found->second.revision != task.revision) return;
  found->second.status.error = message;
  news_.notify_all();
}

}  // namespace gatelight::apps
