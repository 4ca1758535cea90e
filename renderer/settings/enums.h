#pragma once
// The enumerations of the options. enum_names.h has their names.

#include <cstdint>

namespace gatelight::renderer {

enum class Integrator : std::uint8_t {
  path,  ///< unbiased reference
  ao,    ///< ambient occlusion, reference
  nao,   ///< ambient occlusion answered by the cache
  nrc,   ///< radiance answered by the cache
};
/// Whether the integrator has a cache.
constexpr bool uses_cache(Integrator integrator) {
  return integrator == Integrator::nao || integrator == Integrator::nrc;
}
enum class MisHeuristic : std::uint8_t { balance, power };
enum class DirectLight : std::uint8_t { mis, nee, bsdf };  ///< without MIS, nee and bsdf are for tests
/// How light reaches rough surfaces through solid glass.
enum class GlassShadows : std::uint8_t {
  refract,   ///< shadow rays end at the glass, and only bounces find refracted light
  straight,  ///< rays pass tinted but not refracted, as through panes (an approximation)
};
/// Whether no ray slips between triangles that share an edge.
enum class Watertight : std::uint8_t {
  on,
  off,        ///< rays are faster, and a few in ten million slip through
  automatic,  ///< off unless light behind walls would show (driver/scene_choices.h)
};
/// How the scene is projected onto the picture.
enum class Projection : std::uint8_t {
  camera,  ///< as the camera of the file
  perspective,
  orthographic,
  panorama,  ///< all directions around the camera: latitude-longitude
};
enum class PixelFilter : std::uint8_t { box, tent, gaussian, blackman_harris };
enum class NanPolicy : std::uint8_t { drop, error };
/// The denoiser of a picture.
enum class DenoiserKind : std::uint8_t {
  automatic,  ///< Open Image Denoise if it is found, else nothing
  oidn,       ///< Open Image Denoise
  none,
};

/// Filtering of albedo and normal before they guide the denoiser, with the names of Blender.
enum class Prefilter : std::uint8_t {
  accurate,  ///< each is denoised first; the larger network reads the result
  fast,      ///< not filtered; the smaller network, which expects noise, reads them
  none,      ///< not filtered; the larger network, which expects no noise, reads them
};

/// Kinds of names that a Cryptomatte separates.
enum class MatteKind : std::uint8_t { object, material };

enum class SamplerKind : std::uint8_t {
  sobol,   ///< Owen-scrambled Sobol points, padded: every pair of dimensions is a separate (0,2)-sequence
  screen,  ///< one such sequence for all pixels, of a picture without a cache that spp ends
  independent,  ///< independent numbers, hashed from the key
};

enum class LightSelection : std::uint8_t {
  tree,   ///< light tree: distance, orientation and power (Conty Estevez and Kulla 2018)
  power,  ///< alias table over power only
};

}  // namespace gatelight::renderer
