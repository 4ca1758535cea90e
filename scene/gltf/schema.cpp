#include "scene/gltf/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "scene/gltf/channels.h"
#include "scene/gltf/references.h"

namespace gatelight::scene::gltf {
namespace {

using nlohmann::json;

/// The path from the root to the checked value, as a linked list on the call stack. The text is built only
/// for an error.
struct Path {
  const Path* parent = nullptr;
  std::string_view name;
  std::size_t index = 0;

  std::string text() const {
    if (!parent) return "";
    const std::string before = parent->text();
    if (name.empty()) return fmt::format("{}[{}]", before, index);
    return before.empty() ? std::string(name) : fmt::format("{}.{}", before, name);
  }
};

std::string show(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 60) + "...";
  return text;
}

bool is_choice(std::string_view choices, std::string_view value) {
  while (!choices.empty()) {
    const std::size_t bar = choices.find('|');
    if (choices.substr(0, bar) == value) return true;
    if (bar == std::string_view::npos) break;
    choices.remove_prefix(bar + 1);
  }
  return false;
}

class Checker {
 public:
  Checker(References& references, std::string_view file, Warnings& warnings)
      : references_(references), file_(file), warnings_(warnings) {
    for (const Rule& rule : schema_rules()) rules_[rule.owner].push_back(&rule);
  }

  void check_object(json& value, std::string_view type, const Path& path) const {
    if (!value.is_object()) fail(path, value, "an object");
    static const std::vector<const Rule*> kNone;
    const auto found = rules_.find(type);
    const std::vector<const Rule*>& rules = found == rules_.end() ? kNone : found->second;
    std::size_t checked = 0;
    for (const Rule* rule : rules) {
      const auto member = value.find(rule->name);
      const Path here{&path, rule->name};
      if (member == value.end()) {
        if (rule->required) throw make_error(file_, here.text(), "missing, expected " + expectation(*rule));
        continue;
      }
      if (fits_member(*member, *rule, here)) {
        ++checked;
      } else {
        value.erase(member);
      }
    }
    if (checked < value.size()) erase_others(value, rules);
  }

  void check_element(const References::Element& element) const {
    const auto& [list, index] = element;
    const Path root{};
    const bool of_extension = list->place.starts_with("/extensions/");
    const Path extensions{&root, "extensions"};
    const Path extension{&extensions, list->name};
    const std::string_view member = list->place.substr(list->place.rfind('/') + 1);
    const Path elements{of_extension ? &extension : &root, member};
    check_object(references_.value(element), list->type, {&elements, {}, index});
  }

 private:
  static std::string complaint(const Path& path, const json& value, std::string_view expected) {
    return fmt::format("{}: {}, expected {}", path.text(), show(value), expected);
  }

  [[noreturn]] void fail(const Path& path, const json& value, std::string_view expected) const {
    throw make_error(file_, "", complaint(path, value, expected));
  }

  static void erase_others(json& value, const std::vector<const Rule*>& rules) {
    for (auto member = value.begin(); member != value.end();) {
      const bool known = std::any_of(rules.begin(), rules.end(),
                                     [&](const Rule* rule) { return rule->name == member.key(); });
      member = known ? std::next(member) : value.erase(member);
    }
  }

  /// Whether a member of a lenient rule fits. Of others it throws.
  bool fits_member(json& value, const Rule& rule, const Path& path) const {
    if (!rule.lenient) {
      check_member(value, rule, path);
      return true;
    }
    try {
      check_member(value, rule, path);
      return true;
    } catch (const InputError& error) {
      const std::string_view line = error.what();
      warnings_.add(fmt::format("{}; it is ignored", line.substr(file_.size() + 2)));
      return false;
    }
  }

