#pragma once
// Values over time: keys, and the interpolation between them.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "scene/gltf/channels.h"
#include "scene/gltf/document.h"

namespace gatelight::scene::gltf {

/// The form of an animated value.
struct CurveShape {
  int components = 1;        ///< of an element of the accessor
  std::size_t elements = 1;  ///< of the accessor for each key: one weight for each morph target
  bool is_rotation = false;  ///< a quaternion: x, y, z, w
  bool is_switch = false;    ///< false or true: there is nothing between two keys
};

struct Curve {
  using Times = std::shared_ptr<const std::vector<float>>;

  Times times;                ///< seconds, ascending, at least one
  std::vector<float> values;  ///< a row for each key; of a cubic spline three: in-tangent, value, out-tangent
  std::size_t width = 1;      ///< of a row
  Interpolation interpolation = Interpolation::linear;
  CurveShape shape;
};

/// The value at a time; before the first key and after the last one that key's value. Rotations are unit
/// quaternions. `before`: the limit from earlier times, which differs where the value jumps.
Eigen::VectorXd evaluate(const Curve& curve, double time, bool before = false);

/// How a value goes through the time of a key.
enum class Passage : std::uint8_t { smooth, bend, jump };
Passage passage_at(const Curve& curve, float time);

/// The angle in radians that a rotation turns between two times, however often.
double turn_between(const Curve& curve, double from, double to);

/// Reads the curves of a document. Channels share their times.
class CurveReader {
 public:
  CurveReader(const Document& document, Warnings& warnings) : document_(document), warnings_(warnings) {}

  /// Nothing, with a warning, for a channel without keys. Throws InputError.
  std::optional<Curve> read(const Channel& channel, const CurveShape& shape);

 private:
  Curve::Times read_times(int accessor);

  const Document& document_;
  Warnings& warnings_;
  std::map<int, Curve::Times> times_;  ///< by their accessor
};

}  // namespace gatelight::scene::gltf
