#pragma once
// The functions that are called of Open Image Denoise 2 (Apache-2.0, Intel), which is loaded at run time.
// Names, types and values are those of its C interface, "OpenImageDenoise/oidn.h", which is stable within
// version 2 and described in "Open Image Denoise API" of its documentation.

#include <cstddef>

namespace gatelight::renderer::oidn {

using Device = struct DeviceHandle*;
using Filter = struct FilterHandle*;

inline constexpr int kCpuDevice = 1;    // OIDN_DEVICE_TYPE_CPU
inline constexpr int kFloat3 = 3;       // OIDN_FORMAT_FLOAT3
inline constexpr int kNoError = 0;      // OIDN_ERROR_NONE
inline constexpr int kOutOfMemory = 4;  // OIDN_ERROR_OUT_OF_MEMORY
inline constexpr int kCancelled = 6;    // OIDN_ERROR_CANCELLED
inline constexpr int kFast = 4;         // OIDN_QUALITY_FAST
inline constexpr int kHigh = 6;         // OIDN_QUALITY_HIGH

/// Called with 0 to 1; false cancels the filter.
using ProgressMonitor = bool (*)(void* user, double progress);

/// Each member is the function "oidn" + its name. Enumerations are passed as int.
struct Api {
  Device (*NewDevice)(int type);
  void (*SetDeviceBool)(Device, const char* name, bool value);
  void (*SetDeviceInt)(Device, const char* name, int value);
  int (*GetDeviceInt)(Device, const char* name);
  void (*CommitDevice)(Device);
  int (*GetDeviceError)(Device, const char** message);
  void (*ReleaseDevice)(Device);
  Filter (*NewFilter)(Device, const char* type);
  /// Offset and strides are in bytes; a stride of 0 is that of packed pixels.
  void (*SetSharedFilterImage)(Filter, const char* name, void* pixels, int format, std::size_t width,
                               std::size_t height, std::size_t offset, std::size_t pixel_stride,
                               std::size_t row_stride);
  void (*SetFilterBool)(Filter, const char* name, bool value);
  void (*SetFilterInt)(Filter, const char* name, int value);
  void (*SetFilterFloat)(Filter, const char* name, float value);
  void (*SetFilterProgressMonitorFunction)(Filter, ProgressMonitor, void* user);
  void (*CommitFilter)(Filter);
  void (*ExecuteFilter)(Filter);
  void (*ReleaseFilter)(Filter);
};

}  // namespace gatelight::renderer::oidn
