#pragma once
// Whether a file is as it was written: a digest over all that it holds, in its metadata.

#include <string>
#include <vector>

#include "neural/file/safetensors.h"

namespace gatelight::neural {

/// Of the metadata.
inline constexpr const char* kDigestKey = "digest";

/// 32 hexadecimal digits over the names and bytes of all tensors and over the metadata, but for the digest
/// itself. Against damage, not against forgery.
std::string content_digest(std::vector<TensorView> tensors, const Metadata& metadata);

/// Throws CacheFileError unless the file holds the digest of its content.
void expect_digest(SafetensorsReader& file);

}  // namespace gatelight::neural
