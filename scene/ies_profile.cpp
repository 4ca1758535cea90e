#include "scene/ies_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include "base/errors.h"
#include "base/to_number.h"

namespace gatelight::scene {
namespace {

constexpr std::size_t kRows = 721;     // 0 to 180 degrees
constexpr std::size_t kColumns = 145;  // 0 to 360 degrees
constexpr int kMaxAngles = 10000;
constexpr std::size_t kMaxBytes = 64 << 20;

/// The numbers of the file, separated by blanks, commas and ends of lines.
class Numbers {
 public:
  explicit Numbers(std::string_view text) : rest_(text) {}

  double next(std::string_view what) {
    const auto part = [](char c) { return c == ',' || c == '\x7f' || static_cast<unsigned char>(c) <= ' '; };
    rest_.remove_prefix(
        static_cast<std::size_t>(std::find_if_not(rest_.begin(), rest_.end(), part) - rest_.begin()));
    if (rest_.empty()) throw InputError(fmt::format("the file ends before {}", what));
    const std::string_view word = rest_.substr(
        0, static_cast<std::size_t>(std::find_if(rest_.begin(), rest_.end(), part) - rest_.begin()));
    rest_.remove_prefix(word.size());
    const std::string_view digits = word.substr(word.front() == '+' ? 1 : 0);
    const std::optional<double> value = to_number<double>(digits);
    if (!value || !std::isfinite(*value))
      throw InputError(fmt::format("{} is '{}', expected a number", what, word.substr(0, 40)));
    return *value;
  }

  int count(std::string_view what, int least) {
    const double value = next(what);
    if (!(value >= least && value <= kMaxAngles) || value != std::floor(value))
      throw InputError(fmt::format("{} is {}, expected {} to {}", what, value, least, kMaxAngles));
    return static_cast<int>(value);
  }

  std::vector<double> angles(std::string_view what, int count, double most) {
    std::vector<double> angles;
    for (int i = 0; i < count; ++i) {
      angles.push_back(next(what));
      if (!(angles.back() >= 0.0 && angles.back() <= most))
        throw InputError(fmt::format("{} is {}, expected 0 to {} degrees", what, angles.back(), most));
      if (i > 0 && !(angles.back() > angles[angles.size() - 2]))
        throw InputError(fmt::format("{} {} comes after {}, expected more", what, angles.back(),
                                     angles[angles.size() - 2]));
    }
    return angles;
  }

 private:
  std::string_view rest_;
};

/// The text after the line "TILT=", and the choice that the line makes.
struct Body {
  std::string_view numbers;
  bool tilt_follows = false;
};

Body find_body(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    std::string_view line = text.substr(at, end - at);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (line.starts_with("TILT=")) return {text.substr(end), line.substr(5).starts_with("INCLUDE")};
    at = end + 1;
  }
  throw InputError("there is no line 'TILT=', expected a photometric file of the IES (LM-63)");
}

/// The place of a value among sorted ones: between `below` and the next, at `share` of the way.
struct Place {
  std::size_t below = 0;
  double share = 0.0;
};

Place place_of(const std::vector<double>& sorted, double value) {
  const auto above = std::upper_bound(sorted.begin(), sorted.end(), value);
  if (above == sorted.begin()) return {};
  if (above == sorted.end()) return {sorted.size() - 1, 0.0};
  const double low = above[-1];
  return {static_cast<std::size_t>(above - sorted.begin()) - 1, (value - low) / (*above - low)};
}

/// The measured candela.
struct Web {
  std::vector<double> vertical, horizontal;  ///< degrees
  std::vector<double> candela;               ///< plane after plane

  /// The measured angle that is the same as this one, by the symmetry that the last angle stands for.
  double measured(double around) const {
    const double first = horizontal.front(), last = horizontal.back();
    if (first == 90.0 && last == 270.0) {
      const double mirrored = around < 90.0 || around > 270.0 ? 180.0 - around : around;
      return mirrored < 0.0 ? mirrored + 360.0 : mirrored;
    }
    if (last <= 180.0 && around > 180.0) around = 360.0 - around;
    return last <= 90.0 && around > 90.0 ? 180.0 - around : around;
  }

  double in_plane(std::size_t plane, double angle) const {
    if (angle < vertical.front() || angle > vertical.back()) return 0.0;
    const double* const values = &candela[plane * vertical.size()];
    const Place at = place_of(vertical, angle);
    return at.share > 0.0 ? std::lerp(values[at.below], values[at.below + 1], at.share) : values[at.below];
  }

