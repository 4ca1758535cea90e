#pragma once
// What the cells of a sweep are compared with: rendered once, as two halves with seeds of their own whose
// difference tells the noise of their mean.

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "apps/sweep/plan.h"
#include "renderer/identity/scene_fingerprint.h"
#include "renderer/image/picture.h"
#include "renderer/render.h"
#include "scene/scene.h"

namespace gatelight::apps {

/// Of the two halves: far from those that people choose.
inline constexpr std::uint32_t kReferenceSeeds[] = {4000000007u, 4000000009u};

/// What a cell's picture would be with infinitely many samples and nothing learned: its view, light and
/// filter, but none of the choices that only make an estimate better or worse.
renderer::RenderOptions reference_options(const renderer::RenderOptions& cell, ReferenceKind kind);

struct Reference {
  ReferenceKind kind = ReferenceKind::path;
  std::string key;     ///< 16 hexadecimal digits; of one that is given those of its pixels
  std::string file;    ///< of the mean
  bool given = false;  ///< by --reference
  std::optional<int> spp;
  std::optional<double> rel_mse_noise;  ///< rel_mse that it has of its own
  std::optional<double> seconds;
};

nlohmann::ordered_json reference_json(const Reference& reference, const std::string& folder);

/// Where a reference of these settings lies, whether it is made or not. spp: of both halves together.
/// KEY.exr, KEY_a.exr, KEY_b.exr and KEY.json in `folder`.
Reference plan_reference(const RenderSettings& cell, ReferenceKind kind, const scene::Scene& scene,
                         const renderer::SceneFingerprint& fingerprint, int spp, const std::string& folder);

/// A picture that somebody else has made. Throws renderer::ImageError, renderer::CompareError where it fits
/// no picture of `cell`, InputError where it has pixels that are not finite.
Reference given_reference(ReferenceKind kind, const std::string& file, const renderer::RenderOptions& cell);

/// Reads what is there (the numbers of KEY.json into the reference) or renders what is missing or cannot be
/// read: the halves go on from their checkpoints where an earlier call was stopped. Nothing where
/// callbacks.stop asked for the end.
std::optional<renderer::Picture> make_reference(Reference& reference, const scene::Scene& scene,
                                                const RenderSettings& cell,
                                                const renderer::Callbacks& callbacks);

/// Numbers of a reference that is made already.
void read_reference_numbers(Reference& reference);

}  // namespace gatelight::apps
