#pragma once
// The references of a sweep. Each is rendered once, as two halves with different seeds; their difference
// gives the noise of the mean.

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/sweep/planned.h"
#include "renderer/fingerprint/scene_fingerprint.h"
#include "renderer/image/picture.h"
#include "renderer/metrics/beauty.h"
#include "renderer/render.h"
#include "scene/scene.h"

namespace gatelight::apps {

/// Seeds of the two halves, far from those that users choose.
inline constexpr std::uint32_t kReferenceSeeds[] = {4000000007u, 4000000009u};

/// The options of the picture to which a cell would converge without learning: its view, light and filter,
/// but no options that only change the quality of the estimate.
renderer::RenderOptions reference_options(const renderer::RenderOptions& cell, ReferenceKind kind);
/// The settings of the reference, which is the same for all cells with the same ones. spp: of both halves
/// together.
RenderSettings reference_settings(const RenderSettings& cell, ReferenceKind kind, int spp);

struct Reference {
  ReferenceKind kind = ReferenceKind::path;
  std::string key;                  ///< 16 hexadecimal digits; for a given reference a digest of its pixels
  std::string file;                 ///< of the mean of both halves; for given halves the first of them
  std::vector<std::string> halves;  ///< their files; for a single given picture only that
  bool given = false;               ///< by --reference
  std::optional<int> spp;
  std::optional<double> rel_mse_noise;  ///< rel_mse of the reference itself, from its noise
  std::optional<double> seconds;

  bool is_made() const { return given || rel_mse_noise.has_value(); }
};

nlohmann::ordered_json reference_json(const Reference& reference, const std::string& folder);

/// The reference for these settings, whether it is made yet or not: KEY.exr, KEY_a.exr, KEY_b.exr and
/// KEY.json in `folder`. spp: of both halves together.
Reference plan_reference(const RenderSettings& cell, ReferenceKind kind, const scene::Scene& scene,
                         const renderer::SceneFingerprint& fingerprint, int spp, const std::string& folder);

/// A reference from a given file, or from the files of two halves. Throws InputError where it cannot be read,
/// does not fit pictures of `cell`, or has pixels that are not finite.
Reference given_reference(ReferenceKind kind, const std::vector<std::string>& files,
                          const renderer::RenderOptions& cell);

/// Reads the reference, or renders what is missing or cannot be read. Halves resume from their checkpoints
/// where an earlier call was stopped. Returns nothing where callbacks.stop ended it.
std::optional<renderer::Picture> make_reference(Reference& reference, const scene::Scene& scene,
                                                const RenderSettings& cell,
                                                const renderer::Callbacks& callbacks);

/// The squared bias of a pair of pictures that differ only in their seeds; `file` holds the first one. The
/// reference has two halves. Throws what reading a picture throws.
double measure_bias(const Reference& reference, const std::string& file,
                    const renderer::NamedPicture& second);

/// Reads the numbers of KEY.json into a reference that is already made.
void read_reference_numbers(Reference& reference);

}  // namespace gatelight::apps
