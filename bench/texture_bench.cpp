// texture/{ours,oiio}/{coherent,random}/{fine,coarse}: a lookup of four channels, bilinear in one level, in
// the same eight pictures. Coherent lookups are neighbours, one texel of the level apart, 256 in a row from
// one picture. Random lookups are at any point of any picture. OpenImageIO has its best conditions: tiled and
// mipmapped files of its own format, all in its cache before the clock starts, handles and per-thread data at
// hand, and no derivatives. ours/.../srgb also decodes sRGB, which OpenImageIO's texture system does not.

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/texture.h>
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "renderer/sampling/sampler.h"
#include "renderer/surface/ray.h"
#include "renderer/surface/texture.h"

namespace gatelight::bench {
namespace {

using renderer::Encoding;

constexpr int kPictures = 8;
constexpr int kSize = 1024;
constexpr int kLookups = 1 << 16;

/// A picture of smooth colours with some grain, different for every index.
scene::Image picture(int index) {
  scene::Image image;
  image.width = image.height = kSize;
  image.channels = 4;
  image.pixels.resize(static_cast<std::size_t>(kSize) * kSize * 4);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const float wave = std::sin(0.00001f * static_cast<float>(i) + static_cast<float>(index));
    const std::uint32_t grain =
        renderer::hash(static_cast<std::uint32_t>(i) + 77u * static_cast<std::uint32_t>(index)) & 31;
    image.pixels[i] = static_cast<std::uint8_t>(112.0f + 96.0f * wave + static_cast<float>(grain));
  }
  return image;
}

/// The same pictures for both libraries.
struct Pictures {
  scene::Scene scene;
  std::unique_ptr<renderer::Textures> ours;
  std::filesystem::path folder;
  OIIO::TextureSystem* theirs = nullptr;
  std::vector<OIIO::TextureSystem::TextureHandle*> handles;

  Pictures() {
    for (int i = 0; i < kPictures; ++i) {
      scene.images.push_back(picture(i));
      scene.textures.emplace_back().image = i;
      scene::Material& material = scene.materials.emplace_back();
      material.base_color_texture.texture = material.metallic_roughness_texture.texture = i;
    }
    ours = std::make_unique<renderer::Textures>(scene);

    folder = std::filesystem::temp_directory_path() / ("gatelight-bench-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    theirs = OIIO::TextureSystem::create(false);
    theirs->attribute("max_memory_MB", 1024.0f);
    for (int i = 0; i < kPictures; ++i) {
      const std::string file = (folder / (std::to_string(i) + ".tx")).string();
      const OIIO::ImageBuf source(OIIO::ImageSpec(kSize, kSize, 4, OIIO::TypeDesc::UINT8),
                                  scene.images[static_cast<std::size_t>(i)].pixels.data());
      OIIO::ImageSpec as;
      as.tile_width = as.tile_height = 64;
      as.format = OIIO::TypeDesc::UINT8;
      OIIO::ImageBufAlgo::make_texture(OIIO::ImageBufAlgo::MakeTxTexture, source, file, as);
      handles.push_back(theirs->get_texture_handle(OIIO::ustring(file)));
    }
  }
  ~Pictures() {
    OIIO::TextureSystem::destroy(theirs);
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }
  Pictures(const Pictures&) = delete;
  Pictures& operator=(const Pictures&) = delete;
};

const Pictures& pictures() {
  static const Pictures instance;
  return instance;
}

struct Lookup {
  std::uint32_t picture;
  Vec2 uv;
};

std::vector<Lookup> lookups(bool random, int level) {
  const float texel = std::ldexp(1.0f / kSize, level);
  std::vector<Lookup> result;
  for (std::uint32_t i = 0; i < kLookups; ++i) {
    if (random) {
      const renderer::Sampler sampler(renderer::SamplerKind::independent, 0, i, 0, 0);
      result.push_back({renderer::hash(i) % kPictures, sampler.get_2d(0)});
    } else {
      // Tiles of 16x16 pixels, in the order of the renderer.
      const std::uint32_t tile = i / 256;
      const Vec2 origin(static_cast<float>(tile % 8) / 8.0f, static_cast<float>(tile / 8) / 32.0f);
      const Vec2 step(static_cast<float>(i % 16) + 0.3f, static_cast<float>(i / 16 % 16) + 0.7f);
      result.push_back({tile % kPictures, origin + step * texel});
    }
  }
  return result;
}

/// Times all lookups. `read` returns the sum of two channels.
template <class Read>
void time_lookups(benchmark::State& state, bool random, int level, Read&& read) {
  const std::vector<Lookup> all = lookups(random, level);
  float sum = 0.0f;
  const auto pass = [&] {
    sum = 0.0f;
    for (const Lookup& at : all) sum += read(at);
    benchmark::DoNotOptimize(sum);
  };
  pass();  // warm up
  for (auto _ : state) pass();
  state.SetItemsProcessed(state.iterations() * kLookups);
  // Shows that both read the same pictures.
  state.counters["mean"] = static_cast<double>(sum) / (2.0 * kLookups);
}

void ours(benchmark::State& state, bool random, int level, Encoding encoding) {
  const Pictures& p = pictures();
  // The footprint is half a level above `level`, so u_level = 0 always reads `level`.
  const float footprint = std::ldexp(1.4f / kSize, level);
  time_lookups(state, random, level, [&](const Lookup& at) {
    const scene::Material& material = p.scene.materials[at.picture];
    const Vec4 value = p.ours->lookup(
        encoding == Encoding::srgb ? material.base_color_texture : material.metallic_roughness_texture,
        encoding, at.uv, footprint, 0.0f);
    return value.x() + value.w();
  });
}

void oiio(benchmark::State& state, bool random, int level) {
  const Pictures& p = pictures();
  OIIO::TextureSystem::Perthread* thread = p.theirs->get_perthread_info();
  OIIO::TextureOpt options;
  options.swrap = options.twrap = OIIO::TextureOpt::WrapPeriodic;
  options.interpmode = OIIO::TextureOpt::InterpBilinear;
  options.mipmode = OIIO::TextureOpt::MipModeOneLevel;
  const float width = std::ldexp(1.0f / kSize, level);
  time_lookups(state, random, level, [&](const Lookup& at) {
    float value[4];
    p.theirs->texture(p.handles[at.picture], thread, options, at.uv.x(), at.uv.y(), width, 0.0f, 0.0f, width,
                      4, value);
    return value[0] + value[3];
  });
}

const int texture_registered = [] {
  for (const bool random : {false, true}) {
    for (const int level : {0, 4}) {
      const std::string name =
          std::string(random ? "random" : "coherent") + (level == 0 ? "/fine" : "/coarse");
      const auto add = [&](const std::string& first, const std::string& last, auto&& function) {
        benchmark::RegisterBenchmark(("texture/" + first + "/" + name + last).c_str(), function)
            ->Unit(benchmark::kMillisecond);
      };
      add("ours", "", [=](benchmark::State& s) { ours(s, random, level, Encoding::linear); });
      add("ours", "/srgb", [=](benchmark::State& s) { ours(s, random, level, Encoding::srgb); });
      add("oiio", "", [=](benchmark::State& s) { oiio(s, random, level); });
    }
  }
  return 0;
}();

}  // namespace
}  // namespace gatelight::bench
