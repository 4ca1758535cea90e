#include "apps/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "apps/settings/config_file.h"
#include "apps/settings/flags.h"
#include "apps/settings/help_format.h"
#include "apps/settings/other_tools.h"
#include "apps/subcommand.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"
#include "apps/terminal/terminal.h"
#include "apps/terminal/version.h"
#include "base/nearest_word.h"

namespace gatelight::apps {
namespace {

constexpr const char* kProgramFooter =
    R"(Exit codes: 0 done; 1 wrong usage; 2 scene or input file unusable; 3 output could not be written; 4 out of memory or
over the limit given; 5 CPU, GPU or ISA not available; 6 numerical failure (--nan error); 7 some cells of a sweep
failed; 8 no cell of a sweep is within the limits of --advise; 9 another rank of gatelight-mpi does not answer; 129, 130
and 143 stopped by a signal after writing the picture so far. The last line on stderr says what failed, on which file,
and what to do.

Examples:
  gatelight render room.glb -o room.exr -o room.png --spp 256
  gatelight info room.glb
  gatelight compare reference.exr room.exr
  gatelight sweep room.glb -o room-sweep
  gatelight render --help)";

CLI::App* called_subcommand(const CLI::App& root) {
  const std::vector<CLI::App*> called = root.get_subcommands();
  return called.empty() ? nullptr : called.front();
}

/// The beginning of a text from a file, which may be long.
std::string cut(const std::string& text) {
  constexpr std::size_t kMax = 200;
  return text.size() <= kMax ? text : text.substr(0, kMax) + "...";
}

/// Long names, without their dashes, of the flags of the called subcommand and of all.
std::vector<std::string> flag_names(const CLI::App& root) {
  std::vector<std::string> names;
  const CLI::App* const called = called_subcommand(root);
  for (const CLI::App* app : {&root, called}) {
    if (app == nullptr) continue;
    for (const CLI::Option* option : app->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back(name);
    }
  }
  return names;
}

/// "unknown flag '--aperure'; did you mean '--aperture'?"; empty where no unknown word is a flag.
std::string describe_unknown_flag(const CLI::App& root) {
  for (const std::string& word : root.remaining(true)) {
    if (!word.starts_with('-')) continue;
    const std::string name = word.substr(0, word.find('='));
    if (const std::string ours = flag_of_other_tools(name); !ours.empty())
      return fmt::format("unknown flag '{}'; here it is '{}'", cut(word), ours);
    // The dashes are left out of the comparison: they always match.
    const std::string meant = name.starts_with("--") ? nearest_word(name.substr(2), flag_names(root)) : "";
    return fmt::format("unknown flag '{}'{}", cut(word),
                       meant.empty() ? "" : fmt::format("; did you mean '--{}'?", meant));
  }
  return "";
}

/// What the user may have meant by a word that is no subcommand.
std::string meant_subcommand(const std::string& word, const std::vector<std::string>& names) {
  const bool scene = word.ends_with(".glb") || word.ends_with(".gltf");
  if (scene)
    return fmt::format("; 'gatelight render {0} -o picture.png' renders it, 'gatelight view {0}' shows it",
                       cut(word));
  if (word == "help" || word == "version") return fmt::format("; did you mean '--{}'?", word);
  if (const std::string ours = flag_of_other_tools(word); !ours.empty())
    return fmt::format("; here it is '{}'", ours);
  return did_you_mean(word, names);
}

std::string describe_subcommand(const CLI::App& root) {
  const std::vector<std::string> rest = root.remaining();
  std::vector<std::string> names;
  for (const CLI::App* app : root.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(app->get_name());
  const std::string got =
      rest.empty() ? "a subcommand is missing" : fmt::format("'{}' is not a subcommand", cut(rest.front()));
  return fmt::format("{}, expected {} or {}{}", got, fmt::join(names.begin(), names.end() - 1, ", "),
                     names.back(), rest.empty() ? "" : meant_subcommand(rest.front(), names));
}

/// Describes a parse error. Replaces those of CLI11's messages that are too vague.
std::string describe(const CLI::App& root, const CLI::ParseError& error, const ConfigFile& config) {
  const CLI::App* called = called_subcommand(root);
  const bool required = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  if (required && called == nullptr) return describe_subcommand(root);
  std::string text = error.what();
  if (required || dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    // A misspelt flag is often one that is missing then.
    const std::string unknown = describe_unknown_flag(root);
    if (!unknown.empty()) text = required ? fmt::format("{}; {}", text, unknown) : unknown;
    const std::vector<std::string> rest = root.remaining(true);
    if (required && unknown.empty() && !rest.empty() && text.starts_with("--output"))
      text = fmt::format("{}; '{}' does not belong to a flag, did you mean '-o {}'?", text, cut(rest.front()),
                         cut(rest.front()));
  }
  if (dynamic_cast<const CLI::ConfigError*>(&error) != nullptr && called != nullptr) {
    const std::string file = config.name.empty() ? "--config" : fmt::format("'{}'", config.name);
    constexpr std::string_view kExtras = "INI was not able to parse ";
    std::string meant;
    if (text.starts_with(kExtras)) {
      const std::string key = text.substr(kExtras.size());
      meant = did_you_mean(key.substr(key.rfind('.') + 1), flag_names(root));
      text = fmt::format("unknown '{}'", cut(key));
    }
    return fmt::format("{}: {}, expected flags of '{}' and their values{}", file, text, called->get_name(),
                       meant);
  }
  constexpr std::string_view kAtMost = ": At Most 1 required but received ";
  if (const std::size_t at = text.find(kAtMost); at != std::string::npos) {
    text = fmt::format("{} is given {} times, expected once", text.substr(0, at),
                       text.substr(at + kAtMost.size()));
  }
  return with_config_file(text, config);
}

/// CLI11 throws for --help and --version too.
int finish_parsing(const CLI::App& root, const CLI::ParseError& error, const ConfigFile& config,
                   const std::vector<Subcommand>& subcommands) {
  CLI::App* called = called_subcommand(root);
  const bool all = dynamic_cast<const CLI::CallForAllHelp*>(&error) != nullptr;
  if (all && called != nullptr) {
    write_text("-", called->help(root.get_name()));
    return kDone;
  }
  if (all || dynamic_cast<const CLI::CallForHelp*>(&error) != nullptr) {
    const auto found = std::find_if(subcommands.begin(), subcommands.end(),
                                    [&](const Subcommand& subcommand) { return subcommand.app == called; });
    write_text("-",
               found == subcommands.end() ? root.help() : help_text(*called, root.get_name(), found->common));
    return kDone;
  }
  if (dynamic_cast<const CLI::CallForVersion*>(&error) != nullptr) {
    write_text("-", fmt::format("gatelight {}\ndenoiser: {}\n", version(), denoiser_text()));
    return kDone;
  }
  if (dynamic_cast<const CLI::FileError*>(&error) != nullptr) {
    print_failure({kInput, fmt::format("--config: {}", error.what()), "check the file's name"});
    return kInput;
  }
  print_failure({kUsage, describe(root, error, config),
                 fmt::format("see 'gatelight {}--help'", called == nullptr ? "" : called->get_name() + " ")});
  return kUsage;
}

/// An empty file name would count as no file; often it is an unset shell variable.
void refuse_empty_words(const CLI::App& root) {
  const CLI::App* const called = called_subcommand(root);
  for (const CLI::App* app : {&root, called}) {
    for (const CLI::Option* option : app->get_options()) {
      for (const std::string& word : option->results()) {
        if (!word.empty()) continue;
        const std::string type = option->get_type_name();
        throw BadOption({name_of(*option), "", "", type.empty() ? "a file" : type});
      }
    }
  }
}

/// Reports the exception that is being handled and returns its exit code.
int fail(const ConfigFile& config) {
  Failure failure = describe_current_exception();
  failure.message = with_config_file(failure.message, config);
  print_failure(failure);
  return failure.code;
}

int parse(int argc, const char* const* argv, bool runs, RunTeam& team) {
  CLI::App root("Gatelight, an offline path tracer for glTF scenes", "gatelight");
  root.footer(kProgramFooter);
  root.set_version_flag("--version", version());
  root.set_help_all_flag("--help-all", "Print the help with all flags");
  root.require_subcommand(1);
  // --config belongs to the root but may follow the subcommand's name.
  root.fallthrough();
  root.formatter(make_help_formatter());
  const std::shared_ptr<const ConfigFile> config = accept_config_file(root);
  const std::vector<Subcommand> subcommands = {
      add_render_command(root, std::vector<std::string>(argv, argv + argc), team),
      add_compare_command(root),
      add_info_command(root),
      add_merge_command(root),
      add_denoise_command(root),
      add_view_command(root),
      add_sweep_command(root, std::vector<std::string>(argv, argv + argc)),
      add_completion_command(root),
  };
  // The scripts of `gatelight completion` ask.
  if (runs && argc > 1 && std::string_view(argv[1]) == "__complete") {
    write_text("-", completions(root, {argv + 2, argv + argc}));
    return kDone;
  }
  try {
    root.parse(argc, argv);
    refuse_empty_words(root);
    for (const Subcommand& subcommand : subcommands) {
      if (!subcommand.app->parsed()) continue;
      if (!team.is_alone() && subcommand.app->get_name() != "render") {
        throw BadOption(fmt::format("'{0}' runs in one process: start it with 'gatelight {0}'",
                                    subcommand.app->get_name()));
      }
      return runs ? subcommand.run() : kDone;
    }
  } catch (const CLI::ParseError& error) {
    return finish_parsing(root, error, *config, subcommands);
  } catch (...) {
    return fail(*config);
  }
  return kUsage;
}

/// Whether the command line has --progress json: errors found while it is read are events too.
bool wants_json(int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    const bool apart = word == "--progress" && i + 1 < argc && std::string_view(argv[i + 1]) == "json";
    if (apart || word == "--progress=json") return true;
  }
  return false;
}

int parse_or_fail(int argc, const char* const* argv, bool runs, RunTeam& team) {
  set_json_messages(wants_json(argc, argv));
  try {
    return parse(argc, argv, runs, team);
  } catch (...) {
    return fail({});
  }
}

}  // namespace

int read_only(int argc, const char* const* argv) {
  RunTeam alone;
  return parse_or_fail(argc, argv, false, alone);
}

int run(int argc, const char* const* argv) {
  RunTeam alone;
  return run(argc, argv, alone);
}

int run(int argc, const char* const* argv, RunTeam& team) {
  return parse_or_fail(argc, argv, true, team);
}

}  // namespace gatelight::apps
