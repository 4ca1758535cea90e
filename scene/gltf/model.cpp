#include "scene/gltf/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <utility>

#include "scene/gltf/error.h"

namespace gatelight::scene::gltf {
namespace {

using nlohmann::json;

/// Calls use(count, elements) for each list of the root: its length, and the model's list for it.
template <typename Use>
void for_each_list(const json& root, tinygltf::Model& model, const Use& use) {
  const auto visit = [&](const char* name, auto& elements) {
    if (const auto list = root.find(name); list != root.end()) use(list->size(), elements);
  };
  visit("accessors", model.accessors);
  visit("buffers", model.buffers);
  visit("bufferViews", model.bufferViews);
  visit("cameras", model.cameras);
  visit("images", model.images);
  visit("materials", model.materials);
  visit("meshes", model.meshes);
  visit("nodes", model.nodes);
  visit("samplers", model.samplers);
  visit("scenes", model.scenes);
  visit("skins", model.skins);
  visit("textures", model.textures);
}

/// Calls use(element) for each element of a list of the root.
template <typename Use>
void for_each(json& root, const char* name, const Use& use) {
  const auto list = root.find(name);
  if (list == root.end()) return;
  for (json& element : *list) use(element);
}

/// Hands the judged JSON to tinygltf without the values that it reads in another way than the loader needs,
/// and puts them into the model.
class Reader {
 public:
  Reader(json& root, const ReadBuffer& read) : read_(read) {
    for_each(root, "buffers", [&](json& buffer) { take_buffer(buffer); });
    for_each(root, "images", [&](json& image) { take_image(image); });
    for_each(root, "bufferViews", [&](json& view) {
      widen(view);
      take_stride(view);
    });
    add_view(root);
    for_each(root, "nodes", keep_priority);
  }

  void set_callbacks(tinygltf::TinyGLTF& reader) {
    tinygltf::FsCallbacks files{};
    files.FileExists = [](const std::string&, void*) { return true; };
    files.ExpandFilePath = [](const std::string& path, void*) { return path; };
    files.ReadWholeFile = [](std::vector<unsigned char>* out, std::string*, const std::string& path,
                             void* self) {
      *out = std::move(buffer_of(path, self));
      if (out->empty()) out->resize(1);
      return true;
    };
    files.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
      return false;
    };
    tell_sizes(files);
    files.user_data = this;
    reader.SetFsCallbacks(files);
  }

  void complete(tinygltf::Model& model) {
    for (std::size_t i = 0; i < buffers_.size(); ++i) {
      model.buffers[i].uri.clear();
      if (is_empty_[i]) model.buffers[i].data.clear();
    }
    for (std::size_t i = 0; i < images_.size(); ++i) {
      model.images[i].uri = std::move(images_[i].uri);
      model.images[i].bufferView = images_[i].view;
    }
    for (std::size_t i = 0; i < strides_.size(); ++i) model.bufferViews[i].byteStride = strides_[i];
    if (no_view_ < 0) return;
    model.bufferViews.pop_back();
    for (tinygltf::Accessor& accessor : model.accessors) {
      if (accessor.bufferView == no_view_) accessor.bufferView = -1;
    }
  }

 private:
  struct Image {
    std::string uri;
    int view;
  };

  static std::vector<std::uint8_t>& buffer_of(const std::string& path, void* self) {
    std::size_t index = 0;
    std::from_chars(path.data(), path.data() + path.size(), index);
    return static_cast<Reader*>(self)->buffers_[index];
  }

  /// tinygltf asks for sizes since version 2.9.
  template <typename Callbacks>
  static void tell_sizes(Callbacks& files) {
    if constexpr (requires { files.GetFileSizeInBytes; }) {
      files.GetFileSizeInBytes = [](std::size_t* size, std::string*, const std::string& path, void* self) {
        *size = std::max<std::size_t>(buffer_of(path, self).size(), 1);
        return true;
      };
    }
  }

  static std::string take_text(json& object, const char* name) {
    return std::move(object[name].get_ref<std::string&>());
  }

