#include "apps/reports/json.h"

#include <fstream>

namespace gatelight::apps {
namespace {

constexpr int kMaxDepth = 32;

}  // namespace

nlohmann::ordered_json read_json_file(const std::filesystem::path& path) {
  using Json = nlohmann::ordered_json;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return Json(Json::value_t::discarded);
  std::ifstream file(path, std::ios::binary);
  bool deep = false;
  const auto watch_depth = [&](int depth, Json::parse_event_t, Json&) {
    deep |= depth > kMaxDepth;
    return depth <= kMaxDepth;
  };
  Json json = Json::parse(file, watch_depth, false);
  return deep ? Json(Json::value_t::discarded) : json;
}

}  // namespace gatelight::apps
