#include "apps/settings/config_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <istream>
#include <memory>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"

namespace gatelight::apps {
namespace {

class SubcommandConfig final : public CLI::ConfigTOML {
 public:
  SubcommandConfig(const CLI::App& root, std::shared_ptr<ConfigFile> config)
      : root_(root), config_(std::move(config)) {}

  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override {
    config_->name = root_.get_config_ptr()->results().front();
    std::istringstream text(whole_text(input));
    std::vector<CLI::ConfigItem> kept;
    const std::vector<const CLI::App*> called =
        root_.get_subcommands([](const CLI::App* app) { return app->parsed(); });
    for (CLI::ConfigItem& item : CLI::ConfigTOML::from_config(text)) {
      // The library's marks of the begin and end of a section.
      if (item.name == "++" || item.name == "--") continue;
      if (item.parents.empty() && !called.empty()) item.parents = {called.front()->get_name()};
      // A section of another subcommand does not apply to this call.
      if (!called.empty() && item.parents.front() != called.front()->get_name() &&
          is_subcommand(item.parents.front())) {
        continue;
      }
      if (item.inputs.size() > 1 && item.name != "output" && item.name != "vary" && item.name != "for" &&
          item.name != "SCENE")
        item.inputs = {CLI::detail::join(item.inputs, ",")};
      if (!called.empty()) note(*called.front(), item);
      kept.push_back(std::move(item));
    }
    return kept;
  }

 private:
  /// Limits the size, as devices have no end, and refuses zero bytes, at which text would be cut later.
  std::string whole_text(std::istream& input) const {
    constexpr std::size_t kMax = std::size_t{1} << 20;
    std::string text(kMax + 1, '\0');
    input.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(input.gcount()));
    if (text.size() > kMax || text.find('\0') != std::string::npos) {
      throw InputError(fmt::format("cannot read '{}': {}, expected a configuration in TOML", config_->name,
                                   text.size() > kMax ? "it has more than 1 MiB" : "it has a zero byte"));
    }
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    return text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text;
  }

  bool is_subcommand(const std::string& name) const {
    return !root_.get_subcommands([&](const CLI::App* app) { return app->get_name() == name; }).empty();
  }

  void note(const CLI::App& app, const CLI::ConfigItem& item) const {
    const std::string& key = item.name;
    for (const std::string& name : {"--" + key, "-" + key, key}) {
      const CLI::Option* option = app.get_option_no_throw(name);
      if (option == nullptr) continue;
      if (!option->empty()) return;
      if (key == "progress" && item.inputs == std::vector<std::string>{"json"}) set_json_messages(true);
      for (const std::string& word : option->get_lnames()) config_->flags.insert("--" + word);
      for (const std::string& letter : option->get_snames()) config_->flags.insert("-" + letter);
      return;
    }
  }

  const CLI::App& root_;
  std::shared_ptr<ConfigFile> config_;
};

/// Where `flag` occurs as a whole word; npos: nowhere.
std::size_t find_flag(const std::string& text, const std::string& flag) {
  const auto in_flags = [&](std::size_t at) {
    return at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) != 0 || text[at] == '-');
  };
  std::size_t at = text.find(flag);
  while (at != std::string::npos && ((at > 0 && in_flags(at - 1)) || in_flags(at + flag.size())))
    at = text.find(flag, at + 1);
  return at;
}

}  // namespace

std::shared_ptr<const ConfigFile> accept_config_file(CLI::App& root) {
  auto config = std::make_shared<ConfigFile>();
  root.config_formatter(std::make_shared<SubcommandConfig>(root, config));
  root.set_config("--config", "", "Read flags from this file; flags on the command line override them")
      ->type_name("FILE.toml");
  root.allow_config_extras(CLI::config_extras_mode::error);
  return config;
}

std::string with_config_file(const std::string& message, const ConfigFile& config) {
  std::size_t first = std::string::npos;
  std::string origin;
  for (const std::string& flag : config.flags) {
    const std::size_t at =
        std::min(find_flag(message, flag), message.find(fmt::format("`{}`", flag.substr(2))));
    if (at >= first) continue;
    first = at;
    origin = fmt::format(" ('{}' sets {})", config.name, flag);
  }
  return message + origin;
}

}  // namespace gatelight::apps
