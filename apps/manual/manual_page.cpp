#include "apps/manual/manual_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "apps/manual/roff.h"

namespace gatelight::apps {
namespace {

struct Item {
  const char* name;
  const char* text;
};

constexpr Item kEnvironment[] = {
    {"GATELIGHT_OIDN",
     "Open Image Denoise 2, the file of its library or the folder of that file, where --oidn names none."},
    {"GATELIGHT_ISA",
     "Instruction set of ray tracing, shading and the cache, scalar, avx2 or avx512, where --isa names "
     "none."},
    {"GATELIGHT_VULKAN_VALIDATION",
     "Anything but 0: the validation layer of Vulkan checks all calls of --device vulkan, if it is "
     "installed."},
    {"XDG_CACHE_HOME",
     "Folder of caches, ~/.cache without it: Open Image Denoise is looked for in its folders "
     "gatelight/oidn-*, "
     "where scripts/setup keeps it."},
    {"DISPLAY, WAYLAND_DISPLAY", "Without both of them `gatelight view` opens no browser."},
};

constexpr Item kMpiEnvironment[] = {
    {"GATELIGHT_RANK_SILENCE", "Seconds without a sign of life after which a rank counts as lost (20)."},
};

constexpr const char* kMpiText =
    R"(The same command line as gatelight(1), run by several processes that make one picture together, to the bits of a
single one. Only `render` runs on several ranks. One rank a machine is best: the threads of a rank share scene,
acceleration structure and cache. Each rank needs the files of the scene under the same name, and as much memory as a
single process. Ranks that are not bound to processors share those of their machine; --threads counts those of one rank.

Rank 0 writes pictures, checkpoints, statistics and progress. With --frame-groups each group of ranks renders frames of
its own. A signal to any rank ends all of them after their pass, with the picture so far. --resume goes on from the
--checkpoint with any number of ranks.)";

constexpr const char* kMpiExamples =
    R"(mpirun -n 4 --bind-to none gatelight-mpi render room.glb -o room.exr --preset final
mpirun --hostfile machines -N 1 --bind-to none gatelight-mpi render room.glb -o room.exr
srun --nodes=8 --ntasks-per-node=1 --cpu-bind=none gatelight-mpi render room.glb -o room.exr)";

std::string begin_page(const std::string& name, const std::string& version, const std::string& summary) {
  std::string title = name;
  std::transform(title.begin(), title.end(), title.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  std::string text = summary;
  if (!text.empty()) text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  // Without a date: equal sources give equal pages. Names of files and flags are not hyphenated.
  return fmt::format(
      ".TH {} 1 \"\" \"Gatelight {}\" \"Gatelight Manual\"\n.nh\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n",
      roff_escaped(title), version, roff_escaped(name), roff_escaped(text));
}

/// A text in two parts: before the line "Examples:" or "Example:", and after it.
struct Footer {
  std::string description;
  std::string examples;
};

Footer split_footer(const std::string& text) {
  Footer footer;
  bool in_examples = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line == "Examples:" || line == "Example:") {
      in_examples = true;
    } else {
      (in_examples ? footer.examples : footer.description) += line + "\n";
    }
  }
  return footer;
}

std::string option_tag(const Option& option) {
  std::string tag = option.letter.empty() ? "" : fmt::format("\\fB{}\\fR, ", roff_escaped(option.letter));
  if (option.positional) {
    tag += fmt::format("\\fI{}\\fR", roff_escaped(option.name));
  } else {
    tag += fmt::format("\\fB{}\\fR", roff_escaped(option.flag()));
  }
  if (!option.unit.empty()) tag += " " + roff_placeholder(option.unit);
  return tag;
}

std::string option_item(const Option& option) {
  std::string source = fmt::format(".TP\n{}\n{}", option_tag(option), roff_prose(option.help + "."));
  if (option.required) source += "Required.\n";
  if (const std::string value = option.shown_default(); !value.empty())
    source += fmt::format("Default: {}.\n", roff_escaped(value));
  return source;
}

/// In the order of the groups' first options.
std::string options_section(const std::vector<Option>& options) {
  std::vector<std::string> groups;
  for (const Option& option : options) {
    if (!option.group.empty() && std::find(groups.begin(), groups.end(), option.group) == groups.end())
      groups.push_back(option.group);
  }
  std::string source = ".SH OPTIONS\n";
  for (const std::string& group : groups) {
    if (groups.size() > 1) source += fmt::format(".SS {}\n", roff_escaped(group));
    for (const Option& option : options) {
      if (option.group == group) source += option_item(option);
    }
  }
  return source;
}

std::string synopsis(const CommandText& command) {
  std::string source = fmt::format("\\fBgatelight {}\\fR", roff_escaped(command.name));
  for (const Option& option : command.options) {
    if (option.required && !option.positional)
      source +=
          fmt::format(" \\fB{}\\fR {}", roff_escaped(option.letter.empty() ? option.flag() : option.letter),
                      roff_placeholder(option.unit));
  }
  source += " [\\fIOPTIONS\\fR]";
  for (const Option& option : command.options) {
    if (!option.positional) continue;
    const std::string name = fmt::format("\\fI{}\\fR{}", roff_escaped(option.name), option.list ? "..." : "");
    source += option.required ? " " + name : fmt::format(" [{}]", name);
  }
  return source + "\n";
}

