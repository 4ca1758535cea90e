#include "apps/sweep/references.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/reports/json.h"
#include "apps/sweep/identity.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"
#include "apps/terminal/text.h"
#include "apps/terminal/version.h"
#include "base/errors.h"
#include "base/file/atomic_file.h"
#include "base/file/digest.h"
#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"
#include "renderer/metrics/compare.h"
#include "renderer/metrics/merge.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using renderer::Picture;
using renderer::RenderOptions;

/// The path of another file of the same reference: KEY + end.
std::string beside(const std::string& file, const std::string& end) {
  return (fs::path(file).parent_path() / (fs::path(file).stem().string() + end)).string();
}

/// Reads a finished picture. Returns nothing where there is none or it cannot be read; it is then made again.
std::optional<Picture> read_made(const std::string& file) {
  if (!fs::exists(file)) return std::nullopt;
  try {
    return renderer::read_image(file);
  } catch (const InputError& error) {
    log_warning(fmt::format("{}; the reference is rendered again", error.what()));
    return std::nullopt;
  }
}

/// Returns nothing where rendering was stopped.
std::optional<Picture> render_half(const scene::Scene& scene, const RenderSettings& cell,
                                   RenderOptions options, std::uint32_t seed, const std::string& file,
                                   const renderer::Callbacks& callbacks) {
  if (std::optional<Picture> made = read_made(file)) return made;
  options.seed = seed;
  options.checkpoint = {.file = fs::path(file).replace_extension(".checkpoint").string(), .resume = true};
  const auto render = [&]() -> std::optional<Picture> {
    renderer::Renderer renderer(scene, options);
    Picture picture = renderer.render(callbacks);
    const renderer::RenderStatistics& statistics = renderer.statistics();
    if (statistics.interrupted) return std::nullopt;
    picture.metadata = {{"version", version()},
                        {"scene", cell.scene},
                        {"integrator", renderer::enum_name(options.integrator)},
                        {"seed", std::to_string(seed)},
                        {"spp", std::to_string(statistics.spp)},
                        {"render_seconds", fmt::format("{:.3f}", statistics.render_seconds)}};
    return picture;
  };
  std::optional<Picture> picture;
  try {
    picture = render();
  } catch (const CacheFileError& error) {
    log_warning(fmt::format("{}; the reference is started again", error.what()));
    fs::remove(options.checkpoint.file);
    picture = render();
  }
  if (!picture) return std::nullopt;
  renderer::write_image(*picture, file, {.exr_float = true});
  fs::remove(options.checkpoint.file);
  return picture;
}

/// Checks a given reference early, because a comparison with a cell would refuse it only after hours.
void check_given(const renderer::NamedPicture& given, const RenderOptions& cell) {
  Picture blank{.width = cell.width, .height = cell.height};
  if (cell.region) {
    const auto& [x0, y0, x1, y1] = *cell.region;
    blank.width = x1 - x0;
    blank.height = y1 - y0;
  }
  const std::size_t pixels = static_cast<std::size_t>(blank.width) * static_cast<std::size_t>(blank.height);
  blank.layers = {{.channels = {"R", "G", "B"}, .values = std::vector<float>(3 * pixels)}};
  const renderer::ErrorMetrics metrics =
      renderer::compare_pictures(given, {blank, "the pictures of this sweep"});
  if (metrics.nonfinite_reference == 0) return;
  throw InputError(fmt::format("--reference: '{}' has {} pixels that are not finite, expected none",
                               given.name, metrics.nonfinite_reference));
}

/// A reference with the rel_mse of its own noise, where that is known.
struct MeanPicture {
  Picture picture;
  std::optional<double> rel_mse_noise;
};

MeanPicture mean_of_halves(const renderer::NamedPicture& first, const renderer::NamedPicture& second) {
  Picture mean = renderer::merge_pictures({first, second});
  // (a - m)^2 = ((a - b)/2)^2, which is on average the variance of the mean m.
  const double noise = renderer::compare_pictures({mean, "the mean of the halves"}, first).rel_mse;
  return {std::move(mean), noise};
}

