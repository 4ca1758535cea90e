#include "apps/manual/complete.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <set>

#include "apps/manual/cameras.h"
#include "apps/manual/values.h"

namespace gatelight::apps {
namespace {

/// The beginning of a help, for a list of many.
std::string short_help(const std::string& help) {
  constexpr std::size_t kMax = 70;
  std::size_t end = help.size();
  // "gate: numbers in a feature vector" has no end there.
  constexpr std::size_t kMin = 20;
  for (const char* stop : {"; ", ": ", ". ", " ("}) end = std::min(end, help.find(stop, kMin));
  if (end <= kMax) return help.substr(0, end);
  return help.substr(0, std::min(help.rfind(' ', kMax), kMax)) + " ...";
}

template <class Names>
const CommandText* find_command(const Names& commands, const std::string& name) {
  const auto found = std::find_if(commands.begin(), commands.end(),
                                  [&](const CommandText& command) { return command.name == name; });
  return found == commands.end() ? nullptr : &*found;
}

const Option* find_flag(const std::vector<Option>& options, const std::string& word) {
  const auto found = std::find_if(options.begin(), options.end(), [&](const Option& option) {
    return !option.positional && (option.flag() == word || option.letter == word);
  });
  return found == options.end() ? nullptr : &*found;
}

/// A shell does not expand the words that it completes.
std::string expanded(const std::string& file) {
  const char* const home = std::getenv("HOME");
  return file.starts_with("~/") && home != nullptr ? home + file.substr(1) : file;
}

/// The words before the last one, read as the program would.
class Line {
 public:
  Line(const ProgramText& program, const std::vector<std::string>& words) : program_(program) {
    options_ = program.program.options;
    for (std::size_t i = 0; i + 1 < words.size(); ++i) read(words[i]);
  }

  bool has_command() const { return command_ != nullptr; }
  const std::vector<Option>& options() const { return options_; }
  /// The flag whose value comes next.
  const Option* pending() const { return missing_ > 0 ? &pending_ : nullptr; }
  bool is_given(const Option& option) const { return given_.contains(option.name); }
  /// The first file that may be a scene; empty: none.
  const std::string& scene() const { return scene_; }

  /// The positional argument that comes next.
  const Option* positional() const {
    std::size_t index = positionals_;
    for (const Option& option : options_) {
      if (!option.positional) continue;
      if (index == 0 || option.list != nullptr) return &option;
      --index;
    }
    return nullptr;
  }

  /// The option that has the values of this one: itself, or a flag of `render`.
  const Option& with_values(const Option& option) const {
    const CommandText* const render = find_command(program_.commands, "render");
    const Option* const like =
        option.like.empty() || render == nullptr ? nullptr : find_flag(render->options, option.like);
    return like == nullptr ? option : *like;
  }

 private:
  void read(const std::string& word) {
    if (missing_ > 0) {
      --missing_;
      return;
    }
    if (only_positionals_ || !word.starts_with('-') || word == "-") {
      read_positional(word);
    } else if (word == "--") {
      only_positionals_ = true;
    } else if (const Option* const flag = find_flag(options_, word.substr(0, word.find('=')))) {
      given_.insert(flag->name);
      if (flag->unit.empty() || word.find('=') != std::string::npos) return;
      pending_ = *flag;
      missing_ = flag->words;
    }
  }

  void read_positional(const std::string& word) {
    if (command_ != nullptr) {
      ++positionals_;
      if (scene_.empty()) scene_ = word;
      return;
    }
    command_ = find_command(program_.commands, word);
    if (command_ != nullptr)
      options_.insert(options_.begin(), command_->options.begin(), command_->options.end());
  }

  const ProgramText& program_;
  const CommandText* command_ = nullptr;
  std::vector<Option> options_;
  Option pending_;
  int missing_ = 0;  ///< values of the pending flag
  std::size_t positionals_ = 0;
  bool only_positionals_ = false;
  std::set<std::string> given_;
  std::string scene_;
};

/// Completes one word.
class Word {
 public:
  Word(const Line& line, std::string word) : line_(line), word_(std::move(word)) {}

  void add_flags() {
    for (const Option& option : line_.options()) {
      if (option.positional || (line_.is_given(option) && option.list == nullptr)) continue;
      const std::string& help = option.help.empty() ? line_.with_values(option).help : option.help;
      add(option.flag(), short_help(help));
      // Of "-o" and "--output" one is enough unless a single dash is typed.
      if (!option.letter.empty() && word_ == option.letter) add(option.letter, short_help(option.help));
    }
  }

