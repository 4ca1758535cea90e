#include "apps/sweep/identity.h"

#include <fmt/format.h>

#include <fstream>

#include "base/errors.h"
#include "base/file/digest.h"
#include "renderer/cache/cache_backend.h"
#include "renderer/film/camera_choice.h"
#include "renderer/fingerprint/deciding_options.h"
#include "renderer/settings/enum_names.h"
#include "renderer/surface/embree.h"

namespace gatelight::apps {

renderer::View view_of(const scene::Scene& scene, const renderer::RenderOptions& options) {
  return renderer::choose_camera(scene, options.camera,
                                 static_cast<float>(options.width) / static_cast<float>(options.height));
}

std::string deciding_text(const RenderSettings& settings, const renderer::View& view) {
  const renderer::RenderOptions& o = settings.render;
  std::string text;
  for (const renderer::NamedText& option : renderer::deciding_options(o, view, {{"isa", o.isa}})) {
    text += fmt::format("{} {}\n", option.name, option.text);
  }
  if (!o.background.file.empty())
    text += fmt::format("background {}\n", renderer::file_digest(o.background.file));
  // FLIP depends on the display options; threads and memory limit decide the time, or whether it succeeds.
  return text + fmt::format("spp {}\nexposure {}\ntonemap {}\nthreads {}\nmemory-limit {}\nnan {}\n", o.spp,
                            settings.image.display.exposure,
                            renderer::enum_name(settings.image.display.tonemap), o.threads,
                            o.memory_limit_bytes, renderer::enum_name(o.nan_policy));
}

std::string identity_name(const renderer::SceneFingerprint& scene, std::initializer_list<std::string> texts) {
  DigestRecord record;
  for (const renderer::NamedText& part : scene) record.add_text(part.text);
  for (const std::string& text : texts) record.add_text(text);
  return hexadecimal(record.digest()).substr(0, 16);
}

std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(':');
    if (line.rfind("model name", 0) != 0 || colon == std::string::npos) continue;
    const std::size_t begin = line.find_first_not_of(' ', colon + 1);
    return begin == std::string::npos ? "" : line.substr(begin);
  }
  return "unknown";
}

std::string machine_text(const renderer::RenderOptions& options) {
  static const std::string cpu = cpu_name();
  std::string kernels = "none";
  if (renderer::uses_cache(options.integrator)) {
    try {
      kernels = renderer::cache_machine(options);
    } catch (const Unavailable&) {
      // Its cells will fail with this error.
    }
  }
  return fmt::format("cpu {}\nisa {}\nkernels {}", cpu,
                     options.isa == "auto" ? renderer::best_isa() : options.isa, kernels);
}

}  // namespace gatelight::apps
