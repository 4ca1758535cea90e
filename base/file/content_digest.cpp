#include "base/file/content_digest.h"

#include <algorithm>
#include <span>

#include "base/file/digest.h"

namespace gatelight {

namespace {

class ContentDigest {
 public:
  void add_tensor(const std::string& name) { record_.add_text(name); }
  void add_bytes(std::span<const std::byte> piece) { record_.add(digest_of(piece)); }
  std::string finish(const Metadata& metadata) {
    for (const auto& [key, text] : metadata) {
      if (key == kDigestKey) continue;
      record_.add_text(key);
      record_.add_text(text);
    }
    return hexadecimal(record_.digest());
  }

 private:
  DigestRecord record_;
};

}  // namespace

std::string content_digest(std::vector<TensorView> tensors, const Metadata& metadata) {
  std::sort(tensors.begin(), tensors.end(),
            [](const TensorView& a, const TensorView& b) { return a.name < b.name; });
  ContentDigest digest;
  for (const TensorView& tensor : tensors) {
    digest.add_tensor(tensor.name);
    for (std::size_t at = 0; at < tensor.data.size(); at += SafetensorsReader::kPieceBytes)
      digest.add_bytes(
          tensor.data.subspan(at, std::min(SafetensorsReader::kPieceBytes, tensor.data.size() - at)));
  }
  return digest.finish(metadata);
}

void expect_digest(SafetensorsReader& file) {
  const auto found = file.metadata().find(kDigestKey);
  if (found == file.metadata().end()) file.fail("metadata 'digest' is missing");
  ContentDigest digest;
  for (const std::string& name : file.names()) {  // sorted by name
    digest.add_tensor(name);
    file.read_in_pieces(name, [&](std::span<const std::byte> piece) { digest.add_bytes(piece); });
  }
  if (digest.finish(file.metadata()) != found->second) file.fail("it is damaged: its digest is another");
}

}  // namespace gatelight
