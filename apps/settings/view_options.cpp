#include <fmt/format.h>

#include <array>

#include "apps/settings/light_flags.h"
#include "apps/settings/picture_options.h"
#include "base/errors.h"

namespace gatelight::apps {
namespace {

using namespace renderer;

void read_environment(EnvironmentOptions& environment, const std::string& option, const std::string& text) {
  environment.automatic = text == "auto";
  environment.file.clear();
  environment.constant = Color::Zero();
  if (text == "none" || text == "auto") return;
  if (looks_like_triple(text)) {
    const std::array<float, 3> rgb = parse_triple(option, text, kNotNegative);
    environment.constant = {rgb[0], rgb[1], rgb[2]};
  } else {
    environment.file = text;
  }
}

OptionValue environment_value(const EnvironmentOptions& environment) {
  if (environment.automatic) return "auto";
  if (environment.none()) return "none";
  if (!environment.file.empty()) return environment.file;
  const Color& rgb = environment.constant;
  return std::vector<float>{rgb.x(), rgb.y(), rgb.z()};
}

std::optional<FogOptions> read_fog(const std::string& option, const std::string& text) {
  if (text == "none") return {};
  const std::vector<std::string> parts = split(text, ',');
  if (parts.size() != 1 && parts.size() != 4 && parts.size() != 5)
    throw BadOption({option, text, "", "none, DENSITY, DENSITY,r,g,b or DENSITY,r,g,b,g"});
  FogOptions fog{.density = parse_float(option, parts[0], {.min = 0.0, .max = 1e12})};
  if (parts.size() > 1) {
    for (Eigen::Index c = 0; c < 3; ++c)
      fog.albedo[c] = parse_float(option, parts[static_cast<std::size_t>(c) + 1], {.min = 0.0, .max = 1.0});
  }
  if (parts.size() == 5) fog.anisotropy = parse_float(option, parts[4], {-0.99, 0.99});
  return fog;
}

OptionValue fog_value(const std::optional<FogOptions>& fog) {
  if (!fog) return "none";
  return std::vector<float>{fog->density, fog->albedo.x(), fog->albedo.y(), fog->albedo.z(), fog->anisotropy};
}

std::optional<SkyOptions> read_sky_or_none(const std::string& option, const std::string& text) {
  if (text == "none") return std::nullopt;
  return read_sky(option, text);
}

void read_background(BackgroundOptions& background, const std::string& option, const std::string& text) {
  using Kind = BackgroundOptions::Kind;
  background = {.shadow_catcher = background.shadow_catcher};
  if (text == "scene") return;
  if (text == "transparent") {
    background.kind = Kind::transparent;
  } else if (looks_like_triple(text)) {
    const std::array<float, 3> rgb = parse_triple(option, text, kNotNegative);
    background.kind = Kind::color;
    background.color = {rgb[0], rgb[1], rgb[2]};
  } else {
    background.kind = Kind::file;
    background.file = text;
  }
}

OptionValue background_value(const BackgroundOptions& background) {
  using Kind = BackgroundOptions::Kind;
  if (background.kind == Kind::scene) return "scene";
  if (background.kind == Kind::transparent) return "transparent";
  if (background.kind == Kind::file) return background.file;
  return std::vector<float>{background.color.x(), background.color.y(), background.color.z()};
}

void read_aperture(LensOptions& lens, const std::string& option, const std::string& text) {
  const RealRange range{.min = 0.0, .max = 1e6};
  const bool stops = text.starts_with("f/");
  const auto value = static_cast<float>(parse_real(option, stops ? text.substr(2) : text, range));
  if (stops && !(value > 0.0f)) throw BadOption({option, text, "is not an f-stop", "more than 0"});
  lens.f_stop = stops ? value : 0.0f;
  lens.aperture = stops ? 0.0f : value;
}

std::string aperture_text(const LensOptions& lens) {
  return lens.f_stop > 0.0f ? fmt::format("f/{}", lens.f_stop) : fmt::format("{}", lens.aperture);
}

void read_clip(Clip& clip, const std::string& option, const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) throw BadOption({option, text, "", "NEAR,FAR, such as 0.1,100 or 0.1,inf"});
  const std::string far = text.substr(comma + 1);
  clip.near = static_cast<float>(parse_real(option, text.substr(0, comma), kNotNegative));
  clip.far = far == "inf" ? kInfinity : static_cast<float>(parse_real(option, far, kNotNegative));
}

OptionValue clip_value(const Clip& clip) {
  return clip == Clip() ? OptionValue() : fmt::format("{},{}", clip.near, clip.far);
}

void add_lens_options(OptionGroup& view, LensOptions& lens) {
  [[maybe_unused]] auto& [aperture, f_stop, focus, blades] = lens;  // one flag sets the first two
  view.add(read_by("aperture", lens, "f/N|METRES",
                   "Depth of field: aperture of the lens as an f-stop or a diameter; 0: everything is sharp",
                   aperture_text, read_aperture),
           {.of_view = true});
  view.add(any_word("focus", focus, "METRES|NODE",
                    "With --aperture: focus distance along the view, or an object to focus on (default: the "
                    "distance at the picture's centre, which is printed)"),
           {.of_view = true});
  view.add(number("blades", blades, {0, 64}, "N", "With --aperture: number of its corners; 0: round"),
           {.of_view = true});
}

}  // namespace

