#include "tests/fuzz/made_cache.h"

#include <algorithm>
#include <array>

#include "base/errors.h"
#include "base/file/content_digest.h"
#include "neural/cpu/cpu_backend.h"
#include "renderer/cache/cache_model.h"
#include "renderer/transport/world.h"
#include "tests/fuzz/input_file.h"
#include "tests/support/scene_builder.h"
#include "tests/support/stored_state.h"

namespace gatelight::fuzz {
namespace {
using testing::SceneBuilder;

scene::Scene two_squares() {
  SceneBuilder builder;
  const int matte = builder.material(SceneBuilder::lambert(Color(0.8f, 0.7f, 0.6f)));
  scene::Material thin = SceneBuilder::lambert(Color(0.5f, 0.5f, 0.5f));
  thin.double_sided = true;
  builder.quad(matte, Vec3(-1, -1, 0), Vec3(2, 0, 0), Vec3(0, 2, 0));
  builder.quad(builder.material(thin), Vec3(-1, -1, 1), Vec3(1, 0, 0), Vec3(0, 1, 0));
  return builder.scene();
}

}  // namespace

struct MadeCache::Built {
  scene::Scene scene = two_squares();
  renderer::World world{scene};
};

MadeCache::MadeCache() : built_(std::make_unique<Built>()) {
  instances = built_->scene.instances.size();
  options.integrator = renderer::Integrator::nrc;
  options.ao_distance = 1.0f;
  options.cache.gate.features = 1;
  options.cache.mlp.width = 16;
  options.cache.mlp.hidden_layers = 1;
}

MadeCache::~MadeCache() = default;

neural::TrainingOptions MadeCache::training() const {
  return renderer::training_options(options);
}

std::shared_ptr<const neural::Model> MadeCache::model(const renderer::CacheSetup& setup) const {
  return renderer::make_cache_model(built_->world, options, setup);
}

renderer::CacheState MadeCache::state() const {
  renderer::CacheState state;
  state.setup = {{neural::Sides::front, neural::Sides::both}, 0.7f, {1.0f, 0.5f}, 0.3f, 5.5f, 2.5f};
  state.model = neural::testing::any_state(*model(state.setup), training(), 1);
  for (auto* values : {&state.model.parameters, &state.model.averages, &state.model.first_moments,
                       &state.model.second_moments}) {
    for (float& value : *values) value = std::clamp(value, -1.0f, 1.0f);
  }
  state.steps = 7;
  state.triangle_counts = {1, 2};
  state.guard.loss_average = state.guard.loss_least = 0.5;
  return state;
}

void MadeCache::use(std::shared_ptr<const neural::Model> model, const renderer::CacheState& state) const {
  const auto backend = neural::cpu::make_cpu_backend(model, training(), std::nullopt);
  backend->import_state(state.model);
  const std::array<std::uint32_t, 2> surfaces = {0, 2};
  const std::array<std::uint32_t, 2> triangles = {0, 1};
  const std::array<neural::Float2, 2> barycentrics = {neural::Float2{0.2f, 0.3f}, neural::Float2{0.0f, 0.9f}};
  const std::array<neural::Float3, 2> directions = {neural::Float3{0, 0, 1}, neural::Float3{0, 1, 0}};
  neural::QueryBatch batch{
      .surfaces = surfaces, .triangles = triangles, .barycentrics = barycentrics, .size = 2};
  batch.directions = batch.normals = directions;
  std::array<float, 6> answers{};
  backend->query(batch, {}, answers);
}

renderer::CheckpointIdentity made_identity() {
  return {{{"seed", "1"}, {"size", "2x2"}}, kFingerprint, made_cache().instances};
}

renderer::Film made_film() {
  return {{0, 0, 2, 2},
          2,
          2,
          {.aovs = {renderer::Aov::depth, renderer::Aov::normal}, .half = true, .guides = true}};
}

std::vector<std::uint8_t> with_right_digest(Bytes file) {
  static const InputFile input("damaged");
  try {
    SafetensorsReader reader(input.write(file));
    std::vector<std::vector<std::byte>> contents;
    std::vector<TensorView> tensors;
    for (const std::string& name : reader.names()) {
      std::vector<std::byte> bytes;
      reader.read_in_pieces(name, [&](std::span<const std::byte> piece) {
        bytes.insert(bytes.end(), piece.begin(), piece.end());
      });
      contents.push_back(std::move(bytes));
      tensors.push_back({.name = name, .data = contents.back()});
    }
    const auto found = reader.metadata().find(kDigestKey);
    const std::string right = content_digest(tensors, reader.metadata());
    if (found == reader.metadata().end() || found->second.size() != right.size())
      return {file.begin(), file.end()};
    std::string text(file.begin(), file.end());
    std::string quoted = "\"";
    quoted.append(found->second).append("\"");
    const std::size_t at = text.find(quoted);
    if (at != std::string::npos) text.replace(at + 1, right.size(), right);
    return {text.begin(), text.end()};
  } catch (const CacheFileError&) {
    return {file.begin(), file.end()};
  }
}

const MadeCache& made_cache() {
  static const MadeCache cache;
  return cache;
}

}  // namespace gatelight::fuzz
