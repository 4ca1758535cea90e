#pragma once
// Chooses the denoiser of a picture, and the film that it needs.

#include <string>

#include "renderer/denoise/oidn_library.h"
#include "renderer/settings/options.h"

namespace gatelight::renderer {

struct ChosenDenoiser {
  bool found = false;
  const OidnLibrary* library = nullptr;  ///< null: none, or another process denoises
  std::string missing;                   ///< why DenoiserKind::automatic found none; else empty
};

/// Of several processes only the first one, which finishes pictures, needs a library. Throws MissingDenoiser
/// there where DenoiserKind::oidn finds none.
ChosenDenoiser choose_denoiser(const RenderOptions& options);

/// The options with the choice in place of DenoiserKind::automatic. Without a denoiser, or with less samples
/// than a pixel has parts, there is no supersampling.
RenderOptions with_denoiser(RenderOptions options, const ChosenDenoiser& chosen);

/// The options of the film: with supersampling it is larger, with no more samples in all, and each of its
/// pixels is a box.
RenderOptions options_of_film(RenderOptions options);

}  // namespace gatelight::renderer
