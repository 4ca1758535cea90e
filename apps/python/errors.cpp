#include "apps/python/module.h"

#include <algorithm>
#include <exception>
#include <new>
#include <string>
#include <system_error>

#include "apps/terminal/errors.h"
#include "base/errors.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;

constexpr const char* kAbout =
    "A scene, an option or a file cannot be used. The text is the line that the program prints, with\n"
    "keywords for flags.\n\n"
    "option    name of the option as a keyword, else None\n"
    "value     its value as text, else None\n"
    "expected  what was expected, else None\n"
    "code      exit code of the program for this kind of failure";

py::handle error_class;

/// Sets Python's error from the exception that is being handled, whose parts these are.
void raise_current(ErrorParts parts) {
  apps::Failure failure = apps::describe_current_exception();
  std::replace(parts.option.begin(), parts.option.end(), '-', '_');
  const std::string message = one_line(parts.option.empty() ? failure.message : sentence(parts));
  const char* const link = failure.advice.empty() ? "" : message.ends_with('?') ? " " : "; ";
  if (failure.advice == "see --help") failure.advice = "see help(gatelight.render)";
  const py::object error = py::reinterpret_borrow<py::object>(error_class)(message + link + failure.advice);
  const auto set = [&](const char* name, const std::string& text, bool has) {
    error.attr(name) = has && !parts.option.empty() ? py::object(py::str(text)) : py::object(py::none());
  };
  set("option", parts.option, true);
  set("value", parts.value, !parts.value.empty() || parts.problem.empty());
  set("expected", parts.expected, !parts.expected.empty());
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
      raise_current(error.parts());
    } catch (const std::bad_alloc&) {
      raise_current({});
    } catch (const std::system_error&) {
      raise_current({});
    }
  });
}

}  // namespace gatelight::python
