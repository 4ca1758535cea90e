#include "apps/python/module.h"

#include "apps/python/keywords.h"
#include "apps/terminal/version.h"

PYBIND11_MODULE(_gatelight, module) {
  using namespace gatelight;
  module.doc() = "The C++ part of gatelight.";
  module.attr("__version__") = apps::version();
  python::add_error(module);
  python::add_options(module);
  python::add_materials(module);
  python::add_scene(module);
  python::add_picture(module);
  python::add_renderer(module);
  python::add_frames(module);
  python::add_metrics(module);
  python::add_cache(module);
}
