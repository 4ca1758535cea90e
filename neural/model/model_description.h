#pragma once
// The description of a model in the metadata of a cache file.

#include <nlohmann/json_fwd.hpp>

#include <string>

#include "neural/model/model.h"
#include "neural/model/training_options.h"

namespace gatelight::neural {

/// Encoding, inputs and network: together with the layout they define the meaning of the parameters.
nlohmann::ordered_json describe_network(const Model& model);
/// The options and the size of the layout. layout_digest covers its tables.
nlohmann::ordered_json describe_layout(const Model& model);
/// The options that determine the arrays of the state.
nlohmann::ordered_json describe_arrays(const TrainingOptions& options);
/// The other options, for information only.
nlohmann::ordered_json describe_training(const TrainingOptions& options);

/// A digest of all tables of the layout, 16 hexadecimal digits. Layouts with equal digests map points to the
/// same nodes.
std::string layout_digest(const Model& model);

/// Lists the entries of two objects that differ: "hidden width: file 64, model 32; outputs: file 1, model 3".
/// Empty if all are equal.
std::string list_differences(const nlohmann::ordered_json& file, const nlohmann::ordered_json& model);

}  // namespace gatelight::neural
