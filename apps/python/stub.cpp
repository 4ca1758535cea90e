// Writes the stub of the module: the file SOURCE, and a class with a member for each option.
//
// usage: stub SOURCE TARGET

#include <algorithm>
#include <fstream>
#include <set>
#include <string>

#include "apps/settings/option_table.h"

int main(int count, char** words) {
  if (count != 3) return 1;
  // Parameters of render() by themselves.
  const std::set<std::string> named = {"size", "preset", "spp", "progress"};
  std::ofstream stub(words[2]);
  stub << std::ifstream(words[1]).rdbuf()
       << "\nclass Options(TypedDict, total=False):\n    \"\"\"The flags of `gatelight render`.\"\"\"\n\n";
  for (std::string name : gatelight::apps::option_names([](const auto&) { return true; })) {
    if (named.contains(name)) continue;
    std::replace(name.begin(), name.end(), '-', '_');
    stub << "    " << name << ": Value\n";
  }
  stub.close();
  return stub ? 0 : 1;
}
