#include "apps/ranks/frame_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "base/errors.h"

namespace gatelight::apps {
namespace {

using nlohmann::json;
using renderer::Bytes;

Bytes bytes_of(const json& object) {
  // A message may hold names that are no UTF-8.
  const std::string text = object.dump(-1, ' ', false, json::error_handler_t::replace);
  return renderer::packed(text);
}

json object_of(const Bytes& bytes) {
  const std::vector<char> text = renderer::Unpacker(bytes).rest<char>();
  return json::parse(text);
}

json json_of(const std::optional<Failure>& failure) {
  if (!failure) return nullptr;
  return {{"code", failure->code}, {"message", failure->message}, {"advice", failure->advice}};
}

std::optional<Failure> failure_of(const json& object) {
  if (object.is_null()) return {};
  return Failure{object["code"], object["message"], object["advice"]};
}

}  // namespace

int number_of_group(int groups, const renderer::Ranks& all) {
  return static_cast<int>(std::int64_t{all.rank()} * groups / all.count());
}

RankGroup own_group(int groups, const RankGroup& all) {
  const std::vector<int> wanted = all.ranks.of_each(groups);
  for (std::size_t rank = 1; rank < wanted.size(); ++rank) {
    if (wanted[rank] != wanted[0])
      throw InputError(fmt::format("{} has --frame-groups {}, expected {} as {} has",
                                   all.name_of(static_cast<int>(rank)), wanted[rank], wanted[0],
                                   all.name_of(0)));
  }
  if (groups == 1) return all;
  if (all.is_alone())
    throw BadOption({"frame-groups", "", "a single process has only one group",
                     "several ranks of gatelight-mpi, started with mpirun or srun"});
  if (groups > all.ranks.count())
    throw BadOption({"frame-groups", "",
                     fmt::format("{} ranks cannot form {} groups", all.ranks.count(), groups),
                     fmt::format("at most {}", all.ranks.count())});
  const int number = number_of_group(groups, all.ranks);
  RankGroup own{all.split(number), all.local_count, {}, all.split, all.stop_others};
  for (std::size_t rank = 0; rank < all.hosts.size(); ++rank) {
    if (static_cast<int>(rank * static_cast<std::size_t>(groups) / all.hosts.size()) == number)
      own.hosts.push_back(all.hosts[rank]);
  }
  return own;
}

std::vector<int> frames_of_group(const std::vector<int>& all, int groups, int number) {
  std::vector<int> frames;
  for (auto i = static_cast<std::size_t>(number); i < all.size(); i += static_cast<std::size_t>(groups))
    frames.push_back(all[i]);
  return frames;
}

FrameResults joined_results(renderer::Ranks& all, const FrameResults& mine) {
  FrameResults sum;
  const json own = {{"signal", mine.signal},
                    {"done", mine.done},
                    {"warnings", mine.warnings},
                    {"failure", json_of(mine.failure)}};
  for (const Bytes& bytes : all.gather(bytes_of(own))) {
    const json one = object_of(bytes);
    sum.signal = std::max(sum.signal, one["signal"].get<int>());
    sum.done += one["done"].get<std::size_t>();
    for (const std::string warning : one["warnings"]) sum.warnings.push_back(warning);
    if (!sum.failure) sum.failure = failure_of(one["failure"]);
  }
  return sum;
}

}  // namespace gatelight::apps
