#include "apps/config_file.h"

#include <memory>

namespace gatelight::apps {
namespace {

class SubcommandConfig final : public CLI::ConfigTOML {
 public:
  explicit SubcommandConfig(const CLI::App& root) : root_(root) {}

  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override {
    std::vector<CLI::ConfigItem> kept;
    const std::vector<const CLI::App*> called =
        root_.get_subcommands([](const CLI::App* app) { return app->parsed(); });
    for (CLI::ConfigItem& item : CLI::ConfigTOML::from_config(input)) {
      // Marks of a section's begin and end.
      if (item.name == "++" || item.name == "--") continue;
      if (item.parents.empty() && !called.empty()) item.parents = {called.front()->get_name()};
      // A section of another subcommand is not for this call.
      if (!called.empty() && item.parents.front() != called.front()->get_name() &&
          is_subcommand(item.parents.front())) {
        continue;
      }
      if (item.inputs.size() > 1 && item.name != "output" && item.name != "vary" && item.name != "for" &&
          item.name != "SCENE")
        item.inputs = {CLI::detail::join(item.inputs, ",")};
      kept.push_back(std::move(item));
    }
    return kept;
  }

 private:
  bool is_subcommand(const std::string& name) const {
    return !root_.get_subcommands([&](const CLI::App* app) { return app->get_name() == name; }).empty();
  }

  const CLI::App& root_;
};

}  // namespace

void accept_config_file(CLI::App& root) {
  root.config_formatter(std::make_shared<SubcommandConfig>(root));
  root.set_config("--config", "", "Read flags from this file; those on the command line win")
      ->type_name("FILE.toml");
  root.allow_config_extras(CLI::config_extras_mode::error);
}

}  // namespace gatelight::apps
