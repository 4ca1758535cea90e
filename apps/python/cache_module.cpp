#include "apps/python/module.h"

namespace gatelight::python {
void add_cache(pybind11::module_&) {}
}  // namespace gatelight::python
