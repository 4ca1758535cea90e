// Writes the stub of the module: the file SOURCE, and what tables have: the members of a material, and a
// class with a member for each option.
//
// usage: stub SOURCE TARGET

#include <algorithm>
#include <fstream>
#include <set>
#include <string>
#include <variant>

#include "apps/settings/option_table.h"
#include "scene/material_fields.h"

namespace {

using namespace gatelight;

struct TypeOf {
  const char* operator()(float scene::Material::*) const { return "float"; }
  const char* operator()(bool scene::Material::*) const { return "bool"; }
  const char* operator()(Color scene::Material::*) const { return "tuple[float, float, float]"; }
  const char* operator()(std::string scene::Material::*) const { return "str"; }
  const char* operator()(scene::AlphaMode scene::Material::*) const { return "str"; }
  const char* operator()(scene::TextureSlot scene::Material::*) const { return "Texture | None"; }
};

void write_material(std::ostream& stub) {
  stub << "\nclass Material:\n    @property\n    def index(self) -> int: ...\n";
  for (const scene::MaterialField& field : scene::material_fields()) {
    if (*field.meaning != '\0')
      stub << "    " << field.name << ": " << std::visit(TypeOf(), field.member) << '\n';
  }
}

void write_options(std::ostream& stub) {
  // Parameters of render() by themselves.
  const std::set<std::string> named = {"size", "preset", "spp", "progress"};
  stub << "\nclass Options(TypedDict, total=False):\n    \"\"\"The flags of `gatelight render`.\"\"\"\n\n";
  for (std::string name : apps::option_names([](const auto&) { return true; })) {
    if (named.contains(name)) continue;
    std::replace(name.begin(), name.end(), '-', '_');
    stub << "    " << name << ": Value\n";
  }
}

}  // namespace

int main(int count, char** words) {
  if (count != 3) return 1;
  std::ofstream stub(words[2]);
  stub << std::ifstream(words[1]).rdbuf();
  write_material(stub);
  write_options(stub);
  stub.close();
  return stub ? 0 : 1;
}
