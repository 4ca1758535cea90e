#include "apps/settings/frame_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <regex>

#include "apps/settings/parsing.h"
#include "apps/terminal/errors.h"

namespace gatelight::apps {
namespace {

constexpr int kFurthestFrame = 10'000'000;
constexpr std::int64_t kMostFrames = 1'000'000;

const std::regex& places() {
  static const std::regex pattern(R"(%(0?)(\d*)d|(##+)|\{frame\})");
  return pattern;
}

std::string number_text(const std::smatch& place, int frame) {
  const std::string digits = place.str(2);
  const int width = std::min(digits.empty() ? 0 : std::atoi(digits.c_str()), 32);
  if (place[3].matched) return fmt::format("{:0{}}", frame, std::min<std::size_t>(place.length(3), 32));
  return place.str(1).empty() ? fmt::format("{:{}}", frame, width) : fmt::format("{:0{}}", frame, width);
}

}  // namespace

std::vector<int> FrameRange::numbers() const {
  std::vector<int> all;
  for (int frame = first; step > 0 ? frame <= last : frame >= last; frame += step) all.push_back(frame);
  return all;
}

FrameRange parse_frames(const std::string& flag, const std::string& text) {
  const auto refuse = [&](const char* expected) {
    return UsageError(fmt::format("{}: '{}', expected {}", flag, text, expected));
  };
  static const std::regex pattern(R"((-?\d+)(?::(-?\d+)(?::(-?\d+))?)?)");
  std::smatch parts;
  if (!std::regex_match(text, parts, pattern)) throw refuse("A:B or A:B:STEP, whole numbers");
  const IntegerRange frames{-kFurthestFrame, kFurthestFrame};
  const auto number = [&](std::size_t part) {
    return static_cast<int>(parse_integer(flag, parts.str(part), frames));
  };
  FrameRange range;
  range.first = range.last = number(1);
  if (parts[2].matched) range.last = number(2);
  if (parts[3].matched) range.step = number(3);
  if (range.step == 0) throw refuse("a step other than 0");
  const std::int64_t distance = std::int64_t{range.last} - range.first;
  if (distance != 0 && (distance > 0) != (range.step > 0))
    throw refuse("the last frame in the direction of the step; A:B:-1 goes backwards");
  if (distance / range.step >= kMostFrames) throw refuse("at most 1,000,000 frames");
  return range;
}

std::string text_of(const FrameRange& range) {
  std::string text = fmt::format("{}:{}", range.first, range.last);
  if (range.step != 1) text += fmt::format(":{}", range.step);
  return text;
}

ShutterRange parse_shutter(const std::string& flag, const std::string& text) {
  const std::size_t colon = text.find(':');
  constexpr double kLongest = 1000.0;
  const RealRange frames{-kLongest, kLongest};
  ShutterRange shutter;
  if (colon != std::string::npos) {
    shutter.opens = parse_real(flag, text.substr(0, colon), frames);
    shutter.closes = parse_real(flag, text.substr(colon + 1), frames);
  }
  if (!shutter.is_open())
    throw UsageError(
        fmt::format("{}: '{}', expected OPEN:CLOSE in frames, OPEN less than CLOSE", flag, text));
  return shutter;
}

std::string text_of(const ShutterRange& shutter) {
  return fmt::format("{}:{}", shutter.opens, shutter.closes);
}

bool has_frame_place(std::string_view name) {
  return std::regex_search(std::string(name.substr(name.find_last_of('/') + 1)), places());
}

void refuse_frame_place(std::string_view flag, const std::string& name) {
  const std::string file = name.substr(name.find_last_of('/') + 1);
  std::smatch found;
  if (!std::regex_search(file, found, places())) return;
  throw UsageError(
      fmt::format("{}: '{}' has the place of a frame's number, '{}', expected a name without it for a single "
                  "picture",
                  flag, name, found.str()));
}

void require_frame_place(std::string_view flag, const std::string& name) {
  if (has_frame_place(name)) return;
  throw UsageError(
      fmt::format("{}: '{}' is one file for all frames, expected a place for their number in its name: %04d",
                  flag, name));
}

std::string name_of_frame(std::string_view name, int frame) {
  const std::size_t file = name.find_last_of('/') + 1;
  std::string text(name.substr(0, file)), rest(name.substr(file));
  std::smatch place;
  while (std::regex_search(rest, place, places())) {
    text += place.prefix().str() + number_text(place, frame);
    rest = place.suffix();
  }
  return text + rest;
}

}  // namespace gatelight::apps
