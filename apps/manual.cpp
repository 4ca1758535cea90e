#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <system_error>

#include "apps/describe_program.h"
#include "apps/manual/manual_page.h"
#include "apps/settings/flags.h"
#include "apps/subcommand.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/terminal.h"

namespace gatelight::apps {
namespace {

constexpr const char* kManualFooter =
    R"(The pages have all that --help-all prints, and are made from the same descriptions. They are installed with the
program, so that `man gatelight-render` shows them.

Examples:
  gatelight manual render | man -l -
  gatelight manual -o /usr/local/share/man/man1)";

struct ManualSettings {
  std::string page;
  std::string folder;
};

/// Throws OutputError.
void write_pages(const std::vector<ManualPage>& pages, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw OutputError(fmt::format("cannot make '{}': {}", folder.string(), error.message()));
  for (const ManualPage& page : pages) write_text(folder / (page.name + ".1"), page.source);
}

int run_manual(const ManualSettings& settings, const ProgramText& program) {
  if (!settings.page.empty() && !settings.folder.empty())
    throw UsageError("PAGE and --output exclude each other, expected one of them");
  const std::vector<ManualPage> pages = manual_pages(program);
  if (!settings.folder.empty()) {
    write_pages(pages, settings.folder);
    return kDone;
  }
  const std::string name = settings.page.empty() ? "gatelight" : "gatelight-" + settings.page;
  const auto page = std::find_if(pages.begin(), pages.end(),
                                 [&](const ManualPage& candidate) { return candidate.name == name; });
  write_text("-", page->source);
  return kDone;
}

}  // namespace

Subcommand add_manual_command(CLI::App& root, const std::vector<Subcommand>& others) {
  CLI::App* app = add_subcommand(root, "manual", "Print a manual page for man", kManualFooter);
  const auto settings = std::make_shared<ManualSettings>();
  std::string names;
  for (const CommandText& command : describe_program(root, others).commands) names += command.name + "|";
  names += "manual|mpi";
  const std::vector<Option> options = {
      {.name = "PAGE",
       .help = "Subcommand, or mpi; without it: the page of the program",
       .names = names,
       .read =
           [settings, names](const std::string& text) {
             const std::vector<std::string> known = split(names, '|');
             if (std::find(known.begin(), known.end(), text) == known.end())
               refuse_choice("PAGE", text, names);
             settings->page = text;
           },
       .positional = true},
      {.name = "output",
       .unit = "DIR",
       .help = "Write all pages into this folder; it is made if it does not exist",
       .read = [settings](const std::string& text) { settings->folder = text; },
       .letter = "-o"}};
  add_flags(*app, options);
  return {.app = app,
          .run = [settings, &root, &others] { return run_manual(*settings, describe_program(root, others)); },
          .options = options};
}

}  // namespace gatelight::apps
