/* What the competitor needs of the public C interface of Embree 4 (4.1 to 4.4), declared from its documentation: the Python wheel
 * `embreex` brings the shared library without headers. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>
#ifdef __cplusplus
extern "C" {
#endif

typedef struct RTCDeviceTy *RTCDevice;
typedef struct RTCSceneTy *RTCScene;
typedef struct RTCGeometryTy *RTCGeometry;

enum { RTC_GEOMETRY_TYPE_TRIANGLE = 0 };
enum { RTC_BUFFER_TYPE_INDEX = 0, RTC_BUFFER_TYPE_VERTEX = 1 };
enum { RTC_FORMAT_UINT3 = 0x5003, RTC_FORMAT_FLOAT3 = 0x9003 };
enum { RTC_BUILD_QUALITY_MEDIUM = 1, RTC_BUILD_QUALITY_HIGH = 2 };
enum { RTC_SCENE_FLAG_NONE = 0, RTC_SCENE_FLAG_COMPACT = 2, RTC_SCENE_FLAG_ROBUST = 4 };
enum { RTC_RAY_QUERY_FLAG_INCOHERENT = 0, RTC_RAY_QUERY_FLAG_COHERENT = 1 << 16 };
enum { RTC_FEATURE_FLAG_ALL = (int)0xffffffff };
#define RTC_INVALID_GEOMETRY_ID 0xffffffffu

struct __attribute__((aligned(16))) RTCRay {
  float org_x, org_y, org_z, tnear, dir_x, dir_y, dir_z, time, tfar;
  unsigned mask, id, flags;
};
struct __attribute__((aligned(16))) RTCHit {
  float Ng_x, Ng_y, Ng_z, u, v;
  unsigned primID, geomID, instID[1], instPrimID[1];
};
struct __attribute__((aligned(16))) RTCRayHit {
  struct RTCRay ray;
  struct RTCHit hit;
};

#define PACKET(N)                                                                                                                  \
  struct __attribute__((aligned(4 * N))) RTCRay##N {                                                                               \
    float org_x[N], org_y[N], org_z[N], tnear[N], dir_x[N], dir_y[N], dir_z[N], time[N], tfar[N];                                  \
    unsigned mask[N], id[N], flags[N];                                                                                             \
  };                                                                                                                               \
  struct __attribute__((aligned(4 * N))) RTCHit##N {                                                                               \
    float Ng_x[N], Ng_y[N], Ng_z[N], u[N], v[N];                                                                                   \
    unsigned primID[N], geomID[N], instID[1][N], instPrimID[1][N];                                                                 \
  };                                                                                                                               \
  struct __attribute__((aligned(4 * N))) RTCRayHit##N {                                                                            \
    struct RTCRay##N ray;                                                                                                          \
    struct RTCHit##N hit;                                                                                                          \
  };
PACKET(8)
PACKET(16)
#undef PACKET

struct RTCIntersectArguments {
  int flags, feature_mask;
  void *context, *filter, *intersect;
};
struct RTCOccludedArguments {
  int flags, feature_mask;
  void *context, *filter, *occluded;
};

RTCDevice rtcNewDevice(const char *config);
void rtcReleaseDevice(RTCDevice device);
typedef bool (*RTCMemoryMonitorFunction)(void *user, ssize_t bytes, bool post);
void rtcSetDeviceMemoryMonitorFunction(RTCDevice device, RTCMemoryMonitorFunction monitor, void *user);
RTCScene rtcNewScene(RTCDevice device);
void rtcReleaseScene(RTCScene scene);
void rtcSetSceneBuildQuality(RTCScene scene, int quality);
void rtcSetSceneFlags(RTCScene scene, int flags);
void rtcCommitScene(RTCScene scene);
RTCGeometry rtcNewGeometry(RTCDevice device, int type);
void *rtcSetNewGeometryBuffer(RTCGeometry geometry, int type, unsigned slot, int format, size_t stride, size_t count);
void rtcCommitGeometry(RTCGeometry geometry);
unsigned rtcAttachGeometry(RTCScene scene, RTCGeometry geometry);
void rtcReleaseGeometry(RTCGeometry geometry);
void rtcIntersect1(RTCScene scene, struct RTCRayHit *ray, struct RTCIntersectArguments *arguments);
void rtcIntersect8(const int *valid, RTCScene scene, struct RTCRayHit8 *rays, struct RTCIntersectArguments *arguments);
void rtcIntersect16(const int *valid, RTCScene scene, struct RTCRayHit16 *rays, struct RTCIntersectArguments *arguments);
void rtcOccluded1(RTCScene scene, struct RTCRay *ray, struct RTCOccludedArguments *arguments);
void rtcOccluded8(const int *valid, RTCScene scene, struct RTCRay8 *rays, struct RTCOccludedArguments *arguments);
void rtcOccluded16(const int *valid, RTCScene scene, struct RTCRay16 *rays, struct RTCOccludedArguments *arguments);

#ifdef __cplusplus
}
#endif
