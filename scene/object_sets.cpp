#include "scene/object_sets.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "base/errors.h"

namespace gatelight::scene {
namespace {

void require_at_most(const Scene& scene, std::size_t count, int most, const char* what) {
  if (count > static_cast<std::size_t>(most))
    throw InputError(fmt::format("{}: the lights have {} different sets of {}, expected at most {}",
                                 scene.path, count, what, most));
}

template <typename Use>
void for_each_link(Scene& scene, const Use& use) {
  for (PunctualLight& light : scene.lights) use(light.link);
  for (Instance& instance : scene.instances) use(instance.link);
  use(scene.environment_link);
}

}  // namespace

int number_of_set(Scene& scene, ObjectSet&& set) {
  const auto is_member = [](std::uint8_t member) { return member != 0; };
  if (set.fog && std::all_of(set.instances.begin(), set.instances.end(), is_member)) return -1;
  std::vector<ObjectSet>& sets = scene.object_sets;
  const auto found = std::find(sets.begin(), sets.end(), set);
  if (found != sets.end()) return static_cast<int>(found - sets.begin());
  // A file can ask for many large sets in a few characters.
  require_at_most(scene, sets.size() + 1, 2 * (kMaxReceiverSets + kMaxBlockerSets), "objects");
  sets.push_back(std::move(set));
  return static_cast<int>(sets.size()) - 1;
}

void tidy_object_sets(Scene& scene) {
  if (scene.object_sets.empty()) return;
  std::vector<ObjectSet> sets;
  std::vector<int> numbers(scene.object_sets.size(), -1);
  std::set<int> receivers, blockers;
  const auto renumber = [&](int& number, std::set<int>& used) {
    if (number < 0) return;
    const auto old = static_cast<std::size_t>(number);
    if (numbers[old] < 0) {
      numbers[old] = static_cast<int>(sets.size());
      sets.push_back(std::move(scene.object_sets[old]));
    }
    number = numbers[old];
    used.insert(number);
  };
  for_each_link(scene, [&](LightLink& link) {
    renumber(link.receivers, receivers);
    renumber(link.blockers, blockers);
  });
  scene.object_sets = std::move(sets);
  require_at_most(scene, receivers.size(), kMaxReceiverSets, "receivers");
  require_at_most(scene, blockers.size(), kMaxBlockerSets, "blockers");
}

}  // namespace gatelight::scene
