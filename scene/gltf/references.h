#pragma once
// The elements of a glTF file's lists that the shown scene refers to, directly or through other elements.

#include <nlohmann/json.hpp>

#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace gatelight::scene::gltf {

/// A list whose elements others refer to by index.
struct ElementList {
  std::string_view name;   ///< as in Rule::target: the root's member, or the extension that has the list
  std::string_view type;   ///< the owner name of the elements' rules
  std::string_view place;  ///< JSON pointer
  std::string_view placeholder;  ///< JSON of an element that nothing refers to
};

inline constexpr std::size_t kNoParent = std::numeric_limits<std::size_t>::max();

/// The parent of each of these unchecked nodes, or kNoParent. Of several parents, the last one.
std::vector<std::size_t> parents_of(const nlohmann::json& nodes);

class References {
 public:
  using Element = std::pair<const ElementList*, std::size_t>;

  /// Of unchecked JSON. `root` must outlive the object; its lists must stay where they are.
  explicit References(nlohmann::json& root);

  /// 0 if the list is missing.
  std::size_t size_of(std::string_view list) const;
  /// Whether a JSON pointer leads to an element that is there, but was not added.
  bool hides(std::string_view pointer) const;
  /// An element, and with a node its ancestors, whose transforms place it. The index is in range.
  void add(std::string_view list, std::size_t index);
  void add_all(std::string_view list);
  /// An element that was not returned before.
  std::optional<Element> next();
  nlohmann::json& value(const Element& element);
  /// Replaces the elements that were never added.
  void blank_others();

 private:
  struct List {
    const ElementList* description = nullptr;
    nlohmann::json* elements = nullptr;
    std::vector<bool> added;
  };

  std::unordered_map<std::string_view, List> lists_;
  std::vector<Element> waiting_;  ///< in the order in which they were added
  std::size_t next_ = 0;
  std::vector<std::size_t> parents_;  ///< of nodes
};

}  // namespace gatelight::scene::gltf
