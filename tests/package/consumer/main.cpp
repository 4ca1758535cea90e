// A stranger's program: it finds the package, loads a scene and renders it through the installed headers.
#include <algorithm>
#include <cstdio>

#include "renderer/render.h"
#include "scene/gltf.h"

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
  return lit ? 0 : 1;
}