  void add_commands(const std::vector<CommandText>& commands) {
    for (const CommandText& command : commands) add(command.name, command.summary);
  }

  /// The value begins at `begin` of the word.
  void add_values(const Option& option, std::size_t begin) {
    if (option.unit == "NAME=LIST") {
      add_named_list(begin);
      return;
    }
    Values values = values_of(line_.with_values(option));
    if (!option.like.empty()) values.is_list = values.is_list || option.unit == "LIST";
    if (line_.with_values(option).name == "camera") {
      values.words.emplace_back("all");
      for (const std::string& name : camera_names(expanded(line_.scene()))) values.words.push_back(name);
    }
    if (values.is_list) {
      add_list(values.words, begin);
      return;
    }
    const std::string typed = word_.substr(0, begin);
    for (const std::string& value : values.words) add(typed + value, "");
    result_.files = values.files;
    result_.folders = values.folders;
    result_.extensions = values.extensions;
    // A file after "NAME=" of the value.
    const std::size_t equals = option.unit.starts_with("NAME=") ? word_.rfind('=') : std::string::npos;
    result_.begin = equals == std::string::npos || equals < begin ? begin : equals + 1;
    if (option.unit.starts_with("NAME=") && equals == std::string::npos) result_.files = false;
  }

  Completion finish() {
    const auto goes_on = [](const Completion::Candidate& candidate) {
      return std::string_view(":/=").find(candidate.word.back()) != std::string_view::npos;
    };
    std::vector<Completion::Candidate>& found = result_.candidates;
    if (!found.empty() && std::all_of(found.begin(), found.end(), goes_on)) result_.goes_on = true;
    return std::move(result_);
  }

 private:
  void add(const std::string& word, const std::string& help) {
    if (word.starts_with(word_)) result_.candidates.push_back({word, help});
  }

  /// Words that are not in the list yet.
  void add_list(const std::vector<std::string>& words, std::size_t begin) {
    const std::size_t comma = word_.rfind(',');
    const std::size_t last = comma == std::string::npos || comma < begin ? begin : comma + 1;
    const std::string before = fmt::format(",{}", word_.substr(begin, last - begin));
    for (const std::string& word : words) {
      if (before.find(fmt::format(",{},", word)) == std::string::npos) add(word_.substr(0, last) + word, "");
    }
    result_.goes_on = true;
  }

  /// A flag that is not in the help, one of `render`, without its dashes, "=", and a list of its values.
  void add_named_list(std::size_t begin) {
    const std::size_t equals = word_.find('=', begin);
    for (const Option& option : line_.options()) {
      if (!option.group.empty()) continue;
      const Option& like = line_.with_values(option);
      if (equals == std::string::npos) {
        add(word_.substr(0, begin) + like.name + "=", short_help(like.help));
      } else if (word_.substr(begin, equals - begin) == like.name) {
        add_list(values_of(like).words, equals + 1);
        return;
      }
    }
  }

  const Line& line_;
  std::string word_;
  Completion result_;
};

}  // namespace

Completion complete(const ProgramText& program, const std::vector<std::string>& words) {
  const Line line(program, words);
  const std::string last = words.empty() ? "" : words.back();
  Word word(line, last);
  const std::size_t equals = last.starts_with("--") ? last.find('=') : std::string::npos;
  if (const Option* const pending = line.pending()) {
    word.add_values(*pending, 0);
  } else if (equals != std::string::npos) {
    const Option* const flag = find_flag(line.options(), last.substr(0, equals));
    if (flag != nullptr) word.add_values(*flag, equals + 1);
  } else if (last.starts_with('-')) {
    word.add_flags();
  } else if (!line.has_command()) {
    word.add_commands(program.commands);
  } else if (const Option* const positional = line.positional()) {
    word.add_values(*positional, 0);
  } else {
    word.add_flags();
  }
  return word.finish();
}

std::string text_of(const Completion& completion) {
  std::string text;
  for (const Completion::Candidate& candidate : completion.candidates)
    text += fmt::format("{}\t{}\n", candidate.word, candidate.help);
  if (completion.files)
    return text + fmt::format(":files\t{}\t{}\n", completion.begin, fmt::join(completion.extensions, " "));
  if (completion.folders) return text + fmt::format(":folders\t{}\n", completion.begin);
  return text + (completion.goes_on ? ":open\n" : ":words\n");
}

}  // namespace gatelight::apps
