#include "apps/view/picture_source.h"

#include <algorithm>
#include <utility>

namespace gatelight::apps {
namespace {

/// A further one takes the place of another.
constexpr std::size_t kMaxViewers = 64;

}  // namespace

PictureSource::PictureSource(std::string file, std::vector<std::string> words)
    : file_(std::move(file)), words_(std::move(words)) {}

PictureSource::Viewer& PictureSource::viewer(const std::string& name) {
  const auto found = viewers_.find(name);
  if (found != viewers_.end()) {
    found->second.seen = Clock::now();
    return found->second;
  }
  if (viewers_.size() >= kMaxViewers) {
    viewers_.erase(std::min_element(viewers_.begin(), viewers_.end(), [](const auto& a, const auto& b) {
      return a.second.seen < b.second.seen;
    }));
  }
  Viewer& made = viewers_[name];
  welcome(made);
  return made;
}

LiveFlags PictureSource::flags(const std::string& name) {
  const std::lock_guard lock(mutex_);
  return viewer(name).flags;
}

std::shared_ptr<const ShownPicture> PictureSource::wait(const std::string& name, std::uint64_t version,
                                                        std::chrono::milliseconds most) {
  std::unique_lock lock(mutex_);
  viewer(name);
  std::shared_ptr<const ShownPicture> shown;
  news_.wait_for(lock, most, [&] {
    const auto found = viewers_.find(name);
    const bool has_later =
        found != viewers_.end() && found->second.shown && found->second.shown->version > version;
    if (has_later) shown = found->second.shown;
    return has_later || stopped_ || found == viewers_.end();
  });
  return shown;
}

std::shared_ptr<const ShownPicture> PictureSource::last_whole(const std::string& name) {
  const std::lock_guard lock(mutex_);
  return viewer(name).whole;
}

void PictureSource::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  news_.notify_all();
}

}  // namespace gatelight::apps
