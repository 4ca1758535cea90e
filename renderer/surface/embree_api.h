#pragma once
// Embree 3.13 or 4, whichever is installed: what their interfaces have by different names.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace gatelight::renderer {

#if RTC_VERSION_MAJOR >= 4

/// What the rays of one query share. Filters get the address of `context`.
struct EmbreeQuery {
  RTCRayQueryContext context;
  RTCRayQueryFlags flags;

  explicit EmbreeQuery(bool coherent)
      : flags(coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT) {
    rtcInitRayQueryContext(&context);
  }

  void intersect(RTCScene scene, RTCRayHit& ray) {
    RTCIntersectArguments arguments = intersect_arguments();
    rtcIntersect1(scene, &ray, &arguments);
  }
  void intersect(const int* valid, RTCScene scene, RTCRayHit16& rays) {
    RTCIntersectArguments arguments = intersect_arguments();
    rtcIntersect16(valid, scene, &rays, &arguments);
  }
  void occluded(RTCScene scene, RTCRay& ray) {
    RTCOccludedArguments arguments = occluded_arguments();
    rtcOccluded1(scene, &ray, &arguments);
  }
  void occluded(const int* valid, RTCScene scene, RTCRay16& rays) {
    RTCOccludedArguments arguments = occluded_arguments();
    rtcOccluded16(valid, scene, &rays, &arguments);
  }

 private:
  RTCIntersectArguments intersect_arguments() {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = flags;
    arguments.context = &context;
    return arguments;
  }
  RTCOccludedArguments occluded_arguments() {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = flags;
    arguments.context = &context;
    return arguments;
  }
};

#else

/// What the rays of one query share. Filters get the address of `context`.
struct EmbreeQuery {
  RTCIntersectContext context;

  explicit EmbreeQuery(bool coherent) {
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }

  void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &context, &ray); }
  void intersect(const int* valid, RTCScene scene, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &context, &rays);
  }
  void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &context, &ray); }
  void occluded(const int* valid, RTCScene scene, RTCRay16& rays) {
    rtcOccluded16(valid, scene, &context, &rays);
  }
};

#endif

}  // namespace gatelight::renderer
