// Files that a sweep reads back from its folder: results, the record of a cell, the numbers of a reference.

#include <filesystem>
#include <string>

#include "apps/sweep/advise.h"
#include "apps/sweep/cell_record.h"
#include "apps/sweep/references.h"
#include "apps/sweep/report.h"
#include "apps/sweep/request.h"
#include "apps/sweep/results.h"
#include "apps/terminal/errors.h"
#include "tests/fuzz/input_file.h"

namespace gatelight::fuzz {
namespace {

const apps::SweepPlan& plan() {
  static const apps::SweepPlan made = [] {
    apps::SweepArguments words;
    words.scenes = {"a.glb"};
    words.train_steps = "4";
    words.no_plain = true;
    return apps::make_plan(apps::make_request(words));
  }();
  return made;
}

void read_record(Bytes bytes) {
  static const InputFile file("cells/4e0.json");
  std::filesystem::create_directories(file.path().parent_path());
  file.write(bytes);
  const std::string folder = file.path().parent_path().parent_path().string();
  const apps::PlannedScene& scene = plan().scenes[0];
  const apps::CellPlace place{scene, scene.series[0], 1, 4, "4e0", "5f1"};
  const auto record = apps::read_done_record(folder, place, false);
  if (!record) return;
  const nlohmann::ordered_json scene_json = {
      {"name", "a"}, {"file", "a.glb"}, {"references", nlohmann::ordered_json::array()}};
  const nlohmann::ordered_json results = apps::make_results({"gatelight"}, {{scene_json, {*record}}});
  apps::results_csv(results);
  apps::give_advice(results, {.max_error = 0.5, .max_seconds = {}});
  apps::make_report(results, folder);
}

void read_results(Bytes bytes) {
  static const InputFile file("results.json");
  file.write(bytes);
  try {
    apps::give_advice(apps::read_results(file.path().parent_path().string()),
                      {.max_error = 0.5, .max_seconds = 9.0});
  } catch (const InputError& error) {
    check_line(one_line(error.what()));
  } catch (const nlohmann::ordered_json::exception& error) {
    check_line(one_line(error.what()));  // the caller reports it as InputError
  }
}

}  // namespace

void sweep_records(Bytes bytes) {
  read_results(bytes);
  read_record(bytes);
  static const InputFile numbers("reference.json");
  numbers.write(bytes);
  apps::Reference reference;
  reference.file = (numbers.path().parent_path() / "reference.exr").string();
  apps::read_reference_numbers(reference);
}

}  // namespace gatelight::fuzz
