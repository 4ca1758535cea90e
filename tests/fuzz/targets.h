#pragma once
// The fuzz targets. Each takes the bytes of a file (or of a command line) of unknown origin and does with
// them what the program would. It returns when they were read or refused as they should be, and throws
// Violation, or lets another exception through, when they were not.

#include <cstdint>
#include <ostream>
#include <span>
#include <stdexcept>

namespace gatelight::fuzz {

using Bytes = std::span<const std::uint8_t>;

void gltf(Bytes bytes);
void gltf_parts(Bytes bytes);
void picture(Bytes bytes);
void cache_file(Bytes bytes);
void checkpoint(Bytes bytes);
void config_file(Bytes bytes);
void command_line(Bytes bytes);
void sweep_records(Bytes bytes);
void ies_profile(Bytes bytes);
void view_request(Bytes bytes);
void render(Bytes bytes);

struct Target {
  const char* name;
  void (*run)(Bytes);

  friend std::ostream& operator<<(std::ostream& stream, const Target& target) {
    return stream << target.name;
  }
};

inline constexpr Target kTargets[] = {
    {"gltf", gltf},
    {"gltf_parts", gltf_parts},
    {"picture", picture},
    {"cache_file", cache_file},
    {"checkpoint", checkpoint},
    {"config_file", config_file},
    {"command_line", command_line},
    {"sweep_records", sweep_records},
    {"ies_profile", ies_profile},
    {"view_request", view_request},
    {"render", render},
};

/// The target accepted or printed something that it must not.
struct Violation : std::logic_error {
  using std::logic_error::logic_error;
};

}  // namespace gatelight::fuzz
