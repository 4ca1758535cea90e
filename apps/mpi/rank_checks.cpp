#include "apps/mpi/rank_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "apps/mpi/failures.h"
#include "apps/reports/recipe.h"
#include "apps/settings/option_table.h"
#include "apps/terminal/log.h"
#include "apps/terminal/text.h"
#include "apps/terminal/version.h"
#include "base/errors.h"
#include "base/platform/memory.h"
#include "base/platform/threads.h"
#include "base/simd/isa.h"
#include "renderer/film/memory_estimate.h"
#include "renderer/fingerprint/scene_fingerprint.h"
#include "renderer/surface/embree.h"

namespace gatelight::apps {
namespace {

/// Version, options and digests of the inputs, a name and value each.
std::vector<std::string> identity(const RenderSettings& settings, const scene::Scene& scene) {
  std::vector<std::string> lines = {fmt::format("version: {}", version())};
  RenderSettings reproducible = settings;
  reproducible.reproducible = false;
  const nlohmann::ordered_json options = resolved_options(reproducible);
  const std::set<std::string> of_machine =
      option_names([](const Option& option) { return option.marks.in_recipe == InRecipe::of_machine; });
  for (const auto& [name, value] : options.items()) {
    if (!of_machine.contains(name)) lines.push_back(fmt::format("--{}: {}", name, json_text(value, -1)));
  }
  for (const auto& [name, digest] : renderer::compute_scene_fingerprint(scene, settings.render.environment))
    lines.push_back(fmt::format("{} of '{}': {}", name, settings.scene, digest));
  if (const std::string& file = settings.render.cache.cache_in; !file.empty())
    lines.push_back(fmt::format("'{}': {}", file, renderer::file_digest(file)));
  return lines;
}

}  // namespace

void share_machines(RenderSettings& settings, MpiCollectives& all) {
  renderer::RenderOptions& options = settings.render;
  if (!settings.given.contains("threads")) {
    const int processors = std::max(static_cast<int>(std::thread::hardware_concurrency()), 1);
    const std::vector<std::string>& hosts = all.group().hosts;
    const auto here = std::count(hosts.begin(), hosts.end(), hosts[static_cast<std::size_t>(all.rank())]);
    const int fair = std::max(processors / static_cast<int>(here), 1);
    options.threads = std::min(available_threads(), fair);
  }
  // Instruction sets of the rays and of the kernels. Equal machines choose as a single process does. Ranks
  // with --isa take part too, because the options are compared later.
  const std::array<simd::Isa, 2> best = {*simd::parse_isa(renderer::best_isa()), simd::select_isa()};
  simd::Isa least = std::min(best[0], best[1]);
  bool equal = true;
  for (const std::array<simd::Isa, 2>& other : all.of_each(best)) {
    least = std::min({least, other[0], other[1]});
    equal &= other == best;
  }
  // Each rank compares with its own sets; any() gives all ranks the same result.
  if (all.any(!equal) && options.isa == "auto") options.isa = std::string(simd::isa_name(least));
}

void expect_equal_ranks(const RenderSettings& settings, const scene::Scene& scene, MpiCollectives& all) {
  std::vector<std::vector<std::string>> texts;
  for (const renderer::Bytes& bytes : all.gather(bytes_of(identity(settings, scene))))
    texts.push_back(object_of(bytes).get<std::vector<std::string>>());
  const std::vector<std::string>& expected = texts.front();
  for (int rank = 1; rank < all.count(); ++rank) {
    const std::vector<std::string>& lines = texts[static_cast<std::size_t>(rank)];
    const auto [there, here] = std::mismatch(lines.begin(), lines.end(), expected.begin(), expected.end());
    if (there == lines.end() && here == expected.end()) continue;
    throw InputError(fmt::format("{} has {}, expected {} as {} has", all.group().name_of(rank),
                                 there == lines.end() ? "nothing" : *there,
                                 here == expected.end() ? "nothing" : *here, all.group().name_of(0)));
  }
}

void require_memory_of_ranks(const RenderSettings& settings, const scene::Scene& scene, MpiCollectives& all) {
  const renderer::MemoryEstimate need = renderer::estimate_memory(scene, settings.render);
  struct Machine {
    std::uint64_t more, left;
  };
  // The scene is loaded already.
  const std::vector<Machine> each = all.of_each(Machine{need.total() - need.geometry, memory_room().bytes});
  std::map<std::string, Machine> machines;
  for (std::size_t rank = 0; rank < each.size(); ++rank) {
    Machine& machine =
        machines.try_emplace(all.group().hosts[rank], Machine{0, each[rank].left}).first->second;
    machine.more += each[rank].more;
    machine.left = std::min(machine.left, each[rank].left);
  }
  for (const auto& [host, machine] : machines) {
    if (machine.more <= machine.left) continue;
    throw OutOfMemory(fmt::format("{}: rendering needs {} more for all ranks on {}, which has {} left",
                                  settings.scene, format_bytes(static_cast<std::size_t>(machine.more)), host,
                                  format_bytes(static_cast<std::size_t>(machine.left))));
  }
  log_detail(fmt::format("memory needed by each rank, estimated: {}", format_bytes(need.total())));
}

}  // namespace gatelight::apps
