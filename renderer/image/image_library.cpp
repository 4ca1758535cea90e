#include "renderer/image/image_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <system_error>

#include "base/errors.h"

namespace gatelight::renderer {
namespace {

/// The folder of the program or shared library that has this code; empty where the system does not know it.
std::filesystem::path own_folder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&own_folder), &info) == 0 || !info.dli_fname) return {};
  return std::filesystem::path(info.dli_fname).parent_path();
}

/// Searches beside the program, as built and as installed, beside a module that has this code, then where the
/// libraries are installed.
std::filesystem::path find_library() {
  std::error_code error;
  const std::filesystem::path library = GATELIGHT_IMAGE_LIBRARY;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path beside = program.parent_path().parent_path() / library;
  if (!error && std::filesystem::exists(beside, error)) return beside;
  const std::filesystem::path folder = own_folder();
  for (const std::filesystem::path& file :
       {folder / library.filename(), folder.parent_path().parent_path() / library}) {
    if (!folder.empty() && std::filesystem::exists(file, error)) return file;
  }
  return std::filesystem::path(GATELIGHT_INSTALL_PREFIX) / library;
}

const ImageLibrary& load() {
  const std::filesystem::path file = find_library();
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    throw MissingLibrary(
        fmt::format("cannot load OpenImageIO: there is no '{}', which the package "
                    "gatelight-openimageio installs",
                    file.string()));
  }
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

void check_codec(ImageFormat format) {
  if (format == ImageFormat::tiff || format == ImageFormat::hdr) image_library();
}

}  // namespace gatelight::renderer
