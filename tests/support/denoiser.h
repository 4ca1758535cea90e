#pragma once
// The denoiser of tests: that of GATELIGHT_OIDN, or the one that the program would find.

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "base/errors.h"
#include "renderer/denoise/oidn_library.h"
#include "renderer/settings/options.h"

namespace gatelight::testing {

inline std::string denoiser_place() {
  const char* const place = std::getenv("GATELIGHT_OIDN");
  return place ? place : "";
}

/// The reason why there is no denoiser; empty where there is one.
inline std::string missing_denoiser() {
  try {
    renderer::load_oidn(denoiser_place());
    return "";
  } catch (const MissingDenoiser& error) {
    return error.what();
  }
}

inline void denoise(renderer::RenderOptions& options) {
  options.denoise.denoiser = renderer::DenoiserKind::oidn;
  options.denoise.library = denoiser_place();
}

}  // namespace gatelight::testing

/// Skips a test without a denoiser, or fails it where GATELIGHT_REQUIRE_OIDN is set and not 0.
#define GATELIGHT_NEEDS_DENOISER()                                    \
  do {                                                                \
    const std::string why = ::gatelight::testing::missing_denoiser(); \
    const char* const must = std::getenv("GATELIGHT_REQUIRE_OIDN");   \
    const bool required = must && std::string(must) != "0";           \
    if (!why.empty() && required) GTEST_FAIL() << why;                \
    if (!why.empty()) GTEST_SKIP() << why;                            \
  } while (false)