/// Checkpoints store the chosen camera and the scene's fingerprint instead.
void add_view_options(std::vector<Option>& table, renderer::CameraOptions& camera,
                      renderer::EnvironmentOptions& environment, renderer::BackgroundOptions& background) {
  OptionGroup view{table, "Scene and view"};
  // Flags of the application set look_at, frames set turn.
  [[maybe_unused]] auto& [name, index, look_at, fov_degrees, focal_mm, projection, view_height, lens, clip,
                          turn, turn_in_shutter] = camera;
  view.add(any_word("camera", name, "NAME|INDEX",
                    "Camera of the file: its name, its node's name or its index (default: the first); 'all' "
                    "renders all cameras, with {camera} in the names of the outputs"),
           {.common = true, .of_view = true, .excludes = {"eye", "target", "up"}})
      .value = [&camera] { return camera.look_at || camera.name.empty() ? OptionValue() : camera.name; };
  // Beyond these bounds tangents leave the range of single precision.
  view.add(number_or("", "fov", fov_degrees, {0.001, 179.9}, "DEGREES",
                     "Vertical field of view; overrides the camera's"),
           {.common = true, .of_view = true, .excludes = {"lens"}});
  view.add(number_or("", "lens", focal_mm, {0.1, 1e5}, "MM",
                     "Focal length, instead of --fov; the longer side of the picture is 36 mm"),
           {.of_view = true, .excludes = {"fov"}});
  view.add(choice("projection", projection,
                  "Projection of the camera in the file (camera), or another one; a panorama shows all "
                  "directions in latitude-longitude format, usually with a size of 2:1"),
           {.of_view = true});
  view.add(number_or("", "view-height", view_height, {.min = 0.0, .max = 2e12, .excludes_min = true},
                     "METRES", "Height of the visible area of an orthographic picture"),
           {.of_view = true});
  add_lens_options(view, lens);
  view.add(read_by("clip", clip, "NEAR,FAR",
                   "Distances along the view in metres between which the camera sees (default: 0,inf)",
                   clip_value, read_clip),
           {.of_view = true});
  [[maybe_unused]] auto& [automatic, file, constant, sky, rotation_degrees, scale, fog] =
      environment;  // one flag sets the first three
  view.add(read_by("environment", environment, "auto|none|r,g,b|FILE",
                   "Environment light: a soft sky if the scene is dark without it (auto), none, a constant "
                   "radiance, or a latitude-longitude .exr or .hdr",
                   environment_value, read_environment),
           {.common = true, .in_window = true, .excludes = {"sky"}});
  view.add(read_by(
               "sky", sky, "none|clear|PART=VALUE,...",
               "Clear sky with a sun, instead of --environment: turbidity=3, sun=AZIMUTH,ELEVATION (degrees; "
               "north is -z, east is +x), ground=ALBEDO, size=0.53 (diameter of the sun in degrees; 0: a "
               "directional light), intensity=1. Instead of the sun's position: date=2026-06-21, time=14:30, "
               "place=LATITUDE,LONGITUDE, zone=+2. A white surface in full daylight has a radiance of 1",
               [](const std::optional<SkyOptions>& chosen) { return chosen ? text_of(*chosen) : "none"; },
               read_sky_or_none),
           {.in_window = true, .excludes = {"environment"}});
  view.add(read_by("fog", fog, "none|DENSITY[,r,g,b[,g]]",
                   "Fog in the bounds of the scene: extinction per metre, single-scattering albedo [1,1,1], "
                   "and mean cosine of scattering [0], from -0.99 to 0.99",
                   fog_value, read_fog),
           {.in_window = true});
  // One flag sets the first three.
  [[maybe_unused]] auto& [kind, color, background_file, shadow_catcher] = background;
  view.add(
      read_by("background", background, "scene|transparent|r,g,b|FILE",
              "Background, also visible through holes and panes: the environment (scene), an alpha channel "
              "(transparent), a constant radiance or a picture. Mirrors and solid glass show the environment",
              background_value, read_background),
      {.common = true, .in_window = true, .of_denoise = true});
  view.add(any_word("shadow-catcher", shadow_catcher, "NODE;...",
                    "With a --background other than scene: objects of the file that are invisible except "
                    "for the shadows on them; a '*' at the end of a name matches any ending"));
  view.add(number("environment-rotation", rotation_degrees, kAnyFloat, "DEGREES",
                  "Rotation of the environment about +y, counter-clockwise from above"),
           {.in_window = true});
  view.add(number("environment-scale", scale, kNotNegative, "X", "Factor of the environment's radiance"),
           {.common = true, .in_window = true});
}

}  // namespace gatelight::apps
