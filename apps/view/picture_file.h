#pragma once
// A finished picture from a file.

#include <condition_variable>
#include <map>
#include <mutex>

#include "apps/view/picture_source.h"

namespace gatelight::apps {

/// Its viewers change how it is shown.
class PictureFile : public PictureSource {
 public:
  /// Reads the file. `words`: --exposure, --tonemap, --white-balance. Throws InputError, BadOption.
  PictureFile(const std::string& file, std::vector<std::string> words);

  const std::string& file() const override { return file_; }
  const std::vector<std::string>& words() const override { return words_; }
  const SceneOutline* outline() const override { return nullptr; }
  std::uint64_t change(const std::string& viewer, const FlagChange& flags, const std::string& layer) override;
  LiveFlags flags(const std::string& viewer) override;
  ViewerStatus status(const std::string& viewer) override;
  std::shared_ptr<const ShownPicture> wait(const std::string& viewer, std::uint64_t version,
                                           std::chrono::milliseconds most) override;
  std::shared_ptr<const ShownPicture> last_whole(const std::string& viewer) override;
  std::string command(const std::string& viewer) override;
  void stop() override;

 private:
  struct Viewer {
    LiveFlags flags;
    std::shared_ptr<const ShownPicture> shown;
  };
  std::shared_ptr<const ShownPicture> shown_with(const LiveFlags& flags, std::uint64_t revision) const;
  Viewer& viewer(const std::string& name);

  const std::string file_;
  const std::vector<std::string> words_;
  renderer::Picture picture_;
  std::shared_ptr<const ShownPicture> first_;
  std::mutex mutex_;
  std::condition_variable news_;
  std::map<std::string, Viewer> viewers_;
  bool stopped_ = false;
};

}  // namespace gatelight::apps
