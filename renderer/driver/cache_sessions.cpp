#include "renderer/driver/cache_sessions.h"

#include "renderer/cache/cache_file.h"
#include "renderer/cache/cache_model.h"

namespace gatelight::renderer {

std::unique_ptr<CacheSession> make_session(const PreparedPicture& picture, const RecordExchange& exchange,
                                           const CacheSetup* setup,
                                           const std::function<void(const neural::Model&)>& expect) {
  return picture.arena.execute([&] {
    return std::make_unique<CacheSession>(*picture.world, picture.camera, picture.region, picture.options,
                                          setup, expect, exchange);
  });
}

std::unique_ptr<CacheSession> read_session(const PreparedPicture& picture, const RecordExchange& exchange,
                                           const std::filesystem::path& file_name,
                                           const SceneFingerprint& scene,
                                           const std::set<std::string>& others) {
  const neural::TrainingOptions learning = training_options(picture.options);
  CacheFile file(file_name);
  file.expect(picture.cache_meaning(), scene, picture.scene.instances.size());
  std::unique_ptr<CacheSession> session =
      make_session(picture, exchange, &file.setup(),
                   [&](const neural::Model& model) { file.expect_model(model, learning); });
  session->import_state(file.read_state(session->model(), learning, others));
  return session;
}

}  // namespace gatelight::renderer
