#pragma once
// White balance: light of another colour is shown as white.

#include <Eigen/Core>

#include "renderer/image/tonemap.h"

namespace gatelight::renderer {

/// Multiplies linear colours of Rec. 709 so that surfaces in light of this colour temperature look as in D65:
/// Bradford adaptation (Lam 1985). The light is daylight (CIE 15:2004) from 5000 K on, a black body (Kim et
/// al. 2002) up to 4000 K, and between them a mixture. 1667 <= kelvin <= 25000; the identity at
/// kDaylightKelvin.
Eigen::Matrix3f white_balance(float kelvin);

}  // namespace gatelight::renderer
