#include "apps/mpi/mpi_team.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "apps/mpi/failures.h"
#include "apps/mpi/rank_checks.h"
#include "apps/terminal/text.h"
#include "base/errors.h"

namespace gatelight::apps {
namespace {

using nlohmann::json;
using renderer::ProcessStatistics;

/// Neighbours make a group, and groups differ by one rank at most.
int number_of_group(int groups, const renderer::Ranks& all) {
  return static_cast<int>(std::int64_t{all.rank()} * groups / all.count());
}

/// Throws InputError where the ranks want different numbers of groups, BadOption for more groups than ranks.
void check_groups(int groups, MpiCollectives& all) {
  const std::vector<int> wanted = all.of_each(groups);
  for (std::size_t rank = 1; rank < wanted.size(); ++rank) {
    if (wanted[rank] != wanted[0])
      throw InputError(fmt::format("{} has --frame-groups {}, expected {} as {} has",
                                   all.group().name_of(static_cast<int>(rank)), wanted[rank], wanted[0],
                                   all.group().name_of(0)));
  }
  if (groups > all.count())
    throw BadOption({"frame-groups", "", fmt::format("{} ranks cannot form {} groups", all.count(), groups),
                     fmt::format("at most {}", all.count())});
}

json json_of(const std::exception_ptr& failure) {
  if (!failure) return nullptr;
  try {
    std::rethrow_exception(failure);
  } catch (...) {
    return json_of(describe_current_exception());
  }
}

/// "ranks     5 with 10 threads on 2 machines; waiting 3.1 %, sent 12 MiB\n"
std::string summary_of(const std::vector<ProcessStatistics>& ranks, const std::vector<std::string>& hosts) {
  ProcessStatistics sum;
  for (const ProcessStatistics& rank : ranks) {
    sum.threads += rank.threads;
    sum.seconds += rank.seconds;
    sum.waiting_seconds += rank.waiting_seconds;
    sum.bytes_sent += rank.bytes_sent;
  }
  const std::size_t machines = std::set<std::string>(hosts.begin(), hosts.end()).size();
  return fmt::format("ranks     {} with {} threads on {} machine{}; waiting {}, sent {}\n", ranks.size(),
                     sum.threads, machines, machines == 1 ? "" : "s",
                     format_percent(sum.waiting_seconds / std::max(sum.seconds, 1e-9)),
                     format_bytes(sum.bytes_sent));
}

}  // namespace

void MpiTeam::join(RenderSettings& settings) {
  groups_ = settings.frames.groups;
  check_groups(groups_, mpi_.all());
  if (groups_ > 1) own_ = &mpi_.split(number_of_group(groups_, mpi_.all()));
  share_machines(settings, mpi_.all());
  settings.render.ranks = own_;
}

void MpiTeam::check(const RenderSettings& settings, const scene::Scene& scene) const {
  expect_equal_ranks(settings, scene, mpi_.all());
  require_memory_of_ranks(settings, scene, mpi_.all());
}

int MpiTeam::signal() const {
  const std::vector<int> signals = own_->of_each(stop_signal());
  return *std::max_element(signals.begin(), signals.end());
}

void MpiTeam::describe(RunReport& report) const {
  const std::vector<ProcessStatistics>& ranks = report.statistics.team;
  if (ranks.empty()) return;
  const std::vector<std::string>& hosts = own_->group().hosts;
  report.team_summary = summary_of(ranks, hosts);
  nlohmann::ordered_json& all = report.team_json["ranks"] = nlohmann::ordered_json::array();
  for (std::size_t r = 0; r < ranks.size(); ++r) {
    all.push_back({{"host", hosts[r]},
                   {"threads", ranks[r].threads},
                   {"samples", ranks[r].samples},
                   {"training_paths", ranks[r].training_paths},
                   {"record_bytes", ranks[r].record_bytes},
                   {"seconds", ranks[r].seconds},
                   {"bytes_sent", ranks[r].bytes_sent},
                   {"waiting_seconds", ranks[r].waiting_seconds}});
  }
}

std::vector<int> MpiTeam::own_frames(std::vector<int> all) const {
  std::vector<int> frames;
  const auto first = static_cast<std::size_t>(number_of_group(groups_, mpi_.all()));
  for (std::size_t i = first; i < all.size(); i += static_cast<std::size_t>(groups_))
    frames.push_back(all[i]);
  return frames;
}

FrameResults MpiTeam::joined(const FrameResults& own) const {
  if (groups_ == 1) return RunTeam::joined(own);
  if (own.signal != 0) mpi_.stop_others(own.signal);
  // The ranks of a group have the same results, and the first of all has printed its warnings.
  const json mine = {{"signal", own.signal},
                     {"done", writes() ? own.done : 0},
                     {"warnings", writes() && !mpi_.all().first() ? own.warnings : std::set<std::string>()},
                     {"failure", json_of(own.failure)}};
  FrameResults sum;
  for (const renderer::Bytes& bytes : mpi_.all().gather(bytes_of(mine))) {
    const json one = object_of(bytes);
    sum.signal = std::max(sum.signal, one["signal"].get<int>());
    sum.done += one["done"].get<std::size_t>();
    sum.warnings.merge(one["warnings"].get<std::set<std::string>>());
    if (!sum.failure && !one["failure"].is_null())
      sum.failure = std::make_exception_ptr(failure_of(one["failure"]));
  }
  return sum;
}

}  // namespace gatelight::apps
