#include "apps/python/errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>
#include <regex>
#include <string>
#include <system_error>

#include "apps/terminal/errors.h"
#include "base/errors.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;

constexpr const char* kAbout =
    "A scene, an option or a file cannot be used. The text is the line that the program prints.\n\n"
    "option    name of the option as a keyword, else None\n"
    "value     its value as text, else None\n"
    "expected  what was expected, else None\n"
    "code      exit code of the program for this kind of failure";

py::handle error_class;

/// The parts of a message: "--spp: 'x' is not an integer from 1 to 5" or "...: ..., expected ...".
struct Parts {
  py::object option = py::none();
  py::object value = py::none();
  py::object expected = py::none();
};

Parts parts_of(const std::string& message) {
  static const std::regex option("^(?:--)?([a-z][a-z0-9_-]*)(?::| is missing| and --| [^ ]+: )");
  static const std::regex value("^(?:--)?[a-z][a-z0-9_-]*: '([^']*)'");
  static const std::regex expected("(?:[,;] expected | is not )(.*?)(?:; did you mean .*)?$");
  Parts parts;
  std::smatch found;
  if (std::regex_search(message, found, option)) {
    std::string name = found[1];
    std::replace(name.begin(), name.end(), '-', '_');
    parts.option = py::str(name);
    if (std::regex_search(message, found, value)) parts.value = py::str(found[1].str());
  }
  if (std::regex_search(message, found, expected)) parts.expected = py::str(found[1].str());
  return parts;
}

/// Sets Python's error from the exception that is being handled.
void raise_current(bool names_option) {
  const apps::Failure failure = apps::describe_current_exception();
  const std::string message = apps::one_line(failure.message);
  const char* const link = failure.advice.empty() ? "" : message.ends_with('?') ? " " : "; ";
  const bool help = failure.advice == "see --help";
  const py::object error = py::reinterpret_borrow<py::object>(error_class)(
      py::str(fmt::format("{}{}{}", message, link, help ? "see help(gatelight.render)" : failure.advice)));
  Parts parts;
  if (names_option) parts = parts_of(message);
  error.attr("option") = parts.option;
  error.attr("value") = parts.value;
  error.attr("expected") = parts.expected;
  error.attr("code") = failure.code;
  PyErr_SetObject(error_class.ptr(), error.ptr());
}

}  // namespace

void add_error(py::module_& module) {
  error_class = PyErr_NewExceptionWithDoc("gatelight.Error", kAbout, nullptr, nullptr);
  for (const char* name : {"option", "value", "expected"}) error_class.attr(name) = py::none();
  error_class.attr("code") = static_cast<int>(apps::kUsage);
  module.attr("Error") = error_class;
  py::register_exception_translator([](std::exception_ptr pointer) {
    if (!pointer) return;
    try {
      std::rethrow_exception(pointer);
    } catch (const Error& error) {
      raise_current(error.kind() == ErrorKind::option || error.kind() == ErrorKind::unavailable ||
                    error.kind() == ErrorKind::model);
    } catch (const std::bad_alloc&) {
      raise_current(false);
    } catch (const std::system_error&) {
      raise_current(false);
    }
  });
}

}  // namespace gatelight::python
