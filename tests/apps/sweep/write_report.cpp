// gatelight-write-report FOLDER: FOLDER/results.json as FOLDER/report.html.

#include <cstdio>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/sweep/report.h"
#include "apps/terminal/terminal.h"

int main(int argc, char** argv) {
  if (argc != 2) return 1;
  const std::string folder = argv[1];
  try {
    std::ifstream file(folder + "/results.json");
    const auto results = nlohmann::ordered_json::parse(file);
    gatelight::apps::write_text(folder + "/report.html", gatelight::apps::make_report(results, folder));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
