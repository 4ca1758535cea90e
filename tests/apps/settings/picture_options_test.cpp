#include "apps/settings/picture_options.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>

#include "base/errors.h"
#include "renderer/fingerprint/deciding_options.h"
#include "renderer/settings/presets.h"
#include "tests/support/words.h"

namespace gatelight::apps {
namespace {

using namespace renderer;

/// Options all of whose values are set, so that each has a text.
RenderOptions said() {
  RenderOptions options;
  options.region = {{0, 1, 2, 3}};
  options.ao_distance = 0.3f;
  options.camera.name = "front";
  options.camera.fov_degrees = 30.1f;
  options.environment.constant = {0.1f, 2.0f, 3.0f};
  options.environment.sky = SkyOptions{.turbidity = 2.1f, .time = SunTime{.second_of_day = 4007}};
  options.aovs = {Aov::depth, Aov::primitive_id};
  options.cryptomattes = {MatteKind::material};
  options.checkpoint.file = "c";
  options.cache.cache_in = "in";
  options.cache.cache_out = "out";
  options.cache.device = "vulkan:9";
  return options;
}

std::map<std::string, OptionValue> values_of(const std::vector<Option>& table) {
  std::map<std::string, OptionValue> values;
  for (const Option& option : table) values[option.name] = option.value();
  return values;
}

/// A value of each kind; the choices of the help come first.
std::vector<std::string> words_for(const Option& option) {
  std::vector<std::string> words(1);
  for (const char c : option.unit) {
    if (c == '|') {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  words.insert(words.end(), {"0.25", "3", "0,0,1,2", "8x4", "albedo", "2,1", "vulkan"});
  return words;
}

bool reads(const Option& option, const std::string& word) {
  try {
    option.read(word);
    return true;
  } catch (const BadOption&) {
    return false;
  }
}

/// Gives the option another value. False where none of the words is one.
bool change(const Option& option) {
  const OptionValue before = option.value();
  const std::vector<std::string> words = words_for(option);
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return reads(option, word) && option.value() != before;
  });
}

/// Whether the option describes the features of the encoding gate. The others that need it decide how steps
/// are made, and are compared with any encoding.
bool is_of_gate(const Option& option, const RenderOptions& options) {
  if (std::set<std::string>{"candidates", "feature-step", "node-spacing"}.contains(option.name)) return false;
  RenderOptions gate = options;
  gate.cache.encoding = neural::FeatureEncoding::gate;
  return std::any_of(option.marks.needs.begin(), option.marks.needs.end(), [&](const Requirement& r) {
    return std::string_view(r.expected) == "`encoding` gate" && !r.met(options) && r.met(gate);
  });
}

TEST(OptionTable, EachReadsWhatItWrites) {
  for (RenderOptions options : {RenderOptions(), said()}) {
    for (const CachePreset preset : {CachePreset::standard, CachePreset::final, CachePreset::paper_nrc}) {
      apply_preset(preset, options);
      for (const Option& option : picture_options(options)) {
        const OptionValue before = option.value();
        if (!option.read || std::holds_alternative<std::monostate>(before)) continue;
        if (option.name == "aov" && option.text().empty()) continue;  // an empty list cannot be requested
        option.read(option.text());
        EXPECT_EQ(option.value(), before) << option.name << " " << option.text();
      }
    }
  }
}

TEST(OptionTable, EachSetsItsMemberAndNoOther) {
  RenderOptions defaults = said();
  for (std::size_t i = 0; i < picture_options(defaults).size(); ++i) {
    RenderOptions options = said();
    const std::vector<Option> table = picture_options(options);
    const Option& option = table[i];
    if (!option.read) continue;
    const std::map<std::string, OptionValue> before = values_of(table);
    EXPECT_TRUE(change(option)) << option.name;
    const OptionValue read = option.value();
    option.read(option.text());
    EXPECT_EQ(option.value(), read) << option.name;
    for (const auto& [name, value] : values_of(table))
      EXPECT_TRUE(name == option.name || value == before.at(name)) << option.name << " sets " << name;
  }
}

/// Options that decide no bits, or that the scene's fingerprint, the chosen camera and the instruction sets
/// stand for.
const tests::Words kDecideNothing = tests::words_of(
    "checkpoint checkpoint-every cache-out spp time-limit max-error oidn cryptomatte camera fov lens "
    "projection "
    "view-height aperture focus blades clip environment sky environment-rotation environment-scale fog nan "
    "temporal "
    "train-time threads memory-limit isa");

TEST(OptionTable, EachOtherDecidesBits) {
  RenderOptions defaults = said();
  defaults.integrator = Integrator::nrc;
  for (const neural::FeatureEncoding encoding :
       {neural::FeatureEncoding::gate, neural::FeatureEncoding::hash_grid}) {
    defaults.cache.encoding = encoding;
    const NamedTexts before = deciding_options(defaults, {}, {});
    for (std::size_t i = 0; i < picture_options(defaults).size(); ++i) {
      RenderOptions options = defaults;
      const std::vector<Option> table = picture_options(options);
      const Option& option = table[i];
      if (!option.read) continue;
      ASSERT_TRUE(change(option)) << option.name;
      const bool of_other = encoding == neural::FeatureEncoding::gate ? option.name.starts_with("hash-")
                                                                      : is_of_gate(option, options);
      const bool decides =
          std::find(kDecideNothing.begin(), kDecideNothing.end(), option.name) == kDecideNothing.end() &&
          !of_other;
      EXPECT_EQ(deciding_options(options, {}, {}) != before, decides) << option.name;
    }
  }
}

}  // namespace
}  // namespace gatelight::apps
