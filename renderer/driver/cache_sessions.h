#pragma once
// The cache of a picture: new, or from a file.

#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>

#include "renderer/cache/cache_session.h"
#include "renderer/driver/prepared_picture.h"

namespace gatelight::renderer {

/// `setup`: null scouts for one. `expect`: checks the model before its memory is allocated, or null.
std::unique_ptr<CacheSession> make_session(const PreparedPicture& picture, const RecordExchange& exchange,
                                           const CacheSetup* setup,
                                           const std::function<void(const neural::Model&)>& expect = nullptr);

/// The cache of a file, which must be of this scene. `others`: names of tensors that the file may have beside
/// it. Throws CacheFileError.
std::unique_ptr<CacheSession> read_session(const PreparedPicture& picture, const RecordExchange& exchange,
                                           const std::filesystem::path& file, const SceneFingerprint& scene,
                                           const std::set<std::string>& others = {});

}  // namespace gatelight::renderer
