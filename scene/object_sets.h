#pragma once
// The sets of objects that the links of lights refer to.

#include "scene/scene.h"

namespace gatelight::scene {

/// The number of the set in Scene::object_sets, where it is added unless an equal one is there; -1 for the
/// set of all. Throws InputError if there are more than any scene may have.
int number_of_set(Scene& scene, ObjectSet&& set);

/// Drops the sets that no light has, and numbers the others in the order of their use. Throws InputError if
/// lights have more than kMaxReceiverSets or kMaxBlockerSets.
void tidy_object_sets(Scene& scene);

}  // namespace gatelight::scene
