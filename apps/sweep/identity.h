#pragma once
// Names of cells and references by what decides them, so that a sweep can be resumed.

#include <initializer_list>
#include <string>

#include "apps/settings/render_settings.h"
#include "renderer/fingerprint/scene_fingerprint.h"
#include "renderer/settings/view.h"
#include "scene/scene.h"

namespace gatelight::apps {

/// The camera that the options choose in a scene. Throws what renderer::choose_camera() throws.
renderer::View view_of(const scene::Scene& scene, const renderer::RenderOptions& options);

/// Every option that decides picture, errors or time, including seed, steps and samples, but not the content
/// of the scene's files. `view` is the chosen one.
std::string deciding_text(const RenderSettings& settings, const renderer::View& view);

/// 16 hexadecimal digits for the scene and further texts. The ID of a cell is of deciding_text(), the key of
/// its reference, machine_text() and the metrics.
std::string identity_name(const renderer::SceneFingerprint& scene, std::initializer_list<std::string> texts);

/// The name of the processor.
std::string cpu_name();

/// The processor and the instruction sets that the options choose on it. Others change the times and the last
/// digits of a cell.
std::string machine_text(const renderer::RenderOptions& options);

}  // namespace gatelight::apps
