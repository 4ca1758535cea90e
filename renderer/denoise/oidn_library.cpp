#include "renderer/denoise/oidn_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <system_error>
#include <vector>

#include "base/errors.h"

namespace gatelight::renderer {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "Open Image Denoise";
constexpr const char* kFile = "libOpenImageDenoise.so.2";
constexpr int kVersion = 2;

/// Folders of the cache that have the library, the last name first.
std::vector<fs::path> cache_folders() {
  const auto variable = [](const char* name) {
    const char* const value = std::getenv(name);
    return fs::path(value ? value : "");
  };
  fs::path cache = variable("XDG_CACHE_HOME");
  if (cache.empty()) {
    const fs::path home = variable("HOME");
    if (home.empty()) return {};
    cache = home / ".cache";
  }
  std::vector<fs::path> folders;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(cache / "gatelight", error)) {
    if (entry.path().filename().string().starts_with("oidn-")) folders.push_back(entry.path() / "lib");
  }
  std::sort(folders.rbegin(), folders.rend());
  return folders;
}

/// Files for the loader, in the order in which they are tried.
std::vector<fs::path> candidates(const std::string& place) {
  std::error_code error;
  if (!place.empty()) {
    const fs::path given = fs::is_directory(place, error) ? fs::path(place) / kFile : fs::path(place);
    // The loader searches its own folders for a name without one.
    return {fs::exists(given, error) ? fs::absolute(given, error) : given};
  }
  std::vector<fs::path> files;
  const auto add = [&](const fs::path& file) {
    if (fs::exists(file, error)) files.push_back(file);
  };
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  std::vector<fs::path> prefixes;
  if (!error) prefixes.push_back(program.parent_path().parent_path());
  prefixes.emplace_back(GATELIGHT_INSTALL_PREFIX);
  for (const fs::path& prefix : prefixes) add(prefix / GATELIGHT_PACKAGED_OIDN / kFile);
  for (const fs::path& folder : cache_folders()) add(folder / kFile);
  for (const fs::path& prefix : prefixes) add(prefix / "lib" / kFile);
  files.emplace_back(kFile);  // without a folder: where the system's loader looks
  return files;
}

template <class Function>
void resolve(void* library, const char* name, const fs::path& file, Function*& function) {
  function = reinterpret_cast<Function*>(dlsym(library, fmt::format("oidn{}", name).c_str()));
  if (!function)
    throw MissingDenoiser(
        fmt::format("'{}' has no oidn{}, expected {} {}", file.string(), name, kName, kVersion));
}

oidn::Api resolve_api(void* library, const fs::path& file) {
  oidn::Api api{};
  const auto get = [&](const char* name, auto& function) { resolve(library, name, file, function); };
  get("NewDevice", api.NewDevice);
  get("SetDeviceBool", api.SetDeviceBool);
  get("SetDeviceInt", api.SetDeviceInt);
  get("GetDeviceInt", api.GetDeviceInt);
  get("CommitDevice", api.CommitDevice);
  get("GetDeviceError", api.GetDeviceError);
  get("ReleaseDevice", api.ReleaseDevice);
  get("NewFilter", api.NewFilter);
  get("SetSharedFilterImage", api.SetSharedFilterImage);
  get("SetFilterBool", api.SetFilterBool);
  get("SetFilterInt", api.SetFilterInt);
  get("SetFilterFloat", api.SetFilterFloat);
  get("SetFilterProgressMonitorFunction", api.SetFilterProgressMonitorFunction);
  get("CommitFilter", api.CommitFilter);
  get("ExecuteFilter", api.ExecuteFilter);
  get("ReleaseFilter", api.ReleaseFilter);
  return api;
}

/// The version that a device reports. Throws MissingDenoiser for another version, or without a device.
std::string version_of(const oidn::Api& api, const fs::path& file) {
  const std::unique_ptr<oidn::DeviceHandle, void (*)(oidn::Device)> device(api.NewDevice(oidn::kCpuDevice),
                                                                           api.ReleaseDevice);
  const char* message = nullptr;
  if (device) {
    api.CommitDevice(device.get());
    if (api.GetDeviceError(device.get(), &message) == oidn::kNoError) {
      const int major = api.GetDeviceInt(device.get(), "versionMajor");
      const std::string version =
          fmt::format("{}.{}.{}", major, api.GetDeviceInt(device.get(), "versionMinor"),
                      api.GetDeviceInt(device.get(), "versionPatch"));
      if (major == kVersion) return version;
      throw MissingDenoiser(
          fmt::format("'{}' is {} {}, expected version {}", file.string(), kName, version, kVersion));
    }
  } else {
    api.GetDeviceError(nullptr, &message);
  }
  throw MissingDenoiser(fmt::format("'{}' cannot denoise on this processor: {}", file.string(),
                                    message ? message : "no reason"));
}

std::string path_of(void* function, const fs::path& file) {
  Dl_info info{};
  return dladdr(function, &info) != 0 && info.dli_fname ? info.dli_fname : file.string();
}

OidnLibrary load(const std::string& place) {
  std::string refused;
  for (const fs::path& file : candidates(place)) {
    void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) {
      if (refused.empty()) refused = dlerror();
      continue;
    }
    OidnLibrary loaded{.api = resolve_api(library, file)};
    loaded.version = version_of(loaded.api, file);
    loaded.path = path_of(reinterpret_cast<void*>(loaded.api.NewDevice), file);
    return loaded;
  }
  throw MissingDenoiser(fmt::format("{} was not found: {}{}", kName, refused,
                                    place.empty() ? " (scripts/setup installs it)" : ""));
}

}  // namespace

std::string find_oidn_file(const std::string& place) {
  return candidates(place).front().string();
}

const OidnLibrary& load_oidn(const std::string& place) {
  static std::mutex mutex;
  static std::map<std::string, OidnLibrary> loaded;
  const std::lock_guard lock(mutex);
  const auto known = loaded.find(place);
  return known != loaded.end() ? known->second : loaded.emplace(place, load(place)).first->second;
}

}  // namespace gatelight::renderer
