#include "scene/gltf/shutter_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "base/to_number.h"
#include "scene/gltf/visibility.h"
#include "scene/shutter.h"

namespace gatelight::scene::gltf {

/// The opening, the middle, the closing, or a time at which a value bends or jumps.
struct ShutterTimes::Point {
  double seconds;
  double place;  ///< in the shutter, from 0 to 1
  bool jumps = false;
};

namespace {

/// Radians between two states at which the user is told: chords lose a 100th of the radius.
constexpr double kCoarseTurn = 0.28;

constexpr int kIntervals = kShutterKeys - 1;  ///< where nothing bends or jumps
constexpr double kRounding = 1e-6;

/// Materials, the light of lamps and what rays see stand still in a shutter.
bool moves_in_shutter(const Animator::Track& track) {
  const std::string_view pointer = track.pointer;
  if (pointer.find(kVisibilityExtension) != std::string_view::npos) return false;
  return pointer.starts_with("/nodes/") || pointer.starts_with("/meshes/") ||
         pointer.starts_with("/cameras/");
}

/// The times in (from, to] at which a value bends (false) or jumps (true).
std::map<float, bool> find_corners(const Animator& animator, float from, float to) {
  std::map<float, bool> corners;
  for (const Animator::Track& track : animator.tracks()) {
    if (!moves_in_shutter(track)) continue;
    const std::vector<float>& keys = *track.curve.times;
    for (auto key = std::upper_bound(keys.begin(), keys.end(), from); key != keys.end() && *key <= to;
         ++key) {
      const Passage passage = passage_at(track.curve, *key);
      if (passage != Passage::smooth) corners[*key] |= passage == Passage::jump;
    }
  }
  return corners;
}

/// Between two points, or a jump.
struct Piece {
  double from, to;      ///< seconds
  double place, width;  ///< in the shutter
  bool jumps;           ///< at its end
  int intervals = 1;

  double width_of_one() const { return width / intervals; }
};

/// Divides the pieces by their widths, into `least` intervals or more. Returns their number.
int share(std::vector<Piece>& pieces, int least) {
  int sum = 0;
  for (Piece& piece : pieces) {
    piece.intervals = std::max(1, static_cast<int>(std::ceil(piece.width * kIntervals - kRounding)));
    sum += piece.intervals;
  }
  for (; sum < least; ++sum) {
    const auto narrower = [](const Piece& a, const Piece& b) { return a.width_of_one() < b.width_of_one(); };
    ++std::max_element(pieces.begin(), pieces.end(), narrower)->intervals;
  }
  return sum;
}

}  // namespace

ShutterTimes::ShutterTimes(const Animator& animator, double middle, double length, Warnings& warnings) {
  const double opens = middle - 0.5 * length;
  std::vector<Point> points{{opens, 0.0}};
  Point centre{middle, 0.5}, closing{middle + 0.5 * length, 1.0};
  const auto single = [](const Point& point) { return static_cast<float>(point.seconds); };
  const std::map<float, bool> corners = find_corners(animator, single(points[0]), single(closing));
  const auto jumps_at = [&](const Point& point) {
    const auto found = corners.find(single(point));
    return found != corners.end() && found->second;
  };
  centre.jumps = jumps_at(centre);
  closing.jumps = jumps_at(closing);
  const auto add_between = [&](float from, float to) {
    for (const auto& [key, jumps] : corners) {
      const auto seconds = static_cast<double>(key);
      if (key > from && key < to) points.push_back({seconds, (seconds - opens) / length, jumps});
    }
  };
  add_between(single(points[0]), single(centre));
  points.push_back(centre);
  add_between(single(centre), single(closing));
  points.push_back(closing);
  const bool few = corners.size() <= static_cast<std::size_t>(kMaxShutterIntervals);
  if (few) divide(points, 0);
  if (few && intervals() <= kMaxShutterIntervals) return;
  warnings.add(fmt::format("{} keys while the shutter is open: motion blur uses {} evenly spaced times",
                           corners.size(), kMaxShutterIntervals + 1));
  centre.jumps = closing.jumps = false;
  divide({points.front(), centre, closing}, kMaxShutterIntervals / 2);
}

void ShutterTimes::divide(const std::vector<Point>& points, int least) {
  std::vector<Piece> halves[2];
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Point &a = points[i], &b = points[i + 1];
    std::vector<Piece>& half = halves[a.place < 0.5 ? 0 : 1];
    half.push_back({a.seconds, b.seconds, a.place, b.place - a.place, b.jumps});
    if (b.jumps && b.place < 1.0) half.push_back({b.seconds, b.seconds, b.place, 0.0, false});
  }
  share(halves[0], share(halves[1], std::max(least, share(halves[0], least))));
  moments_ = {{points.front().seconds, false}};
  std::vector<double> places{0.0};
  for (const std::vector<Piece>& half : halves) {
    for (const Piece& piece : half) {
      for (int k = 1; k <= piece.intervals; ++k) {
        const double part = static_cast<double>(k) / piece.intervals;
        const bool ends = k == piece.intervals;
        moments_.push_back(
            {ends ? piece.to : piece.from + part * (piece.to - piece.from), ends && piece.jumps});
        places.push_back(piece.place + part * piece.width);
      }
    }
  }
  bool even = true;
  for (int k = 0; k <= intervals(); ++k)
    even &= std::abs(places[static_cast<std::size_t>(k)] - static_cast<double>(k) / intervals()) < kRounding;
  clock_.clear();
  if (!even) clock_.assign(places.begin(), places.end());
}

ShutterTimes::Moment ShutterTimes::moment(int k, int parts) const {
  const Moment& from = moments_[static_cast<std::size_t>(k / parts)];
  if (k % parts == 0) return from;
  const Moment& to = moments_[static_cast<std::size_t>(k / parts + 1)];
  if (from.seconds == to.seconds) return from;
  return {from.seconds + (to.seconds - from.seconds) * (k % parts) / parts, false};
}

void ShutterTimes::note_turns(const Animator& animator, Motion& motion, Warnings& warnings) const {
  motion.turns = false;
  for (NodeMotion& node : motion.nodes) node.turn = 0.0;
  for (const Animator::Track& track : animator.tracks()) {
    if (!track.curve.shape.is_rotation || !moves_in_shutter(track)) continue;
    const std::optional<std::size_t> node = to_number<std::size_t>(split_pointer(track.pointer)[1]);
    if (!node || *node >= motion.nodes.size()) continue;
    double& turn = motion.nodes[*node].turn;
    for (std::size_t i = 0; i + 1 < moments_.size(); ++i)
      turn = std::max(turn, turn_between(track.curve, moments_[i].seconds, moments_[i + 1].seconds));
    motion.turns |= turn > 0.0;
    const int parts = parts_of_turn(turn, intervals());
    const double step = turn / parts;
    if (step > kCoarseTurn)
      warnings.add(
          fmt::format("{}: turns by {:.0f} degrees between two of {} states of the open shutter; its "
                      "arc becomes a polygon",
                      track.pointer, step * 180.0 / kPi, intervals() * parts + 1));
  }
}

}  // namespace gatelight::scene::gltf
