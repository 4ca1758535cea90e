#pragma once
// The numbers of samples at which the error of a picture is estimated.

namespace gatelight::renderer {

/// The first number of samples per pixel above `samples` at which the error is estimated: 4, 6, 8, 11, 16, 23
/// and so on, each about 1.4 times the one before. The numbers do not depend on time, so that a picture ends
/// with the same samples on every machine.
int next_check(int samples);

inline bool is_check(int samples) {
  return samples > 0 && next_check(samples - 1) == samples;
}

}  // namespace gatelight::renderer
