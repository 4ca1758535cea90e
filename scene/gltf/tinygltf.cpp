// Compiles tinygltf, and lets it read a JSON value in place of a text.

#include <algorithm>
#include <fstream>  // tiny_gltf.h does not include it without its file access
#include <sstream>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

namespace {

/// The value that tinygltf reads next.
thread_local nlohmann::json judged;

}  // namespace

// tinygltf parses its text by json::parse(first, last, callback, exceptions), which becomes
// json::value_type(std::move(judged)). A second parse of the text took as long as the first, and would need a
// text of the judged value.
#define parse(first, last, callback, exceptions) value_type(std::move(::judged))
#define TINYGLTF_IMPLEMENTATION
#include "scene/gltf/tinygltf.h"
#undef parse

namespace gatelight::scene::gltf {

bool load_json(tinygltf::TinyGLTF& reader, nlohmann::json&& root, tinygltf::Model& model,
               std::string& error) {
  constexpr std::string_view kUnread = "null";
  judged = std::move(root);
  std::string warning;
  return reader.LoadASCIIFromString(&model, &error, &warning, kUnread.data(),
                                    static_cast<unsigned>(kUnread.size()), "");
}

}  // namespace gatelight::scene::gltf
