// Scene files: their bytes as they are, and files put together of JSON and binary data, whose lengths fit.

#include "scene/gltf.h"
#include "scene/requirements.h"
#include "tests/fuzz/input_file.h"
#include "tests/support/made_glb.h"
#include "tests/support/scene_fault.h"

namespace gatelight::fuzz {
namespace {

void load(const std::filesystem::path& path) {
  read_or_refuse<InputError>([&] {
    // Another target tests pictures: unreadable ones are allowed here, so that the code behind them runs too.
    const scene::Scene scene = scene::load_gltf(path, {.time = 0.5, .missing_is_error = false});
    const std::string fault = scene::scene_fault(scene);
    if (!fault.empty()) throw Violation(fault);
    scene::compute_requirements(scene);
  });
}

}  // namespace

void gltf(Bytes bytes) {
  static const InputFile file("scene.gltf");
  load(file.write(bytes));
}

void gltf_parts(Bytes bytes) {
  static const InputFile file("scene.glb");
  load(file.write(tests::made_glb(bytes)));
}

}  // namespace gatelight::fuzz
