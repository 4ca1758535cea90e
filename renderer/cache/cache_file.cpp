#include "renderer/cache/cache_file.h"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "base/file/content_digest.h"
#include "renderer/cache/cache_content.h"
#include "renderer/fingerprint/named_texts.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::renderer {
namespace {

constexpr const char* kFormat = "gatelight-scene-cache";
constexpr int kVersion = 3;
constexpr const char* kMeaning = "cache";

NamedTexts texts_of(const CacheMeaning& meaning) {
  const auto& [options, ao_distance] = meaning;
  NamedTexts texts = {{"integrator", enum_name(options.integrator)},
                      {"encoding", enum_name(options.cache.encoding)}};
  if (options.integrator == Integrator::nao) {
    texts.push_back({"ao-distance", fmt::format("{}", ao_distance)});
  } else {
    texts.push_back({"cache-holds", enum_name(options.cache.component)});
    texts.push_back({"cache-roughness", fmt::format("{}", options.cache.min_roughness)});
  }
  return texts;
}

}  // namespace

void write_cache_file(const std::filesystem::path& path, const CacheState& state, const neural::Model& model,
                      const neural::TrainingOptions& options, const CacheMeaning& meaning,
                      const SceneFingerprint& scene, const OtherContent& other) {
  CacheContent content;
  fill_cache_content(content, model, options, state);
  content.tensors.insert(content.tensors.end(), other.tensors.begin(), other.tensors.end());
  Metadata& metadata = content.model.metadata;
  metadata.insert(other.metadata.begin(), other.metadata.end());
  metadata["format"] = kFormat;
  metadata["version"] = fmt::format("{}", kVersion);
  add_texts(metadata, kMeaning, texts_of(meaning));
  add_texts(metadata, kScene, scene);
  metadata[kDigestKey] = content_digest(content.tensors, metadata);
  write_safetensors(path, content.tensors, metadata);
}

CacheFile::CacheFile(const std::filesystem::path& path) : file_(path) {
  neural::expect_text(file_, "format", "format", kFormat);
  neural::expect_version(file_, kVersion);
  setup_ = read_cache_setup(file_);
}

void CacheFile::expect(const CacheMeaning& meaning, const SceneFingerprint& scene,
                       std::size_t instances) const {
  std::string differences = list_differences(file_.metadata(), kMeaning, texts_of(meaning));
  const CacheOptions& cache = meaning.options.cache;
  const bool spaced = cache.node_spacing && cache.encoding == neural::FeatureEncoding::gate &&
                      cache.gate.rule == neural::ResolutionRule::uniform;
  if (spaced && *cache.node_spacing != setup_.node_spacing) {
    differences += fmt::format("{}node-spacing: file {}, expected {}", differences.empty() ? "" : "; ",
                               setup_.node_spacing, *cache.node_spacing);
  }
  if (!differences.empty()) file_.fail(fmt::format("it holds another cache: {}", differences));
  const bool occlusion = meaning.options.integrator == Integrator::nao;
  expect_scene(file_, scene,
               occlusion ? std::vector<std::string>{"lights", "environment"} : std::vector<std::string>{});
  if (setup_.sides.size() != instances)
    file_.fail(fmt::format("sides of {} instances, expected {}", setup_.sides.size(), instances));
}

void CacheFile::expect_model(const neural::Model& model, const neural::TrainingOptions& options) const {
  neural::expect_model(file_, model, options);
}

CacheState CacheFile::read_state(const neural::Model& model, const neural::TrainingOptions& options,
                                 std::set<std::string> others) {
  return read_cache_state(file_, model, options, std::move(others));
}

}  // namespace gatelight::renderer
