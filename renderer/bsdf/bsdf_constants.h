#pragma once
// Constants and table shapes of the BSDF. The kernels include this file too, so it includes nothing.

namespace gatelight::renderer {

/// Below this perceptual roughness a lobe is a delta. Such a lobe is at most half a pixel wide and looks like
/// a mirror in a picture. Directions in single precision cannot resolve its peak 1 / (pi alpha^2).
constexpr float kDeltaRoughness = 0.03f;
constexpr float kDeltaAlpha = kDeltaRoughness * kDeltaRoughness;
/// Half vectors and Smith's terms need a wo that does not lie in the surface plane.
constexpr float kMinCosine = 1e-5f;
/// A shorter half vector has no reliable direction: wo and wi are opposite, both in the surface plane.
/// Squared length.
constexpr float kMinHalf2 = 1e-10f;
/// The cosine-weighted mean of Schlick's weight.
constexpr float kSchlickMean = 1.0f / 21.0f;
constexpr float kCoatIor = 1.5f;  ///< of clearcoat
constexpr float kCoatF0 = 0.04f;
/// The smallest roughness. Narrower distributions put all sheen into the last degrees above the horizon.
constexpr float kMinSheenRoughness = 0.2f;

/// GgxTables: [roughness][cosine][part].
constexpr int kGgxRoughness = 32, kGgxCosine = 32, kGgxParts = 4;
/// SheenTables: [roughness][cosine][part].
constexpr int kSheenRoughness = 16, kSheenCosine = 32, kSheenParts = 2;

}  // namespace gatelight::renderer
