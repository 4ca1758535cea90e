#include "apps/settings/frame_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <system_error>
#include <unordered_set>

#include "apps/settings/parsing.h"
#include "apps/terminal/errors.h"
#include "base/to_number.h"

namespace gatelight::apps {
namespace {

constexpr int kFurthestFrame = 10'000'000;
constexpr std::int64_t kMaxFrames = 1'000'000;

/// The first alternative is a % that is written twice.
const std::regex& places() {
  static const std::regex pattern(R"(%%|%(0?)(\d*)d|(##+)|\{frame\})");
  return pattern;
}

bool is_place(const std::smatch& found) {
  return found.str() != "%%";
}

/// The first place in the text; empty: none.
std::string find_place(const std::string& text) {
  for (std::sregex_iterator found(text.begin(), text.end(), places()), end; found != end; ++found) {
    if (is_place(*found)) return found->str();
  }
  return "";
}

std::string number_text(const std::smatch& place, int frame) {
  const std::string digits = place.str(2);
  const int width = std::min(digits.empty() ? 0 : std::atoi(digits.c_str()), 32);
  if (place[3].matched) return fmt::format("{:0{}}", frame, std::min<std::size_t>(place.length(3), 32));
  return place.str(1).empty() ? fmt::format("{:{}}", frame, width) : fmt::format("{:0{}}", frame, width);
}

std::string file_of(std::string_view name) {
  return std::string(name.substr(name.find_last_of('/') + 1));
}

/// How much of the name is before the first folder that a number names; npos: no folder is.
std::size_t given_part(std::string_view name) {
  for (std::size_t begin = 0, end; (end = name.find('/', begin)) != std::string_view::npos; begin = end + 1) {
    if (!find_place(std::string(name.substr(begin, end - begin))).empty()) return begin;
  }
  return std::string_view::npos;
}

std::int64_t count_of(const FrameRange& range) {
  return (std::int64_t{range.last} - range.first) / range.step + 1;
}

FrameRange parse_range(const std::string& option, const std::string& text, const std::string& part) {
  const auto refuse = [&](const char* expected) { return BadOption({option, text, "", expected}); };
  static const std::regex pattern(R"((-?\d+)(?:[:-](-?\d+)(?:[:x](-?\d+))?)?)");
  std::smatch parts;
  if (!std::regex_match(part, parts, pattern))
    throw refuse("whole numbers: A:B or A:B:STEP, or a list such as 1,3,5-9");
  const IntegerRange frames{-kFurthestFrame, kFurthestFrame};
  const auto number = [&](std::size_t i) {
    return static_cast<int>(parse_integer(option, parts.str(i), frames));
  };
  FrameRange range;
  range.first = range.last = number(1);
  if (parts[2].matched) range.last = number(2);
  if (parts[3].matched) range.step = number(3);
  if (range.step == 0) throw refuse("a range with a step other than 0");
  if (range.last != range.first && (range.last > range.first) != (range.step > 0))
    throw refuse("a range with the last frame in the direction of the step; A:B:-1 goes backwards");
  return range;
}

}  // namespace

std::vector<int> FrameList::numbers() const {
  std::vector<int> all;
  std::unordered_set<int> named;
  for (const FrameRange& range : ranges) {
    for (std::int64_t i = 0; i < count_of(range); ++i) {
      const int frame = range.first + static_cast<int>(i) * range.step;
      if (ranges.size() == 1 || named.insert(frame).second) all.push_back(frame);
    }
  }
  return all;
}

bool FrameList::is_single() const {
  return std::all_of(ranges.begin(), ranges.end(),
                     [&](const FrameRange& range) { return range.first == first() && count_of(range) == 1; });
}

FrameList parse_frames(const std::string& option, const std::string& text) {
  FrameList frames;
  std::int64_t count = 0;
  for (const std::string& part : split(text, ',')) {
    frames.ranges.push_back(parse_range(option, text, part));
    count += count_of(frames.ranges.back());
    if (count > kMaxFrames) throw BadOption({option, text, "", "at most 1,000,000 frames"});
  }
  return frames;
}

std::string text_of(const FrameList& frames) {
  std::string text;
  for (const FrameRange& range : frames.ranges) {
    if (!text.empty()) text += ",";
    text += fmt::format("{}:{}", range.first, range.last);
    if (range.step != 1) text += fmt::format(":{}", range.step);
  }
  return text;
}

int common_step(const std::vector<int>& frames) {
  if (frames.size() < 2) return 1;
  const int step = frames[1] - frames[0];
  for (std::size_t i = 2; i < frames.size(); ++i) {
    if (frames[i] - frames[i - 1] != step) return 1;
  }
  return step;
}

double parse_fps(const std::string& option, const std::string& text) {
  constexpr RealRange kFps{1e-3, 1e6};
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return parse_real(option, text, kFps);
  const std::optional<double> above = to_number<double>(text.substr(0, slash));
  const std::optional<double> below = to_number<double>(text.substr(slash + 1));
  const double fps = above.value_or(0.0) / below.value_or(0.0);
  if (!(fps >= kFps.min && fps <= kFps.max))
    throw BadOption(
        {option, text, "",
         fmt::format("a number or a fraction such as 30000/1001, from {} to {}", kFps.min, kFps.max)});
  return fps;
}

ShutterRange parse_shutter(const std::string& option, const std::string& text) {
  const std::size_t colon = text.find(':');
  constexpr double kLongest = 1000.0;
  const RealRange frames{-kLongest, kLongest};
  ShutterRange shutter;
  if (colon != std::string::npos) {
    shutter.opens = parse_real(option, text.substr(0, colon), frames);
    shutter.closes = parse_real(option, text.substr(colon + 1), frames);
  }
  if (!shutter.is_open()) throw BadOption({option, text, "", "OPEN:CLOSE in frames, OPEN less than CLOSE"});
  return shutter;
}

std::string text_of(const ShutterRange& shutter) {
  return fmt::format("{}:{}", shutter.opens, shutter.closes);
}

bool has_frame_place(std::string_view name) {
  return !find_place(std::string(name)).empty();
}

void refuse_frame_place(std::string_view option, const std::string& name) {
  const std::string place = find_place(file_of(name));
  if (place.empty()) return;
  throw BadOption({std::string(option), name,
                   fmt::format("contains '{}', the place of a frame number", place),
                   "a name without it for a single picture"});
}

void require_frame_place(std::string_view option, const std::string& name) {
  if (has_frame_place(name)) return;
  throw BadOption({std::string(option), name, "is one file for all frames",
                   "a place for the frame number in its name: %04d"});
}

std::string name_of_frame(std::string_view name, int frame) {
  std::string text, rest(name);
  std::smatch found;
  while (std::regex_search(rest, found, places())) {
    text += found.prefix().str() + (is_place(found) ? number_text(found, frame) : "%");
    rest = found.suffix();
  }
  return text + rest;
}

std::string name_in_given_folder(std::string_view name, int frame) {
  const std::size_t given = given_part(name);
  if (given == std::string_view::npos) return name_of_frame(name, frame);
  return name_of_frame(std::string(name.substr(0, given)) + file_of(name), frame);
}

void make_folders_of_frame(std::string_view name, int frame) {
  if (given_part(name) == std::string_view::npos) return;
  std::error_code error;
  std::filesystem::create_directories(std::filesystem::path(name_of_frame(name, frame)).parent_path(), error);
}

}  // namespace gatelight::apps
