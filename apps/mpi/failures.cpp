#include "apps/mpi/failures.h"

#include <cstdint>

#include "apps/terminal/terminal.h"

namespace gatelight::apps {

using nlohmann::json;

renderer::Bytes bytes_of(const json& object) {
  // CBOR, because a message may hold names that are no UTF-8.
  return renderer::packed(json::to_cbor(object));
}

json object_of(const renderer::Bytes& bytes) {
  return json::from_cbor(renderer::Unpacker(bytes).rest<std::uint8_t>());
}

json json_of(const Failure& failure) {
  return {{"code", failure.code}, {"message", failure.message}, {"advice", failure.advice}};
}

Failure failure_of(const json& object) {
  return {object["code"], object["message"], object["advice"]};
}

void print_for_all(const Failure& failure) {
  set_silent(false);
  print_failure_line(failure);
}

}  // namespace gatelight::apps
