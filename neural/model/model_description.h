#pragma once
// What a cache file says of the model that it belongs to.

#include <nlohmann/json_fwd.hpp>

#include <string>

#include "neural/model/model.h"
#include "neural/model/training_options.h"

namespace gatelight::neural {

/// "adaptive", "adaptive/4" or "1": a level of GateOptions::stack.
std::string level_text(std::uint32_t level);

/// Everything but the layout that decides what parameters mean: encoding, inputs, network.
nlohmann::ordered_json describe_network(const Model& model);
/// The options and the size of the layout; its tables are in layout_digest.
nlohmann::ordered_json describe_layout(const Model& model);
/// The options that decide which arrays the state holds.
nlohmann::ordered_json describe_arrays(const TrainingOptions& options);
/// The other options, for the record.
nlohmann::ordered_json describe_training(const TrainingOptions& options);

/// 16 hexadecimal digits over every table of the layout: equal where equal points read equal nodes.
std::string layout_digest(const Model& model);

/// "hidden width: file 64, model 32; outputs: file 1, model 3": the entries of two objects that are not
/// equal. Empty where all are.
std::string list_differences(const nlohmann::ordered_json& file, const nlohmann::ordered_json& model);

}  // namespace gatelight::neural
