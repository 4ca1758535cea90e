// Arguments, one a line, into settings and into the plan of a sweep. Nothing is run, and no file is opened.

#include <algorithm>
#include <string>
#include <vector>

#include "apps/command_line.h"
#include "apps/settings/complete_settings.h"
#include "apps/settings/flags.h"
#include "apps/sweep/plan.h"
#include "apps/sweep/request.h"
#include "apps/terminal/errors.h"
#include "tests/fuzz/input_file.h"

namespace gatelight::fuzz {
namespace {

constexpr std::size_t kMaxWords = 40;
constexpr std::size_t kMaxAxes = 2;
constexpr std::size_t kMaxValues = 5;

std::vector<std::string> words_of(Bytes bytes) {
  std::vector<std::string> words(1);
  for (const std::uint8_t byte : bytes) {
    if (byte == '\n') {
      words.emplace_back();
    } else if (byte != 0) {  // ends an argument of a real command line
      words.back().push_back(static_cast<char>(byte));
    }
  }
  return words;
}

/// Runs the part of a subcommand that handles its arguments, before it looks at files.
template <class Act>
void settle(const Act& act) {
  try {
    act();
  } catch (const BadOption& error) {
    check_line(one_line(error.what()));
  }
}

void plan_sweep(const std::vector<std::string>& words) {
  apps::SweepArguments sweep;
  sweep.scenes = {"a.glb"};
  for (const std::string& word : words) {
    const auto values = static_cast<std::size_t>(std::count(word.begin(), word.end(), ',') +
                                                 std::count(word.begin(), word.end(), ';'));
    if (word.find('=') != std::string::npos && sweep.vary.size() < kMaxAxes && values < kMaxValues)
      sweep.vary.push_back(word);
    else if (values < kMaxValues && sweep.vary.empty())
      sweep.train_steps = word;
    else if (values < kMaxValues)
      sweep.seeds = word;
  }
  plan_text(apps::make_plan(apps::make_request(sweep)));
}

}  // namespace

void command_line(Bytes bytes) {
  const std::vector<std::string> words = words_of(bytes);
  if (words.size() > kMaxWords) return;
  std::vector<const char*> argv = {"gatelight"};
  for (const std::string& word : words) {
    if (word.find("--conf") != std::string::npos) return;  // config_file tests it
    argv.push_back(word.c_str());
  }
  const int code = apps::read_only(static_cast<int>(argv.size()), argv.data());
  if (code != apps::kDone && code != apps::kUsage) throw Violation("exit code " + std::to_string(code));

  const std::vector<std::string> rest(words.begin() + 1, words.end());
  settle([&] {
    apps::RenderSettings settings = apps::parse_render_arguments("a.glb", rest);
    apps::complete_settings(settings);
  });
  if (words[0] == "sweep") settle([&] { plan_sweep(rest); });
}

}  // namespace gatelight::fuzz
