#pragma once
// A finished picture from a file.

#include "apps/view/picture_source.h"

namespace gatelight::apps {

/// Its viewers change how it is shown.
class PictureFile : public PictureSource {
 public:
  /// Reads the file. `words`: --exposure, --tonemap, --white-balance. Throws InputError, BadOption.
  PictureFile(const std::string& file, std::vector<std::string> words);

  std::uint64_t change(const std::string& viewer, const FlagChange& flags, const std::string& layer) override;
  ViewerStatus status(const std::string& viewer) override;
  std::string command(const std::string& viewer) override;

 private:
  std::shared_ptr<const ShownPicture> shown_with(const LiveFlags& flags, std::uint64_t revision) const;
  void welcome(Viewer& made) override { made.shown = made.whole = first_; }

  renderer::Picture picture_;
  std::shared_ptr<const ShownPicture> first_;
};

}  // namespace gatelight::apps
