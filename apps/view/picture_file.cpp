#include "apps/view/picture_file.h"

#include <algorithm>
#include <utility>

#include "apps/settings/option_table.h"
#include "apps/terminal/errors.h"
#include "renderer/image/auto_exposure.h"
#include "renderer/image/image_read.h"

namespace gatelight::apps {
PictureFile::PictureFile(const std::string& file, std::vector<std::string> words)
    : PictureSource(file, std::move(words)),
      picture_(renderer::read_image(file)),
      first_(shown_with({}, 1)) {}

std::shared_ptr<const ShownPicture> PictureFile::shown_with(const LiveFlags& flags,
                                                            std::uint64_t revision) const {
  auto shown = std::make_shared<ShownPicture>();
  shown->settings = settings_of(file_, words_, flags);
  shown->version = shown->revision = revision;
  shown->stage = Stage::final;
  shown->complete = true;
  shown->picture = picture_;
  shown->exposure = shown->settings.exposure.value_or(renderer::auto_exposure(picture_));
  return shown;
}

std::uint64_t PictureFile::change(const std::string& name, const FlagChange& flags, const std::string&) {
  const std::set<std::string> known = option_names([](const Option& option) {
    return option.marks.in_window && option.marks.stage == OptionStage::output;
  });
  for (const auto& [flag, value] : flags) {
    if (!known.contains(flag)) throw BadOption({one_line(flag), "", "has no effect on a finished picture"});
  }
  const std::lock_guard lock(mutex_);
  Viewer& of = viewer(name);
  const LiveFlags wanted = changed(of.flags, flags);
  of.shown = of.whole = shown_with(wanted, of.revision + 1);
  ++of.revision;
  of.flags = wanted;
  news_.notify_all();
  return of.revision;
}

ViewerStatus PictureFile::status(const std::string& name) {
  const std::lock_guard lock(mutex_);
  const std::uint64_t revision = viewer(name).revision;
  return {.revision = revision, .version = revision, .complete = true};
}

std::string PictureFile::command(const std::string&) {
  const auto found = picture_.metadata.find("command");
  return found == picture_.metadata.end() ? "" : found->second;
}

}  // namespace gatelight::apps
