#pragma once
// Names of cells and references by what decides them, so that a sweep can be gone on with.

#include <initializer_list>
#include <string>

#include "apps/settings/render_settings.h"
#include "renderer/identity/scene_fingerprint.h"
#include "scene/scene.h"

namespace gatelight::apps {

/// The camera that the options choose in a scene. Throws what renderer::choose_camera() throws.
scene::Camera view_of(const scene::Scene& scene, const renderer::RenderOptions& options);

/// Every option that decides picture, errors or seconds, seed and number of steps or samples included, but
/// not what lies in the scene's files. `camera` is the chosen one.
std::string deciding_text(const RenderSettings& settings, const scene::Camera& camera);
/// Before a scene is there: the camera by its name.
std::string deciding_text(const RenderSettings& settings);

/// 16 hexadecimal digits for the scene and further texts.
std::string identity_name(const renderer::SceneFingerprint& scene, std::initializer_list<std::string> texts);

/// The ID of a cell: of the scene, deciding_text(), the key of its reference, machine_text() and what is
/// measured.
std::string cell_name(const renderer::SceneFingerprint& scene, const std::string& deciding,
                      const std::string& reference, const std::string& machine, bool hdr_flip);

/// As the processor names itself.
std::string cpu_name();

/// The processor and the instruction sets that the options choose on it: with others a cell takes other
/// seconds and has other last digits.
std::string machine_text(const renderer::RenderOptions& options);

}  // namespace gatelight::apps