/// The picture of one file, or the mean of two halves.
MeanPicture read_given(const std::vector<std::string>& files) {
  Picture first = renderer::read_image(files.front());
  if (files.size() == 1) return {std::move(first), std::nullopt};
  const Picture second = renderer::read_image(files.back());
  return mean_of_halves({first, files.front()}, {second, files.back()});
}

double seconds_of(const Picture& picture) {
  const auto at = picture.metadata.find("render_seconds");
  return at == picture.metadata.end() ? 0.0 : read_number(at->second);
}

}  // namespace

RenderOptions reference_options(const RenderOptions& cell, ReferenceKind kind) {
  const RenderOptions defaults;
  RenderOptions o = cell;
  o.integrator = kind == ReferenceKind::ao      ? renderer::Integrator::ao
                 : kind == ReferenceKind::cache ? renderer::Integrator::nrc
                                                : renderer::Integrator::path;
  // A named run may choose, but its reference does not.
  o.choose_integrator = false;
  o.spp_of_paths = 0;
  o.time_limit_seconds = 0.0;
  o.max_error = 0.0;
  o.sampler = defaults.sampler;
  o.mis = defaults.mis;
  o.direct = defaults.direct;
  o.light_selection = defaults.light_selection;
  o.watertight = defaults.watertight;
  // The view of the cache is compared with its training target, a picture with the true light.
  if (kind != ReferenceKind::cache) o.glass_shadows = defaults.glass_shadows;
  o.min_depth = defaults.min_depth;
  o.clamp = 0.0f;
  // Radiance and occlusion have different limits of length.
  if (kind == ReferenceKind::ao) {
    o.max_depth = defaults.max_depth;
    o.max_transmission_depth = defaults.max_transmission_depth;
  } else {
    o.ao_distance = defaults.ao_distance;
  }
  o.aovs.clear();
  o.denoise = defaults.denoise;
  o.nan_policy = renderer::NanPolicy::drop;
  o.checkpoint = defaults.checkpoint;
  o.cache = defaults.cache;
  if (kind == ReferenceKind::cache) {
    o.cache.train_steps = 0;
    o.cache.self_training.start_step = -1;
    o.cache.query_at = renderer::QueryAt::none;
    o.cache.view = renderer::CacheOutput::cache;
    o.cache.component = cell.cache.component;
    o.cache.min_roughness = cell.cache.min_roughness;
  }
  return o;
}

ordered_json reference_json(const Reference& reference, const std::string& folder) {
  // Inside the sweep's folder the name is relative.
  const fs::path absolute = fs::absolute(reference.file).lexically_normal();
  const fs::path relative = absolute.lexically_relative(fs::absolute(folder).lexically_normal());
  const bool inside = !relative.empty() && *relative.begin() != "..";
  return {{"id", reference.key},
          {"kind", renderer::name_of(kReferenceKinds, reference.kind)},
          {"spp", reference.spp ? ordered_json(*reference.spp) : nullptr},
          {"file", (inside ? relative : absolute).generic_string()},
          {"rel_mse_noise", json_number(reference.rel_mse_noise)},
          {"seconds", json_number(reference.seconds)}};
}

RenderSettings reference_settings(const RenderSettings& cell, ReferenceKind kind, int spp) {
  RenderSettings settings = cell;
  settings.render = reference_options(cell.render, kind);
  settings.render.seed = 0;
  settings.render.spp = spp;
  settings.render.threads = 1;  // does not change the picture
  settings.render.memory_limit_bytes = 0;
  settings.render.isa = RenderOptions().isa;  // changes only the last digits
  settings.image = {};
  settings.exposure = 0.0f;
  return settings;
}

