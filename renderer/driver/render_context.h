#pragma once

#include "renderer/driver/picture_team.h"
#include "renderer/driver/prepared_picture.h"
#include "renderer/render.h"

namespace gatelight::renderer {

/// The inputs that all steps of a picture share. They outlive the steps.
struct RenderContext {
  const PreparedPicture& picture;
  PictureTeam& team;
  const Callbacks& callbacks;
};

}  // namespace gatelight::renderer
