// Pictures: environments and pictures to compare (EXR, PNG, HDR) and textures (PNG, JPEG). The first byte
// chooses.

#include <string>
#include <vector>

#include "renderer/denoise/denoising_layers.h"
#include "renderer/driver/denoise_picture.h"
#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"
#include "renderer/light/environment.h"
#include "scene/gltf.h"
#include "tests/fuzz/input_file.h"
#include "tests/support/made_glb.h"
#include "tests/support/png_checksums.h"
#include "tests/support/scene_fault.h"

namespace gatelight::fuzz {
namespace {

constexpr std::size_t kLargestEnvironment = 1 << 16;  ///< pixels: building more takes long

/// What `denoise` does with an EXR but for the filter.
void choose_and_edit(const renderer::Picture& picture, const std::filesystem::path& path) {
  const std::vector<renderer::LayersToDenoise> layers = renderer::layers_to_denoise(picture);
  const std::size_t pixels =
      static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  for (const renderer::LayersToDenoise& some : layers) {
    const renderer::Samples samples = renderer::samples_of(picture, some);
    const std::size_t values = 3 * pixels * static_cast<std::size_t>(samples.factor * samples.factor);
    if (samples.color.size() != values || samples.albedo.size() != samples.normal.size())
      throw Violation("samples of another size than the picture");
  }
  renderer::Picture denoised = picture;
  std::erase_if(denoised.layers, [&](const auto& layer) {
    return layers.front().own && renderer::is_denoising_layer(layer.name);
  });
  read_or_refuse<OutputError>([&] {
    renderer::encode_image(denoised, renderer::ImageFormat::exr,
                           {.edited = renderer::edited_exr(path, denoised, layers)});
  });
}

void read_picture(const std::filesystem::path& path) {
  read_or_refuse<InputError>([&] {
    const renderer::Picture picture = renderer::read_image(path);
    if (picture.width < 1 || picture.height < 1 || picture.layers.empty())
      throw Violation("an empty picture");
    const std::size_t pixels =
        static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    for (const renderer::Layer& layer : picture.layers) {
      if (layer.channels.empty() || layer.values.size() != pixels * layer.channels.size())
        throw Violation("a layer of another size than the picture");
    }
    if (pixels > kLargestEnvironment) return;
    if (path.extension() == ".exr") choose_and_edit(picture, path);
    const renderer::Environment environment({.file = path.string()});
    const Color mean = environment.mean();
    const renderer::EnvironmentSample sample = environment.sample({0.3f, 0.7f});
    if (!mean.allFinite() || !sample.radiance.allFinite() || !(sample.pdf >= 0.0f))
      throw Violation("an environment that is not finite");
  });
}

/// A triangle with the picture on it.
std::vector<std::uint8_t> textured(Bytes picture) {
  const std::string json =
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":)"
      R"([{"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0}]}],"materials":[{"pbrMetallicRoughness":)"
      R"({"baseColorTexture":{"index":0}}}],"textures":[{"source":0}],"images":[{"bufferView":1}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3},)"
      R"({"bufferView":0,"componentType":5126,"type":"VEC2","count":3}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":)" +
      std::to_string(picture.size()) + R"(}],"buffers":[{"byteLength":)" +
      std::to_string(picture.size() + 36) + "}]}";
  std::vector<std::uint8_t> parts(json.begin(), json.end());
  parts.push_back(0);
  const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(positions);
  parts.insert(parts.end(), bytes, bytes + sizeof(positions));
  parts.insert(parts.end(), picture.begin(), picture.end());
  return tests::made_glb(parts);
}

void read_texture(Bytes picture) {
  static const InputFile file("scene.glb");
  if (picture.empty()) return;
  read_or_refuse<InputError>([&] {
    const std::string fault = scene::scene_fault(scene::load_gltf(file.write(textured(picture))));
    if (!fault.empty()) throw Violation(fault);
  });
}

}  // namespace

void picture(Bytes bytes) {
  static const InputFile exr("picture.exr");
  static const InputFile png("picture.png");
  static const InputFile hdr("picture.hdr");
  if (bytes.empty()) return;
  const std::uint8_t kind = bytes[0];
  std::vector<std::uint8_t> content(bytes.begin() + 1, bytes.end());
  if ((kind & 4) != 0) repair_png_checksums(content);
  switch (kind & 3) {
    case 0:
      return read_picture(exr.write(content));
    case 1:
      return read_picture(png.write(content));
    case 2:
      return read_picture(hdr.write(content));
    default:
      return read_texture(content);
  }
}

}  // namespace gatelight::fuzz
