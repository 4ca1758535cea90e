#pragma once
// Options as keywords of Python: the flags of `gatelight render`, with underscores for dashes.

#include <pybind11/pybind11.h>

#include <functional>
#include <string>

#include "apps/settings/option_table.h"

namespace gatelight::python {

/// The text of a flag for a value of Python: numbers, words, paths, booleans, tuples, dictionaries.
std::string text_of(const std::string& option, pybind11::handle value);

/// The settings of the keywords over those given, with the preset below them. Values of None are left out.
/// Call complete_settings() afterwards. Throws BadOption.
apps::RenderSettings read_keywords(const pybind11::dict& keywords, apps::RenderSettings settings = {});

/// Throws BadOption for an option that was given and that `fits` does not accept. Without `expected` it names
/// those that fit.
void require_given(const apps::RenderSettings& settings, const std::function<bool(const apps::Option&)>& fits,
                   const char* problem, std::string expected = "");

/// A view by hand replaces one by name, and so on: takes away the keywords that `newer` excludes, and adds
/// it.
void replace_keywords(pybind11::dict& keywords, const pybind11::dict& newer);

/// Adds options(): name, help, unit and default of every option.
void add_options(pybind11::module_& module);

}  // namespace gatelight::python
