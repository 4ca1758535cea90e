#include "renderer/settings/option_table.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "renderer/machine/errors.h"

namespace gatelight::renderer {
namespace {

/// Options whose values are said, whatever they are.
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
  return options;
}

std::map<std::string, OptionValue> values_of(const std::vector<Option>& table) {
  std::map<std::string, OptionValue> values;
  for (const Option& option : table) values[option.name] = option.value();
  return values;
}

/// Some word of each kind; what the help says can be chosen comes first.
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

TEST(OptionTable, EachHasANameOfItsOwnAndAPlaceInTheHelp) {
  RenderOptions options;
  std::set<std::string> names;
  for (const Option& option : option_table(options)) {
    EXPECT_TRUE(names.insert(option.name).second) << option.name;
    EXPECT_EQ(option.has_flag(), !option.help.empty()) << option.name;
    EXPECT_EQ(option.unit.find(' '), std::string::npos) << option.name;
    if (option.name == "spp" || option.name == "batch") {
      EXPECT_EQ(option.of_cache, option.name == "batch");
    }
    EXPECT_TRUE(option.has_flag() || option.decides) << option.name << " is good for nothing";
  }
  for (const char* of_each_part : {"spp", "camera", "environment", "checkpoint", "integrator", "train-steps",
                                   "encoding", "query-at", "device", "cache-in", "threads"})
    EXPECT_TRUE(names.contains(of_each_part)) << of_each_part;
}

TEST(OptionTable, EachReadsWhatItWrites) {
  for (RenderOptions options : {RenderOptions(), said()}) {
    for (const CachePreset preset : {CachePreset::standard, CachePreset::final, CachePreset::paper_nrc}) {
      apply_preset(preset, options);
      for (const Option& option : option_table(options)) {
        const OptionValue before = option.value();
        if (!option.read || std::holds_alternative<std::monostate>(before)) continue;
        if (option.name == "aov" && option.text().empty()) continue;  // a list of none cannot be asked for
        option.read(option.text());
        EXPECT_EQ(option.value(), before) << option.name << " " << option.text();
      }
    }
  }
}

TEST(OptionTable, EachSetsItsMemberAndNoOther) {
  RenderOptions defaults = said();
  for (std::size_t i = 0; i < option_table(defaults).size(); ++i) {
    RenderOptions options = said();
    const std::vector<Option> table = option_table(options);
    const Option& option = table[i];
    if (!option.read) continue;
    const std::map<std::string, OptionValue> before = values_of(table);
    bool changed = false;
    for (const std::string& word : words_for(option)) {
      if (!reads(option, word) || option.value() == before.at(option.name)) continue;
      changed = true;
      const OptionValue read = option.value();
      option.read(option.text());
      EXPECT_EQ(option.value(), read) << option.name << " " << word;
      break;
    }
    EXPECT_TRUE(changed) << option.name;
    for (const auto& [name, value] : values_of(table))
      EXPECT_TRUE(name == option.name || value == before.at(name)) << option.name << " sets " << name;
  }
}

TEST(OptionTable, ThoseOfTheOrderComeFirst) {
  RenderOptions options;
  std::vector<Option> table = option_table(options);
  const std::size_t count = table.size();
  const std::string first = table.front().name;
  put_first(table, "isa no-such-option spp");
  EXPECT_EQ(table[0].name, "isa");
  EXPECT_EQ(table[1].name, "spp");
  EXPECT_EQ(table[2].name, first);
  EXPECT_EQ(table.size(), count);
}

}  // namespace
}  // namespace gatelight::renderer
