// A library with the names that Gatelight calls of Open Image Denoise, which denoises nothing. It reports the
// version GATELIGHT_STAND_IN_VERSION.

#include <cstring>

namespace {
int device = 0;
}

extern "C" {
void* oidnNewDevice(int) {
  return &device;
}
void oidnSetDeviceBool(void*, const char*, bool) {}
void oidnSetDeviceInt(void*, const char*, int) {}
int oidnGetDeviceInt(void*, const char* name) {
  constexpr int kVersion[] = {GATELIGHT_STAND_IN_VERSION};
  if (std::strcmp(name, "versionMajor") == 0) return kVersion[0];
  return std::strcmp(name, "versionMinor") == 0 ? kVersion[1] : kVersion[2];
}
void oidnCommitDevice(void*) {}
int oidnGetDeviceError(void*, const char**) {
  return 0;
}
void oidnReleaseDevice(void*) {}
void* oidnNewFilter(void*, const char*) {
  return &device;
}
void oidnSetSharedFilterImage() {}
void oidnSetFilterBool() {}
void oidnSetFilterInt() {}
void oidnSetFilterFloat() {}
void oidnSetFilterProgressMonitorFunction() {}
void oidnCommitFilter(void*) {}
void oidnExecuteFilter(void*) {}
void oidnReleaseFilter(void*) {}
}
