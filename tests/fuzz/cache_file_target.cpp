// --cache-in: the bytes as they are, and with a correct digest, as an attacker would write them.

#include "base/errors.h"
#include "renderer/cache/cache_file.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/made_cache.h"

namespace gatelight::fuzz {
namespace {

void import_cache(const std::filesystem::path& path) {
  const MadeCache& made = made_cache();
  read_or_refuse<CacheFileError>([&] {
    renderer::CacheFile file(path);
    file.expect({made.options, made.options.ao_distance}, kFingerprint, made.instances);
    const auto model = made.model(file.setup());
    file.expect_model(*model, made.training());
    made.use(model, file.read_state(*model, made.training()));
  });
}

}  // namespace

void cache_file(Bytes bytes) {
  static const InputFile file("cache");
  import_cache(file.write(bytes));
  import_cache(file.write(with_right_digest(bytes)));
}

}  // namespace gatelight::fuzz
