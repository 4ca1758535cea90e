#include "renderer/image/image_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <system_error>

#include "base/errors.h"

namespace gatelight::renderer {
namespace {

/// Searches beside the program, as built and as installed, then where the libraries are installed.
std::filesystem::path find_library() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path beside = program.parent_path().parent_path() / GATELIGHT_IMAGE_LIBRARY;
  if (!error && std::filesystem::exists(beside, error)) return beside;
  return std::filesystem::path(GATELIGHT_INSTALL_PREFIX) / GATELIGHT_IMAGE_LIBRARY;
}

const ImageLibrary& load() {
  const std::filesystem::path file = find_library();
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const entry = library ? dlsym(library, "gatelight_image_library") : nullptr;
  if (!entry) throw MissingLibrary(fmt::format("cannot load OpenImageIO: {}", dlerror()));
  return *reinterpret_cast<const ImageLibrary* (*)()>(entry)();
}

}  // namespace

const ImageLibrary& image_library() {
  static const ImageLibrary& library = load();
  return library;
}

}  // namespace gatelight::renderer