  void check_member(json& value, const Rule& rule, const Path& path) const {
    switch (rule.shape) {
      case Shape::single:
        check_value(value, rule, path);
        return;
      case Shape::list:
        if (!value.is_array() || (rule.length > 0 && value.size() != static_cast<std::size_t>(rule.length))) {
          fail(path, value, rule.length > 0 ? fmt::format("an array of {}", rule.length) : "an array");
        }
        for (std::size_t i = 0; i < value.size(); ++i) check_value(value[i], rule, {&path, {}, i});
        return;
      case Shape::elements:
        if (!value.is_array()) fail(path, value, "an array");
        return;
      case Shape::lists: {
        if (!value.is_array()) fail(path, value, "an array");
        Rule each = rule;
        each.shape = Shape::list;
        for (std::size_t i = 0; i < value.size(); ++i) check_member(value[i], each, {&path, {}, i});
        return;
      }
      case Shape::dictionary:
        if (!value.is_object()) fail(path, value, "an object");
        for (auto& [name, entry] : value.items()) check_value(entry, rule, {&path, name});
        return;
    }
  }

  void check_value(json& value, const Rule& rule, const Path& path) const {
    if (rule.kind == Kind::anything) return;
    if (rule.kind == Kind::object) return check_object(value, rule.target, path);
    if (!fits(value, rule)) fail(path, value, expectation(rule));
    if (rule.kind == Kind::number) value = value.get<double>();
    if (!is_whole(rule.kind)) return;
    const auto whole = static_cast<std::uint64_t>(value.get<double>());
    if (rule.kind == Kind::index) references_.add(rule.target, whole);
    value = whole;
  }

  static bool is_whole(Kind kind) { return kind == Kind::integer || kind == Kind::index; }

  bool fits(const json& value, const Rule& rule) const {
    if (rule.kind == Kind::boolean) return value.is_boolean();
    if (rule.kind == Kind::string) {
      return value.is_string() &&
             (rule.target.empty() || is_choice(rule.target, value.get_ref<const std::string&>()));
    }
    if (!value.is_number()) return false;
    const double number = value.get<double>();
    if (is_whole(rule.kind) && std::floor(number) != number) return false;
    if (rule.kind == Kind::index)
      return number >= 0.0 && number < static_cast<double>(references_.size_of(rule.target));
    if (!(number >= rule.low && number <= rule.high)) return false;
    return rule.target.empty() || is_choice(rule.target, fmt::format("{:.0f}", number));
  }

  std::string expectation(const Rule& rule) const {
    switch (rule.kind) {
      case Kind::object:
        return rule.shape == Shape::list ? "an array of objects" : "an object";
      case Kind::boolean:
        return "true or false";
      case Kind::string:
        return rule.target.empty() ? "a string" : fmt::format("one of {}", rule.target);
      case Kind::integer:
        if (!rule.target.empty()) return fmt::format("one of {}", rule.target);
        return fmt::format("an integer from {:.0f} to {:.0f}", rule.low, rule.high);
      case Kind::index:
        return fmt::format("an index into {} (of size {})", rule.target, references_.size_of(rule.target));
      case Kind::number:
      case Kind::anything:
        break;
    }
    const double most = std::numeric_limits<float>::max();
    if (rule.low == -most && rule.high == most) return "a number in the range of single precision";
    if (rule.high < most) return fmt::format("a number from {:g} to {:g}", rule.low, rule.high);
    return fmt::format("a number {}, in the range of single precision",
                       rule.low == 0.0 ? "that is not negative" : "above zero");
  }

  References& references_;
  std::string_view file_;
  Warnings& warnings_;
  std::unordered_map<std::string_view, std::vector<const Rule*>> rules_;
};

}  // namespace

void check_schema(json& root, int scene, const std::vector<std::size_t>& animations, std::string_view file,
                  Warnings& warnings) {
  if (animations.empty()) root.erase("animations");
  References references(root);
  const Checker checker(references, file, warnings);
  const auto check_waiting = [&] {
    while (const std::optional<References::Element> element = references.next())
      checker.check_element(*element);
  };
  checker.check_object(root, "root", {});
  if (scene < 0) scene = static_cast<int>(root.value("scene", 0u));
  if (static_cast<std::size_t>(scene) < references.size_of("scenes"))
    references.add("scenes", static_cast<std::size_t>(scene));
  references.add_all("KHR_materials_variants");  // a user may ask for any
  check_waiting();
  // Only now it is known what is shown, and so which channels count.
  for (const std::size_t animation : animations) {
    join_samplers(root["animations"][animation], animation, references, file, warnings);
    references.add("animations", animation);
  }
  check_waiting();
  references.blank_others();
}

}  // namespace gatelight::scene::gltf
