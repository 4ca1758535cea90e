#include "apps/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "apps/settings/config_file.h"
#include "apps/settings/help_format.h"
#include "apps/subcommand.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/terminal.h"
#include "apps/terminal/version.h"

namespace gatelight::apps {
namespace {

constexpr const char* kProgramFooter =
    R"(Exit codes: 0 done; 1 wrong usage; 2 scene or input file unusable; 3 output could not be written; 4 out of memory or
over the limit given; 5 CPU, GPU or ISA not available; 6 numerical failure (--nan error); 7 some cells of a sweep failed;
129, 130 and 143 stopped by a signal after writing the picture so far. The last line on stderr says what failed, on which
file, and what to do.

Examples:
  gatelight render room.glb -o room.exr -o room.png --spp 256
  gatelight info room.glb
  gatelight compare reference.exr room.exr
  gatelight sweep room.glb -o room-sweep
  gatelight render --help)";

const CLI::App* called_subcommand(const CLI::App& root) {
  const std::vector<CLI::App*> called = root.get_subcommands();
  return called.empty() ? nullptr : called.front();
}

/// The beginning of a text from a file, which may be long.
std::string cut(const std::string& text) {
  constexpr std::size_t kMost = 200;
  return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
}

/// What was wrong; our own words replace those of the library where they are too vague.
std::string describe(const CLI::App& root, const CLI::ParseError& error, const ConfigFile& config) {
  const CLI::App* called = called_subcommand(root);
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr && called == nullptr) {
    const std::vector<std::string> rest = root.remaining();
    const std::string got =
        rest.empty() ? "a subcommand is missing" : "'" + rest.front() + "' is no subcommand";
    return got + ", expected render, compare, info, merge, reconstruct or sweep";
  }
  std::string text = error.what();
  if (dynamic_cast<const CLI::ConfigError*>(&error) != nullptr && called != nullptr) {
    const std::string file = config.name.empty() ? "--config" : fmt::format("'{}'", config.name);
    constexpr std::string_view kExtras = "INI was not able to parse ";
    if (text.starts_with(kExtras)) text = fmt::format("unknown '{}'", cut(text.substr(kExtras.size())));
    return fmt::format("{}: {}, expected flags of '{}' and their values", file, text, called->get_name());
  }
  constexpr std::string_view kAtMost = ": At Most 1 required but received ";
  if (const std::size_t at = text.find(kAtMost); at != std::string::npos) {
    text = fmt::format("{} is given {} times, expected once", text.substr(0, at),
                       text.substr(at + kAtMost.size()));
  }
  return with_config_file(text, config);
}

/// CLI11 throws for --help and --version too.
int finish_parsing(const CLI::App& root, const CLI::ParseError& error, const ConfigFile& config) {
  const CLI::App* called = called_subcommand(root);
  if (dynamic_cast<const CLI::CallForHelp*>(&error) != nullptr) {
    write_text("-", called == nullptr ? root.help() : called->help(root.get_name()));
    return kDone;
  }
  if (dynamic_cast<const CLI::CallForVersion*>(&error) != nullptr) {
    write_text("-", fmt::format("gatelight {}\n", version()));
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
  for (const CLI::App* app : {&root, called_subcommand(root)}) {
    for (const CLI::Option* option : app->get_options()) {
      for (const std::string& word : option->results()) {
        if (!word.empty()) continue;
        const std::string type = option->get_type_name();
        throw UsageError(
            fmt::format("{}: '' is empty, expected {}", option->get_name(), type.empty() ? "a file" : type));
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

int parse(int argc, const char* const* argv, bool runs) {
  CLI::App root("Gatelight, an offline path tracer for glTF scenes", "gatelight");
  root.footer(kProgramFooter);
  root.set_version_flag("--version", version());
  root.require_subcommand(1);
  // --config belongs to the root but may follow the subcommand's name.
  root.fallthrough();
  root.formatter(make_help_formatter());
  const std::shared_ptr<const ConfigFile> config = accept_config_file(root);
  const std::vector<Subcommand> subcommands = {
      add_render_command(root, std::vector<std::string>(argv, argv + argc)),
      add_compare_command(root),
      add_info_command(root),
      add_merge_command(root),
      add_reconstruct_command(root),
      add_sweep_command(root, std::vector<std::string>(argv, argv + argc)),
  };
  try {
    root.parse(argc, argv);
    refuse_empty_words(root);
    for (const Subcommand& subcommand : subcommands) {
      if (subcommand.app->parsed()) return runs ? subcommand.run() : kDone;
    }
  } catch (const CLI::ParseError& error) {
    return finish_parsing(root, error, *config);
  } catch (...) {
    return fail(*config);
  }
  return kUsage;
}

int parse_or_fail(int argc, const char* const* argv, bool runs) {
  try {
    return parse(argc, argv, runs);
  } catch (...) {
    return fail({});
  }
}

}  // namespace

int read_only(int argc, const char* const* argv) {
  return parse_or_fail(argc, argv, false);
}

int run(int argc, const char* const* argv) {
  return parse_or_fail(argc, argv, true);
}

}  // namespace gatelight::apps
