#pragma once
// The pictures that are compared with stored ones: their scenes and views. Shared by the tests and by the
// program that makes the references, so that both render the same thing.

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/image/picture.h"
#include "renderer/settings/options.h"
#include "scene/scene.h"

namespace gatelight::testing {

struct GoldenCase {
  std::string name;   ///< file of the reference: tests/golden/NAME.exr
  std::string scene;  ///< data/SCENE.glb
  renderer::RenderOptions options;
  int reference_spp = 2048;
  bool sky = false;  ///< under a picture of a sky, as environment
};

/// Samples are independent, so that the variance layer is exact, and options.seed is that of the tests.
std::vector<GoldenCase> golden_cases();
const GoldenCase& golden_case(const std::string& name);

std::filesystem::path golden_reference(const GoldenCase& c);
scene::Scene load_golden_scene(const GoldenCase& c);

/// Hash of the bytes of the case's scene, as text: a reference belongs to one version of its scene.
std::string golden_fingerprint(const GoldenCase& c);

/// The case's picture with its variance layer, of a scene and with options that the caller may have changed.
renderer::Picture render_golden(const GoldenCase& c, const scene::Scene& scene,
                                renderer::RenderOptions options);

}  // namespace gatelight::testing
