#pragma once
// Options as keywords of Python: the flags of `gatelight render`, with underscores for dashes.

#include <pybind11/pybind11.h>

#include <set>
#include <string>

#include "apps/settings/render_settings.h"

namespace gatelight::python {

/// The text of a flag for a value of Python: numbers, words, paths, booleans, tuples, dictionaries.
std::string text_of(const std::string& option, pybind11::handle value);

/// The settings of the keywords, with the preset below them. Values of None are left out. Call
/// complete_settings() afterwards. Throws BadOption.
apps::RenderSettings read_keywords(const pybind11::dict& keywords);

/// The names of flags that decide how a file is loaded.
const std::set<std::string>& load_options();

/// Adds options(): name, help, unit and default of every option.
void add_options(pybind11::module_& module);

}  // namespace gatelight::python
