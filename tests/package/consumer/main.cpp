// An external program: it finds the package, loads a scene and renders it through the installed headers, and
// trains a network.
#include <algorithm>
#include <cstdio>

#include "neural/cpu/cpu_backend.h"
#include "renderer/render.h"
#include "scene/gltf.h"

// Whether a network with directions as input can be trained to answer 1.
static bool learns() {
  namespace neural = gatelight::neural;
  neural::ModelConfig config;
  config.encoding = neural::FeatureEncoding::none;
  config.auxiliary = neural::composite_inputs({});
  config.mlp.outputs = 1;
  const auto backend = neural::cpu::make_cpu_backend(neural::make_model(config), {});
  const std::vector<neural::Float3> directions(64, {0, 0, 1});
  const std::vector<float> targets(64, 1.0f);
  neural::TrainingBatch batch;
  batch.points.directions = directions;
  batch.points.size = directions.size();
  batch.targets = targets;
  for (int step = 0; step < 100; ++step) backend->train(batch);
  std::vector<float> answers(64);
  backend->query(batch.points, {}, answers);
  return answers[0] > 0.9f && answers[0] < 1.1f;
}

int main(int argc, char** argv) {
  if (argc != 2) return 1;
  const gatelight::scene::Scene scene = gatelight::scene::load_gltf(argv[1]);
  gatelight::renderer::RenderOptions options;
  options.width = options.height = 16;
  options.spp = 4;
  gatelight::renderer::Renderer renderer(scene, options);
  const gatelight::renderer::Picture picture = renderer.render();
  const std::vector<float>& values = picture.layers.front().values;
  const bool lit = std::any_of(values.begin(), values.end(), [](float value) { return value > 0.0f; });
  std::printf("%zu triangles, %d x %d pixels, %s\n", gatelight::scene::count_triangles(scene), picture.width,
              picture.height, lit ? "lit" : "black");
  return lit && learns() ? 0 : 1;
}