bool is_code(const std::string& word) {
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0 || c == ','; };
  return word == "and" || (!word.empty() && std::all_of(word.begin(), word.end(), is_digit));
}

/// From "Exit codes: 0 done; 1 wrong usage; ... Another sentence." of the program's help.
std::string exit_section(const std::string& footer) {
  constexpr std::string_view kBegin = "Exit codes: ";
  const std::size_t begin = footer.find(kBegin);
  if (begin == std::string::npos) return "";
  std::string text = footer.substr(begin + kBegin.size());
  std::replace(text.begin(), text.end(), '\n', ' ');
  const std::size_t end = std::min(text.find(". "), text.size());
  std::string source = ".SH EXIT STATUS\n";
  std::istringstream items(text.substr(0, end));
  for (std::string item; std::getline(items, item, ';');) {
    std::istringstream words(item);
    std::string codes;
    std::string meaning;
    for (std::string word; words >> word;) {
      std::string& part = meaning.empty() && is_code(word) ? codes : meaning;
      part += (part.empty() ? "" : " ") + word;
    }
    source += fmt::format(".TP\n{}\n{}", codes, roff_prose(meaning));
  }
  if (end < text.size()) source += ".PP\n" + roff_prose(text.substr(end + 2));
  return source;
}

template <std::size_t count>
std::string environment_items(const Item (&items)[count]) {
  std::string source;
  for (const Item& item : items) source += fmt::format(".TP\n{}\n{}", item.name, roff_prose(item.text));
  return source;
}

std::string see_also(const ProgramText& program, const std::string& but) {
  std::vector<std::string> names = {"gatelight", "gatelight-mpi"};
  for (const CommandText& command : program.commands) names.push_back("gatelight-" + command.name);
  std::erase(names, but);
  std::string source = ".SH SEE ALSO\n";
  for (const std::string& name : names)
    source += fmt::format(".BR {} (1){}\n", roff_escaped(name), name == names.back() ? "" : ",");
  return source;
}

std::string end_page(const ProgramText& program, const std::string& name, const std::string& examples) {
  const std::string text = split_footer(program.program.footer).description;
  return exit_section(text) + ".SH ENVIRONMENT\n" + environment_items(kEnvironment) +
         (name == "gatelight-mpi" ? environment_items(kMpiEnvironment) : "") +
         (examples.empty() ? "" : ".SH EXAMPLES\n" + roff_code(examples)) + see_also(program, name);
}

ManualPage program_page(const ProgramText& program) {
  const CommandText& text = program.program;
  std::string source =
      begin_page(text.name, program.version, text.summary.substr(text.summary.find(", ") + 2)) +
      "\\fBgatelight\\fR \\fISUBCOMMAND\\fR [\\fIOPTIONS\\fR]\n.SH DESCRIPTION\n" +
      roff_prose(
          "Renders scenes in glTF by paths of light on the CPU, with a neural cache that learns the "
          "light while the paths are traced. Each subcommand has a page of its own. Results are "
          "printed on stdout, messages and progress on stderr.") +
      ".SH SUBCOMMANDS\n";
  for (const CommandText& command : program.commands)
    source += fmt::format(".TP\n.BR gatelight\\-{} (1)\n{}", roff_escaped(command.name),
                          roff_prose(command.summary + "."));
  source += options_section(text.options);
  return {text.name, source + end_page(program, text.name, split_footer(text.footer).examples)};
}

ManualPage command_page(const ProgramText& program, const CommandText& command) {
  const std::string name = "gatelight-" + command.name;
  const Footer footer = split_footer(command.footer);
  std::vector<Option> options = command.options;
  options.insert(options.end(), program.program.options.begin(), program.program.options.end());
  for (Option& option : options) {
    if (option.positional) option.group = "Arguments";
  }
  return {name, begin_page(name, program.version, command.summary) + synopsis(command) + ".SH DESCRIPTION\n" +
                    roff_prose(command.summary + ".") + (footer.description.empty() ? "" : ".PP\n") +
                    roff_paragraphs(footer.description) + options_section(options) +
                    end_page(program, name, footer.examples)};
}

ManualPage mpi_page(const ProgramText& program) {
  const std::string name = "gatelight-mpi";
  return {name, begin_page(name, program.version, "Render one picture by several processes, by MPI") +
                    "\\fBmpirun\\fR \\fB\\-n\\fR \\fIN\\fR \\fBgatelight\\-mpi render\\fR [\\fIOPTIONS\\fR] "
                    "\\fISCENE\\fR\n.SH DESCRIPTION\n" +
                    roff_paragraphs(kMpiText) + end_page(program, name, kMpiExamples)};
}

}  // namespace

std::vector<ManualPage> manual_pages(const ProgramText& program) {
  std::vector<ManualPage> pages = {program_page(program)};
  for (const CommandText& command : program.commands) pages.push_back(command_page(program, command));
  pages.push_back(mpi_page(program));
  return pages;
}

}  // namespace gatelight::apps
