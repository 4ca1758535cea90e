#pragma once
// A digest of a file's content, stored in its metadata, which detects damage.

#include <string>
#include <vector>

#include "base/file/safetensors.h"

namespace gatelight {

/// The digest's key in the metadata.
inline constexpr const char* kDigestKey = "digest";

/// A digest of all tensors' names and bytes and of the metadata except the digest, 32 hexadecimal digits. It
/// detects damage, not forgery.
std::string content_digest(std::vector<TensorView> tensors, const Metadata& metadata);

/// Throws CacheFileError unless the stored digest matches the file's content.
void expect_digest(SafetensorsReader& file);

}  // namespace gatelight
