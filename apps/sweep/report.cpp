#include "apps/sweep/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/sweep/cell_record.h"
#include "apps/sweep/measured_runs.h"
#include "apps/sweep/picture_uri.h"
#include "apps/sweep/report_chart.h"
#include "apps/sweep/results.h"
#include "apps/sweep/results_table.h"
#include "apps/terminal/text.h"
#include "renderer/image/image_read.h"
#include "renderer/settings/enum_names.h"
// kReportStyle and kReportScript (cmake/EmbedTexts.cmake).
#include "gatelight_report.inc"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

/// Numbers that are no integers have so many digits.
std::string text_of(const ordered_json& value, int digits = 4) {
  if (value.is_null()) return "–";
  if (value.is_number_float()) return fmt::format("{:.{}g}", value.get<double>(), digits);
  return value.is_string() ? value.get<std::string>() : json_text(value, -1);
}

/// "cpu Z80, threads 1"
std::string list_of(const ordered_json& object) {
  std::vector<std::string> texts;
  for (const auto& [key, value] : object.items()) texts.push_back(key + " " + text_of(value));
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// An element with a text.
std::string element(const std::string& tag, const std::string& text) {
  return fmt::format("<{}>{}</{}>\n", tag, escaped(text), tag.substr(0, tag.find(' ')));
}

/// Cells that differ only in their seeds.
struct Run {
  std::string name;
  std::string series;
  LineStyle style;
  std::map<std::uint32_t, const ordered_json*> cells;  ///< by seed; null: not measured
  MeasuredRun done;                                    ///< without those that failed
};

/// The runs of a scene with the same reference: only their errors can be compared.
struct Section {
  std::string scene;
  ordered_json reference;
  std::vector<Run> runs;
};

std::vector<Section> sections_of(const ordered_json& results) {
  std::map<std::uint32_t, const ordered_json*> none;
  std::map<std::string, LineStyle> styles;  // a series looks the same in all sections
  std::size_t counts[] = {0, 0};
  for (const ordered_json& cell : results.at("cells")) {
    none[cell.at("seed")] = nullptr;
    const bool plain = cell.at("encoding").is_null();
    if (styles.emplace(cell.at("series"), LineStyle{counts[plain], plain}).second) ++counts[plain];
  }
  std::vector<Section> sections;
  for (const ordered_json& scene : results.at("scenes")) {
    ordered_json references = scene.at("references");
    references.push_back({{"id", ""}});  // of a scene that could not be read
    for (const ordered_json& reference : references) {
      Section section{scene.at("name"), reference, {}};
      for (const ordered_json& cell : results["cells"]) {
        if (cell.at("scene") != section.scene || cell.at("reference_id") != reference.at("id")) continue;
        auto run = std::find_if(section.runs.begin(), section.runs.end(),
                                [&](const Run& other) { return cell.at("run") == other.name; });
        if (run == section.runs.end())
          run =
              section.runs.insert(run, {cell.at("run"), cell["series"], styles.at(cell["series"]), none, {}});
        run->cells[cell["seed"]] = &cell;
        if (is_done(cell)) run->done.cells.push_back(&cell);
      }
      if (!section.runs.empty()) sections.push_back(std::move(section));
    }
  }
  return sections;
}

/// The picture of a file, or words where it is missing or cannot be read.
std::string picture_html(const std::filesystem::path& folder, const ordered_json& file,
                         const std::string& name, const renderer::DisplayOptions& display = {}) {
  try {
    // operator/ keeps an absolute path.
    if (file.is_string())
      return fmt::format(R"(<img alt="{}" src="{}">)", escaped(name),
                         picture_uri(renderer::read_image(folder / file.get<std::string>()), display));
  } catch (const InputError&) {
  }
  return element("p class=\"none\"", name + ": no picture");
}

/// The reference as the pictures of the first seed are shown.
std::string reference_html(const Section& section, const std::filesystem::path& folder) {
  std::set<std::pair<float, std::string>> displays;
  for (const Run& run : section.runs) {
    const ordered_json* cell = run.cells.begin()->second;
    if (cell && cell->at("picture").is_string())
      displays.emplace(cell->at("options").at("exposure"), cell->at("options").at("tonemap"));
  }
  std::string html;
  for (const auto& [exposure, tonemap] : displays) {
    renderer::DisplayOptions display{.exposure = exposure};
    for (const auto& choice : renderer::kEnumNames<renderer::Tonemap>) {
      if (choice.name == tonemap) display.tonemap = choice.value;
    }
    const std::string name = fmt::format("reference, exposure {}, curve {}", exposure, tonemap);
    html += "<figure>" + picture_html(folder, section.reference.at("file"), name, display) +
            element("figcaption", name) + "</figure>\n";
  }
  return html + element("figcaption", "FLIP maps are black at 0 and light yellow at 1.");
}

/// An error against seconds, or against training steps. An error of zero or below, less than the noise of the
/// reference, has no place.
std::string chart_html(const Section& section, const char* metric, const char* title, bool against_steps) {
  std::vector<ChartLine> lines;
  std::string series;
  for (const Run& run : section.runs) {
    if (run.done.cells.empty() || (against_steps && run.done.cell().at("train_steps").is_null())) continue;
    const std::optional<Mean> error = run.done.mean("errors", metric);
    const double seconds = run.done.mean("seconds", "total")->value;
    const double x = against_steps ? run.done.cell()["train_steps"].get<double>() : seconds;
    if (!error || !(x > 0.0 && error->least > 0.0)) continue;
    if (run.series != series) lines.push_back({run.style, {}});
    series = run.series;
    lines.back().points.push_back(
        {x, error->value, error->least, error->most,
         fmt::format("{}: {:.4g} s, {} {:.4g} ({:.4g} to {:.4g} over {} seeds)", run.name, seconds, title,
                     error->value, error->least, error->most, run.done.cells.size())});
  }
  return lines.empty() ? "" : chart_svg(against_steps ? "training steps" : "seconds", title, lines);
}

/// Why a cell has no results; empty where it has.
std::string lack_of(const ordered_json* cell) {
  if (!cell) return "not measured";
  return is_done(*cell) ? "" : "failed: " + text_of(cell->at("error"));
}

/// A legend, charts, and the reference beside the pictures of the first seed, a row for each series.
std::string section_html(const Section& section, const std::filesystem::path& folder) {
  std::string legend, charts, rows, series;
  for (const bool against_steps : {false, true}) {
    charts += chart_html(section, "rel_mse_clean", "relative MSE", against_steps);
    charts += chart_html(section, "flip", "mean FLIP", against_steps);
  }
  for (const Run& run : section.runs) {
    if (run.series != series) {
      legend += "<span>" + swatch_svg(run.style) + " " + escaped(run.series) + "</span>\n";
      rows += "</div>\n<div class=\"row\">";
    }
    series = run.series;
    const ordered_json* cell = run.cells.begin()->second;
    rows += "<figure>";
    if (cell && is_done(*cell)) {
      const std::string name = run.name + ": " + text_of(cell->at("seconds").at("total"), 3) + " s, FLIP " +
                               text_of(cell->at("errors").at("flip"), 3);
      rows += picture_html(folder, cell->at("picture"), name) +
              picture_html(folder, cell->at("error_map"), "FLIP map of " + run.name) +
              element("figcaption", name);
    } else {
      rows += element("p class=\"none\"", lack_of(cell)) + element("figcaption", run.name);
    }
    rows += "</figure>\n";
  }
  return "<section>" + element("h2", section.scene) + "<p class=\"legend\">" + legend +
         "</p><div class=\"charts\">" + charts + "</div>\n<div class=\"pictures\"><div class=\"reference\">" +
         reference_html(section, folder) + "</div><div class=\"rows\"><div>" + rows +
         "</div></div></div></section>\n";
}

std::string table_html(const TextTable& table) {
  std::string html = "<div class=\"scroller\"><table>";
  const auto add_row = [&](const std::vector<std::string>& texts, const std::string& tag) {
    html += "<tr>";
    for (std::size_t i = 0; i < texts.size(); ++i)
      html += element(tag + (i < table.first_number ? "" : " class=\"number\""), texts[i]);
    html += "</tr>\n";
  };
  add_row(table.head, "th");
  for (const std::vector<std::string>& row : table.rows) add_row(row, "td");
  return table.rows.empty() ? "" : html + "</table></div>\n";
}

/// Columns of results.csv.
constexpr const char* kShownColumns[] = {
    "seconds_total",        "seconds_scout",       "seconds_setup",
    "seconds_train",        "seconds_render",      "seconds_denoise",
    "errors_flip",          "errors_hdr_flip",     "errors_rel_mse",
    "errors_rel_mse_clean", "errors_bias_rel_mse", "errors_mse",
    "errors_ssim",          "errors_psnr",         "estimated_error",
    "train_ms_per_step",    "query_ms_per_2m",     "memory_bytes_parameters"};

/// A row for each run and seed, also where the cell has failed or is missing.
TextTable cells_table(const std::vector<Section>& sections) {
  TextTable table{{"scene", "run", "", "seed"}, 3, {}};
  table.head.insert(table.head.end(), std::begin(kShownColumns), std::end(kShownColumns));
  for (const Section& section : sections) {
    for (const Run& run : section.runs) {
      for (const auto& [seed, cell] : run.cells) {
        table.rows.push_back({section.scene, run.name, lack_of(cell), std::to_string(seed)});
        for (const char* column : kShownColumns) {
          const ordered_json* value = cell ? find_value(*cell, column) : nullptr;
          table.rows.back().push_back(text_of(value ? *value : ordered_json()));
        }
      }
    }
  }
  return table;
}

TextTable recipe(const ordered_json& results) {
  TextTable table{
      {"", ""}, 2, {{"command", quote_command(results.at("command").get<std::vector<std::string>>())}}};
  for (const char* key : {"machine", "versions"}) table.rows.push_back({key, list_of(results.at(key))});
  for (const ordered_json& scene : results.at("scenes")) {
    table.rows.push_back({scene.at("name"), scene.at("file")});
    for (const ordered_json& reference : scene.at("references"))
      table.rows.push_back({"reference", list_of(reference)});
  }
  for (const ordered_json& cell : results.at("cells"))
    table.rows.push_back(
        {fmt::format("{}, seed {}", text_of(cell.at("run")), text_of(cell.at("seed"))), cell.at("command")});
  return table;
}

/// Nothing outside this file is ever requested.
constexpr const char* kHead = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy"
  content="default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'">
)";
constexpr const char* kDialog = R"(<dialog><form method="dialog"><select aria-label="left"></select>
<select aria-label="right"></select><button>close</button></form><div id="stage"><img alt=""><img alt=""></div>
<input type="range" min="0" max="100" aria-label="border between left and right"></dialog>
)";

}  // namespace

std::string make_report(const ordered_json& results, const std::string& folder) {
  const std::vector<Section> sections = sections_of(results);
  std::set<std::string> scenes;
  for (const Section& section : sections) scenes.insert(section.scene);
  const std::string title = fmt::format("Sweep: {}", fmt::join(scenes, ", "));
  std::string html = kHead + element("title", title) + "<style>" + kReportStyle + "</style></head><body>" +
                     element("h1", title);
  for (const Section& section : sections) html += section_html(section, folder);
  html += "<section><h2>Means over the seeds</h2>" + table_html(trade_table(results)) +
          table_html(runs_table(results)) + element("p class=\"note\"", kTableLegend) +
          "</section><section><h2>All pictures</h2>" + table_html(cells_table(sections)) +
          "</section><section><h2>Recipe</h2>" + table_html(recipe(results));
  return html + "</section>" + kDialog + "<script>" + kReportScript + "</script></body></html>\n";
}

}  // namespace gatelight::apps
