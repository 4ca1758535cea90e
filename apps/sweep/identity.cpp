#include "apps/sweep/identity.h"

#include <fmt/format.h>

#include <fstream>

#include "apps/settings/light_flags.h"
#include "base/errors.h"
#include "base/file/digest.h"
#include "renderer/cache/cache_backend.h"
#include "renderer/film/camera_choice.h"
#include "renderer/fingerprint/deciding_options.h"
#include "renderer/settings/enum_names.h"
#include "renderer/surface/embree.h"

namespace gatelight::apps {
namespace {

std::string text_of(const Vec3& v) {
  return fmt::format("{},{},{}", v.x(), v.y(), v.z());
}

/// Options that deciding_options() leaves to the scene's camera and fingerprint.
std::string scene_options(const RenderSettings& settings) {
  const renderer::CameraOptions& camera = settings.render.camera;
  const renderer::EnvironmentOptions& environment = settings.render.environment;
  std::string text = fmt::format("camera '{}'", camera.name);
  if (camera.look_at) {
    text += fmt::format(" eye {} target {} up {}", text_of(camera.look_at->eye),
                        text_of(camera.look_at->target), text_of(camera.look_at->up));
  }
  if (camera.fov_degrees) text += fmt::format(" fov {}", *camera.fov_degrees);
  if (camera.focal_mm) text += fmt::format(" lens {}", *camera.focal_mm);
  if (camera.projection != renderer::Projection::camera)
    text += fmt::format(" projection {}", renderer::enum_name(camera.projection));
  if (camera.view_height) text += fmt::format(" height {}", *camera.view_height);
  if (const renderer::LensOptions& lens = camera.lens; lens.aperture > 0.0f || lens.f_stop > 0.0f)
    text += fmt::format(" aperture {} f/{} focus '{}' blades {}", lens.aperture, lens.f_stop, lens.focus,
                        lens.blades);
  if (environment.sky) text += fmt::format(" sky {}", renderer::text_of(*environment.sky));
  if (!settings.load.lights.empty()) text += fmt::format(" lights {}", apps::text_of(settings.load.lights));
  if (!settings.load.profiles.empty()) text += fmt::format(" ies {}", apps::text_of(settings.load.profiles));
  if (settings.load.time)
    text += fmt::format(" time {} of '{}'", *settings.load.time, settings.load.animation);
  return text +
         fmt::format("\nenvironment '{}' {},{},{}{} rotation {} scale {}\nscene {} variant '{}' backfaces {}",
                     environment.file, environment.constant.x(), environment.constant.y(),
                     environment.constant.z(), environment.automatic ? " auto" : "",
                     environment.rotation_degrees, environment.scale, settings.load.scene,
                     settings.load.variant, static_cast<int>(settings.load.back_faces));
}

}  // namespace

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

std::string deciding_text(const RenderSettings& settings) {
  return deciding_text(settings, renderer::View{}) + scene_options(settings);
}

std::string identity_name(const renderer::SceneFingerprint& scene, std::initializer_list<std::string> texts) {
  DigestRecord record;
  for (const renderer::NamedText& part : scene) record.add_text(part.text);
  for (const std::string& text : texts) record.add_text(text);
  return hexadecimal(record.digest()).substr(0, 16);
}

std::string cell_name(const renderer::SceneFingerprint& scene, const std::string& deciding,
                      const std::string& reference, const std::string& machine, bool hdr_flip) {
  return identity_name(scene, {deciding, reference, machine, hdr_flip ? "hdr" : ""});
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
