#include "apps/settings/help_format.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace gatelight::apps {
namespace {

constexpr std::size_t kFlagColumns = 30;
constexpr std::size_t kTextColumns = 86;

std::string wrap(const std::string& text) {
  std::istringstream words(text);
  std::string wrapped;
  std::size_t column = 0;
  for (std::string word; words >> word;) {
    if (column > 0 && column + 1 + word.size() > kTextColumns) {
      wrapped += '\n';
      column = 0;
    } else if (column > 0) {
      wrapped += ' ';
      ++column;
    }
    wrapped += word;
    column += word.size();
  }
  return wrapped;
}

class HelpFormatter final : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(kFlagColumns); }

  /// One empty line between groups; the library leaves two.
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    std::string text = CLI::Formatter::make_help(app, std::move(name), mode);
    for (std::size_t at = 0; (at = text.find("\n\n\n", at)) != std::string::npos;) text.erase(at, 1);
    return text;
  }

  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_type_name().empty() ? "" : " " + option->get_type_name();
  }

  std::string make_option_desc(const CLI::Option* option) const override {
    std::string text = option->get_description();
    if (option->get_required()) text += " (required)";
    if (!option->get_default_str().empty()) text += " [" + option->get_default_str() + "]";
    return wrap(text);
  }
};

/// "Cache, learning": cache, learning.
std::vector<std::string> words_of(const std::string& group) {
  std::string text = CLI::detail::to_lower(group);
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

bool has_word(const std::string& group, const std::string& word) {
  const std::vector<std::string> words = words_of(group);
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Groups with flags that are in the help, but for the one of --help itself.
std::vector<std::string> groups_of(const CLI::App& app) {
  std::vector<std::string> groups;
  for (const std::string& group : app.get_groups()) {
    if (!group.empty() && group != app.get_help_ptr()->get_group()) groups.push_back(group);
  }
  return groups;
}

/// The word beside --help, which the library takes for the first positional argument; empty where it is no
/// topic.
std::string topic_of(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional() || option->empty()) continue;
    const std::string& word = option->results().front();
    const std::vector<std::string> groups = groups_of(app);
    const bool known = std::any_of(groups.begin(), groups.end(),
                                   [&](const std::string& group) { return has_word(group, word); });
    return known ? word : "";
  }
  return "";
}

/// Hides the flags that are not wanted and returns how many.
int hide(CLI::App& app, const std::function<bool(const CLI::Option&)>& wanted) {
  int hidden = 0;
  for (CLI::Option* option : app.get_options()) {
    const bool of_help = option == app.get_help_ptr() || option == app.get_help_all_ptr();
    if (option->get_positional() || of_help || option->get_group().empty()) continue;
    if (wanted(*option)) continue;
    option->group("");
    ++hidden;
  }
  return hidden;
}

/// The first word of each group, once.
std::vector<std::string> topics_of(const CLI::App& app) {
  std::vector<std::string> topics;
  for (const std::string& group : groups_of(app)) {
    const std::string topic = words_of(group).front();
    if (std::find(topics.begin(), topics.end(), topic) == topics.end()) topics.push_back(topic);
  }
  return topics;
}

}  // namespace

std::string help_text(CLI::App& app, const std::string& program, const std::set<std::string>& common) {
  if (const std::string topic = topic_of(app); !topic.empty()) {
    hide(app, [&](const CLI::Option& option) { return has_word(option.get_group(), topic); });
    app.footer("");
  } else if (!common.empty()) {
    const std::string topics = fmt::format("{}", fmt::join(topics_of(app), ", "));
    const int hidden =
        hide(app, [&](const CLI::Option& option) { return common.contains(option.get_lnames().front()); });
    app.footer(
        fmt::format("{} more flags: --help-all shows all, --help TOPIC shows those of a topic:\n  {}\n\n{}",
                    hidden, topics, app.get_footer()));
  }
  return app.help(program);
}

std::shared_ptr<CLI::Formatter> make_help_formatter() {
  return std::make_shared<HelpFormatter>();
}

}  // namespace gatelight::apps
