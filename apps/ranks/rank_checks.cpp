#include "apps/ranks/rank_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "apps/reports/recipe.h"
#include "apps/settings/option_table.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/text.h"
#include "apps/terminal/version.h"
#include "base/platform/memory.h"
#include "base/platform/threads.h"
#include "base/simd/isa.h"
#include "renderer/film/memory_estimate.h"
#include "renderer/fingerprint/scene_fingerprint.h"
#include "renderer/surface/embree.h"

namespace gatelight::apps {
namespace {

using renderer::Bytes;

/// Version, options and digests of the inputs, one name and value per line.
std::string identity(const RenderSettings& settings, const scene::Scene& scene) {
  std::string text = fmt::format("version: {}\n", version());
  RenderSettings reproducible = settings;
  reproducible.reproducible = false;
  const nlohmann::ordered_json options = resolved_options(reproducible);
  const std::set<std::string> of_machine =
      option_names([](const Option& option) { return option.marks.in_recipe == InRecipe::of_machine; });
  for (const auto& [name, value] : options.items()) {
    if (!of_machine.contains(name)) text += fmt::format("--{}: {}\n", name, json_text(value, -1));
  }
  for (const auto& [name, digest] : renderer::compute_scene_fingerprint(scene, settings.render.environment))
    text += fmt::format("{} of '{}': {}\n", name, settings.scene, digest);
  if (const std::string& file = settings.render.cache.cache_in; !file.empty())
    text += fmt::format("'{}': {}\n", file, renderer::file_digest(file));
  return text;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1)
    lines.push_back(text.substr(at, end - at));
  return lines;
}

int rank_of_isa(const std::string& name) {
  return static_cast<int>(*simd::parse_isa(name));
}

}  // namespace

void share_machines(RenderSettings& settings, const RankGroup& group) {
  if (group.is_alone()) return;
  renderer::RenderOptions& options = settings.render;
  if (!settings.given.contains("threads")) {
    const int processors = std::max(static_cast<int>(std::thread::hardware_concurrency()), 1);
    const int fair = std::max(processors / group.local_count, 1);
    options.threads = std::min(available_threads(), fair);
  }
  // Instruction sets of the rays and of the kernels. Equal machines choose as a single process does. Ranks
  // with --isa take part too, because the options are compared later.
  const std::array<int, 2> best = {rank_of_isa(renderer::best_isa()), static_cast<int>(simd::select_isa())};
  int least = std::min(best[0], best[1]);
  bool equal = true;
  for (const std::array<int, 2>& other : group.ranks.of_each(best)) {
    least = std::min({least, other[0], other[1]});
    equal &= other == best;
  }
  // Each rank compares with its own sets; any() gives all ranks the same result.
  if (group.ranks.any(!equal) && options.isa == "auto")
    options.isa = std::string(simd::isa_name(static_cast<simd::Isa>(least)));
}

void expect_equal_ranks(const RenderSettings& settings, const scene::Scene& scene, const RankGroup& group) {
  if (group.is_alone()) return;
  std::vector<std::vector<std::string>> texts;
  for (const Bytes& bytes : group.ranks.gather(renderer::packed(identity(settings, scene)))) {
    const std::vector<char> text = renderer::Unpacker(bytes).rest<char>();
    texts.push_back(lines_of({text.begin(), text.end()}));
  }
  const std::vector<std::string>& expected = texts.front();
  for (int rank = 1; rank < group.ranks.count(); ++rank) {
    const std::vector<std::string>& lines = texts[static_cast<std::size_t>(rank)];
    const auto [there, here] = std::mismatch(lines.begin(), lines.end(), expected.begin(), expected.end());
    if (there == lines.end() && here == expected.end()) continue;
    throw InputError(fmt::format("{} has {}, expected {} as {} has", group.name_of(rank),
                                 there == lines.end() ? "nothing" : *there,
                                 here == expected.end() ? "nothing" : *here, group.name_of(0)));
  }
}

std::size_t require_memory_of_ranks(const RenderSettings& settings, const scene::Scene& scene,
                                    const RankGroup& group) {
  const renderer::MemoryEstimate need = renderer::estimate_memory(scene, settings.render);
  if (group.is_alone()) return need.total();
  struct Machine {
    std::uint64_t more, left;
  };
  // The scene is loaded already.
  const std::vector<Machine> all =
      group.ranks.of_each(Machine{need.total() - need.geometry, memory_room().bytes});
  std::map<std::string, Machine> machines;
  for (std::size_t rank = 0; rank < all.size(); ++rank) {
    Machine& machine = machines.try_emplace(group.hosts[rank], Machine{0, all[rank].left}).first->second;
    machine.more += all[rank].more;
    machine.left = std::min(machine.left, all[rank].left);
  }
  for (const auto& [host, machine] : machines) {
    if (machine.more <= machine.left) continue;
    throw OutOfMemory(fmt::format("{}: rendering needs {} more for all ranks on {}, which has {} left",
                                  settings.scene, format_bytes(static_cast<std::size_t>(machine.more)), host,
                                  format_bytes(static_cast<std::size_t>(machine.left))));
  }
  return need.total();
}

}  // namespace gatelight::apps
