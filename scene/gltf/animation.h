#pragma once
// The animations of a document: the values of its model at a time.

#include <string>
#include <vector>

#include "scene/gltf/curve.h"
#include "scene/gltf/document.h"
#include "scene/gltf/property.h"

namespace gatelight::scene::gltf {

class Animator {
 public:
  /// Reads the keys of the document's channels. The document must outlive it. Throws InputError for broken
  /// ones; those without effect give a warning.
  Animator(Document& document, Warnings& warnings);

  struct Track {
    std::string pointer;
    Curve curve;
    Property property;
  };

  /// Changes the model to its state at a time, in seconds; `before`: just before it (curve.h). Each call sets
  /// the same values, so the model does not depend on the times of earlier calls.
  void apply(double seconds, Warnings& warnings, bool before = false) const;

  const std::vector<Track>& tracks() const { return tracks_; }

 private:
  std::vector<Track> tracks_;
};

}  // namespace gatelight::scene::gltf
