// A photometric file of the IES.

#include <cmath>
#include <string_view>

#include "base/errors.h"
#include "scene/ies_profile.h"
#include "tests/fuzz/input_file.h"

namespace gatelight::fuzz {

void ies_profile(Bytes bytes) {
  read_or_refuse<InputError>([&] {
    const scene::IesProfile profile(
        std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    if (!(profile.greatest() > 0.0) || !(profile.extent() >= 0.0f && profile.extent() <= kPi))
      throw Violation("a profile without light, or without an extent");
    for (int i = 0; i < 64; ++i) {
      const float angle = static_cast<float>(i) * 0.7f;
      const float share =
          profile.relative({std::cos(angle), std::sin(2.0f * angle), std::sin(3.0f * angle) + 0.1f});
      if (!(share >= 0.0f && share <= 1.0001f)) throw Violation("a share outside 0 to 1");
    }
  });
}

}  // namespace gatelight::fuzz