  double at(double angle, double around) const {
    if (horizontal.size() == 1) return in_plane(0, angle);
    around = measured(around);
    if (around > horizontal.back()) {  // from the last plane on to the first
      const double share = (around - horizontal.back()) / (360.0 - horizontal.back());
      return std::lerp(in_plane(horizontal.size() - 1, angle), in_plane(0, angle), share);
    }
    const Place plane = place_of(horizontal, around);
    const double low = in_plane(plane.below, angle);
    return plane.share > 0.0 ? std::lerp(low, in_plane(plane.below + 1, angle), plane.share) : low;
  }
};

void check_horizontal(const std::vector<double>& angles) {
  const double first = angles.front(), last = angles.back();
  const bool known =
      (first == 0.0 && (last == 0.0 || last == 90.0 || last >= 180.0)) || (first == 90.0 && last == 270.0);
  if (!known) {
    throw InputError(fmt::format(
        "horizontal angles go from {} to {}, expected 0 to 0, 90, or 180 to 360, or 90 to 270", first, last));
  }
}

Web read_web(std::string_view text) {
  const Body body = find_body(text);
  Numbers numbers(body.numbers);
  if (body.tilt_follows) {
    // Skips the dimming of a lamp when the luminaire is tilted: lights of scenes do not know how they are
    // mounted.
    numbers.next("the position of the lamp");
    const int pairs = numbers.count("the number of tilt angles", 0);
    for (int i = 0; i < 2 * pairs; ++i) numbers.next("a tilt angle or its factor");
  }
  numbers.next("the number of lamps");
  numbers.next("the lumens of a lamp");
  double factor = numbers.next("the candela multiplier");
  const int rows = numbers.count("the number of vertical angles", 2);
  const int planes = numbers.count("the number of horizontal angles", 1);
  if (const double type = numbers.next("the photometric type"); type != 1.0)
    throw InputError(fmt::format("the photometric type is {}, expected 1 (type C)", type));
  for (const char* what : {"the units", "the width", "the length", "the height"}) numbers.next(what);
  factor *= numbers.next("the ballast factor");
  factor *= numbers.next("the ballast lamp factor");
  numbers.next("the watts");
  if (!(factor > 0.0))
    throw InputError(fmt::format("the factor of all candela is {}, expected more than 0", factor));
  Web web;
  web.vertical = numbers.angles("a vertical angle", rows, 180.0);
  web.horizontal = numbers.angles("a horizontal angle", planes, 360.0);
  check_horizontal(web.horizontal);
  for (long i = 0; i < long{rows} * planes; ++i) {
    web.candela.push_back(factor * numbers.next("a candela value"));
    if (!(web.candela.back() >= 0.0 && web.candela.back() <= 1e30))
      throw InputError(fmt::format("a candela value is {}, expected 0 to 1e30", web.candela.back()));
  }
  return web;
}

}  // namespace

IesProfile::IesProfile(std::string_view text) {
  const Web web = read_web(text);
  greatest_ = *std::max_element(web.candela.begin(), web.candela.end());
  if (!(greatest_ > 0.0)) throw InputError("all candela values are 0, expected some light");
  if (web.horizontal.size() > 1) columns_ = kColumns;
  values_.reserve(kRows * columns_);
  for (std::size_t row = 0; row < kRows; ++row) {
    const double angle = static_cast<double>(row) * 0.25;
    for (std::size_t column = 0; column < columns_; ++column) {
      values_.push_back(static_cast<float>(web.at(angle, static_cast<double>(column) * 2.5) / greatest_));
      // Light between this row and the next belongs to it.
      if (values_.back() > 0.0f)
        extent_ = static_cast<float>(std::min(angle + 0.25, 180.0) * std::numbers::pi / 180.0);
    }
  }
}

float IesProfile::relative(const Vec3& direction) const {
  const float x = direction.x(), y = direction.y();
  const float row =
      std::atan2(std::sqrt(x * x + y * y), -direction.z()) * (static_cast<float>(kRows - 1) * kInvPi);
  const std::size_t r = std::min(static_cast<std::size_t>(std::max(0.0f, row)), kRows - 2);
  const auto down = std::clamp(row - static_cast<float>(r), 0.0f, 1.0f);
  if (columns_ == 1) return std::lerp(values_[r], values_[r + 1], down);
  const float turn = std::atan2(y, x) * (0.5f * kInvPi);
  const float column = (turn < 0.0f ? turn + 1.0f : turn) * static_cast<float>(kColumns - 1);
  const std::size_t c = std::min(static_cast<std::size_t>(std::max(0.0f, column)), kColumns - 2);
  const auto across = std::clamp(column - static_cast<float>(c), 0.0f, 1.0f);
  const auto in_row = [&](std::size_t which) {
    const float* const values = &values_[which * kColumns + c];
    return std::lerp(values[0], values[1], across);
  };
  return std::lerp(in_row(r), in_row(r + 1), down);
}

IesProfile read_ies_profile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(kMaxBytes + 1, '\0');
  if (!file || std::filesystem::is_directory(path))
    throw InputError(fmt::format("cannot read '{}'", path.string()));
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kMaxBytes)
    throw InputError(fmt::format("{}: expected at most {} bytes", path.string(), kMaxBytes));
  try {
    return IesProfile(text);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace gatelight::scene
