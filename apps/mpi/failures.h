#pragma once
// Failures as messages between ranks.

#include <nlohmann/json.hpp>

#include "apps/terminal/errors.h"
#include "renderer/distributed/packing.h"

namespace gatelight::apps {

renderer::Bytes bytes_of(const nlohmann::json& object);
nlohmann::json object_of(const renderer::Bytes& bytes);

nlohmann::json json_of(const Failure& failure);
Failure failure_of(const nlohmann::json& object);

/// Prints it at this rank, which may be silent otherwise.
void print_for_all(const Failure& failure);

}  // namespace gatelight::apps
