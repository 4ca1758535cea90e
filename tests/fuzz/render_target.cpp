// A scene of unknown origin, through to the picture: what loads is rendered, plain and with a cache of one
// step.

#include <cmath>

#include "base/errors.h"
#include "renderer/render.h"
#include "scene/gltf.h"
#include "tests/fuzz/input_file.h"
#include "tests/support/made_glb.h"

namespace gatelight::fuzz {
namespace {

constexpr std::size_t kMaxTriangles = 2000;  ///< more takes long, and finds nothing else

renderer::RenderOptions smallest(renderer::Integrator integrator) {
  renderer::RenderOptions options;
  options.integrator = integrator;
  options.width = 4;
  options.height = 3;
  options.spp = 1;
  options.threads = 1;
  options.environment.constant = Color(0.5f, 0.5f, 0.5f);
  options.cache.train_steps = 1;
  options.cache.batch = 16;
  options.cache.mlp.width = 16;
  options.cache.mlp.hidden_layers = 1;
  return options;
}

void render(const scene::Scene& scene, renderer::Integrator integrator) {
  renderer::Renderer renderer(scene, smallest(integrator));
  const renderer::Picture picture = renderer.render();
  for (const renderer::Layer& layer : picture.layers) {
    for (const float value : layer.values) {
      if (!std::isfinite(value)) throw Violation("a picture that is not finite");
    }
  }
}

}  // namespace

void render(Bytes bytes) {
  static const InputFile file("scene.glb");
  try {
    const scene::Scene scene =
        scene::load_gltf(file.write(tests::made_glb(bytes)), {.missing_is_error = false});
    if (scene::count_triangles(scene) > kMaxTriangles || scene::image_bytes(scene) > 1 << 20) return;
    render(scene, renderer::Integrator::path);
    render(scene, renderer::Integrator::nrc);
  } catch (const InputError& error) {
    check_line(error.what());
  } catch (const BadOption& error) {
    check_line(error.what());
  } catch (const BadConfiguration& error) {
    check_line(error.what());
  }
}

}  // namespace gatelight::fuzz