Reference plan_reference(const RenderSettings& cell, ReferenceKind kind, const scene::Scene& scene,
                         const renderer::SceneFingerprint& fingerprint, int spp, const std::string& folder) {
  const RenderSettings settings = reference_settings(cell, kind, spp);
  const std::string key =
      identity_name(fingerprint, {"reference", deciding_text(settings, view_of(scene, settings.render))});
  const std::string file = (fs::path(folder) / (key + ".exr")).string();
  return {.kind = kind,
          .key = key,
          .file = file,
          .halves = {beside(file, "_a.exr"), beside(file, "_b.exr")},
          .spp = spp};
}

Reference given_reference(ReferenceKind kind, const std::vector<std::string>& files,
                          const RenderOptions& cell) {
  const auto [picture, noise] = read_given(files);
  check_given({picture, files.front()}, cell);
  DigestRecord record;
  for (const renderer::Layer& layer : picture.layers) {
    record.add(digest_of(std::as_bytes(std::span(layer.values))));
  }
  Reference reference{.kind = kind,
                      .key = hexadecimal(record.digest()).substr(0, 16),
                      .file = files.front(),
                      .halves = files,
                      .given = true,
                      .rel_mse_noise = noise};
  const auto spp = picture.metadata.find("spp");
  if (spp != picture.metadata.end()) {
    reference.spp = static_cast<int>(parse_integer("reference", spp->second, {1, std::int64_t{1} << 30}));
  }
  return reference;
}

double measure_bias(const Reference& reference, const std::string& file,
                    const renderer::NamedPicture& second) {
  const std::array<Picture, 3> read = {renderer::read_image(reference.halves.at(0)),
                                       renderer::read_image(reference.halves.at(1)),
                                       renderer::read_image(file)};
  return renderer::squared_bias({{read[0], reference.halves[0]}, {read[1], reference.halves[1]}},
                                {{read[2], file}, second});
}

void read_reference_numbers(Reference& reference) {
  if (reference.given) return;
  const ordered_json json = read_json_file(beside(reference.file, ".json"));
  if (!json.is_object()) return;
  const auto number = [&](const char* key) -> std::optional<double> {
    if (!json.contains(key) || !json[key].is_number()) return std::nullopt;
    return json[key].get<double>();
  };
  reference.rel_mse_noise = number("rel_mse_noise");
  reference.seconds = number("seconds");
}

std::optional<Picture> make_reference(Reference& reference, const scene::Scene& scene,
                                      const RenderSettings& cell, const renderer::Callbacks& callbacks) {
  if (reference.given) return read_given(reference.halves).picture;
  read_reference_numbers(reference);
  if (reference.rel_mse_noise) {
    if (std::optional<Picture> made = read_made(reference.file)) return made;
  }

  RenderOptions options = reference_options(cell.render, reference.kind);
  options.spp = std::max(1, *reference.spp / 2);
  const std::vector<std::string>& files = reference.halves;
  std::array<Picture, 2> halves;
  for (std::size_t i = 0; i < 2; ++i) {
    renderer::Callbacks half = callbacks;
    half.progress = [&](const renderer::Progress& progress) {
      if (!callbacks.progress) return;
      renderer::Progress of_both = progress;
      of_both.fraction = 0.5 * (static_cast<double>(i) + progress.fraction);
      callbacks.progress(of_both);
    };
    std::optional<Picture> picture = render_half(scene, cell, options, kReferenceSeeds[i], files[i], half);
    if (!picture) return std::nullopt;
    halves[i] = std::move(*picture);
  }
  auto [mean, noise] = mean_of_halves({halves[0], files[0]}, {halves[1], files[1]});
  reference.rel_mse_noise = noise;
  reference.seconds = seconds_of(halves[0]) + seconds_of(halves[1]);
  renderer::write_image(mean, reference.file, {.exr_float = true});
  const ordered_json json = {{"kind", renderer::name_of(kReferenceKinds, reference.kind)},
                             {"scene", cell.scene},
                             {"spp", *reference.spp},
                             {"rel_mse_noise", *reference.rel_mse_noise},
                             {"seconds", *reference.seconds}};
  write_file_atomically(beside(reference.file, ".json"), json_text(json) + "\n");
  return mean;
}

}  // namespace gatelight::apps