  /// tinygltf wants a URI of each buffer and at least one byte, copies data URIs several times, and reads a
  /// '+' of a name as a space. It is given the buffer's index, and asks for the file of this name.
  void take_buffer(json& buffer) {
    std::vector<std::uint8_t> bytes;
    if (buffer.contains("uri"))
      bytes = read_(buffers_.size(), take_text(buffer, "uri"), buffer["byteLength"]);
    buffer["byteLength"] = std::max<std::size_t>(bytes.size(), 1);
    buffer["uri"] = std::to_string(buffers_.size());
    is_empty_.push_back(bytes.empty());
    buffers_.push_back(std::move(bytes));
  }

  /// tinygltf refuses strides that are no multiple of 4 up to 252.
  void take_stride(json& view) {
    strides_.push_back(view.value("byteStride", std::size_t{0}));
    view.erase("byteStride");
  }

  /// tinygltf would read every picture, used or not, one after another, and its bytes without a check of
  /// range.
  void take_image(json& image) {
    images_.push_back({image.contains("uri") ? take_text(image, "uri") : "", image.value("bufferView", -1)});
    image.erase("bufferView");
    image["uri"] = std::to_string(images_.size());
  }

  /// tinygltf cuts the whole numbers of extensions to 32 bits, but not the others.
  static void widen(json& view) {
    const auto extensions = view.find("extensions");
    if (extensions == view.end()) return;
    for (const char* extension : kMeshoptNames) {
      if (!extensions->contains(extension)) continue;
      json& meshopt = (*extensions)[extension];
      for (const char* name : {"byteOffset", "byteLength"}) {
        if (meshopt.contains(name)) meshopt[name] = meshopt[name].get<double>();
      }
    }
  }

  /// tinygltf refuses indices without a buffer view. Accessors without one get an additional view.
  void add_view(json& root) {
    for_each(root, "accessors", [&](json& accessor) {
      if (accessor.contains("bufferView")) return;
      no_view_ = root.contains("bufferViews") ? static_cast<int>(root["bufferViews"].size()) : 0;
      accessor["bufferView"] = no_view_;
    });
    if (no_view_ >= 0) root["bufferViews"].push_back({{"buffer", 0u}, {"byteLength", 1u}});
  }

  /// Of an application's own values only this one is read. One that is no number is kept as its text, for the
  /// message.
  static void keep_priority(json& node) {
    constexpr const char* kName = "dielectric_priority";
    const auto extras = node.find("extras");
    if (extras == node.end()) return;
    json kept = json::object();
    if (extras->is_object() && extras->contains(kName)) {
      const json& value = (*extras)[kName];
      if (value.is_number()) {
        kept[kName] = value.get<double>();
      } else {
        kept[kName] = value.dump(-1, ' ', true, json::error_handler_t::replace);
      }
    }
    *extras = std::move(kept);
  }

  const ReadBuffer& read_;
  std::vector<std::vector<std::uint8_t>> buffers_;  ///< until tinygltf has taken them
  std::vector<bool> is_empty_;
  std::vector<std::size_t> strides_;
  std::vector<Image> images_;
  int no_view_ = -1;
};

}  // namespace

std::size_t model_bytes(const json& root) {
  std::size_t bytes = 0;
  tinygltf::Model model;
  for_each_list(root, model,
                [&]<typename T>(std::size_t count, const std::vector<T>&) { bytes += count * sizeof(T); });
  return bytes;
}

tinygltf::Model read_model(json&& root, std::string_view file, const ReadBuffer& read) {
  Reader reader(root, read);
  tinygltf::Model model;
  // tinygltf appends one by one. Moving its large elements to another place would double the memory.
  for_each_list(root, model, [](std::size_t count, auto& elements) { elements.reserve(count); });
  tinygltf::TinyGLTF parser;
  reader.set_callbacks(parser);
  std::string error;
  if (!load_json(parser, std::move(root), model, error))
    throw make_error(file, "JSON", fmt::format("{}, expected glTF 2.0", one_line(error)));
  reader.complete(model);
  return model;
}

}  // namespace gatelight::scene::gltf
