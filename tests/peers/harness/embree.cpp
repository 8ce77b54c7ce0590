// Embree 4 as a competitor.
//
// A variant is a packet width (1, 8 or 16) and what is joined to it by '-':
//  coh          rays of a packet go the same way
//  f256, f512   wide vectors and the wider tree; Embree takes 128 bits on some processors unless it is told otherwise
//  robust       no ray slips between neighbouring triangles
//  medium       builds faster, as a tree without spatial splits; all others build with the highest quality
#include "embree4.h"
#include "peer.h"
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

struct Embree {
  RTCDevice device;
  RTCScene scene;
  int width, flags;
  std::atomic<long> bytes{0};
};

static bool count_bytes(void *embree, ssize_t bytes, bool) {
  static_cast<Embree *>(embree)->bytes += bytes;
  return true;
}

extern "C" const char *peer_variants() { return "8-coh-f256 16-coh-f512 1-f256 1 1-robust 1-robust-f256 1-medium"; }

extern "C" void *peer_build(const char *variant, const float *vertices, uint32_t vertex_count, const uint32_t *indices,
                            uint32_t triangle_count, int threads) {
  const std::string name = variant;
  auto has = [&](const char *part) { return name.find(part) != name.npos; };
  auto *embree = new Embree;
  embree->width = atoi(variant);
  embree->flags = has("-coh") ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  if (embree->width != 1 && embree->width != 8 && embree->width != 16) {
    delete embree;
    return nullptr;
  }
  const char *vectors = has("-f512") ? ",frequency_level=simd512" : has("-f256") ? ",frequency_level=simd256" : "";
  char config[128];
  snprintf(config, sizeof config, "threads=%d,user_threads=%d,set_affinity=0%s", threads, threads, vectors);
  embree->device = rtcNewDevice(config);
  rtcSetDeviceMemoryMonitorFunction(embree->device, count_bytes, embree);
  embree->scene = rtcNewScene(embree->device);
  rtcSetSceneBuildQuality(embree->scene, has("-medium") ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_HIGH);
  rtcSetSceneFlags(embree->scene, has("-robust") ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);

  RTCGeometry geometry = rtcNewGeometry(embree->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, vertex_count), vertices,
         12 * size_t(vertex_count));
  memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangle_count), indices,
         12 * size_t(triangle_count));
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(embree->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(embree->scene);
  return embree;
}

static void fill(RTCRay &to, const PeerRay &from) {
  to.org_x = from.ox, to.org_y = from.oy, to.org_z = from.oz, to.tnear = from.tmin;
  to.dir_x = from.dx, to.dir_y = from.dy, to.dir_z = from.dz, to.tfar = from.tmax;
  to.time = 0, to.mask = ~0u, to.id = 0, to.flags = 0;
}

static RTCHit no_hit() {
  RTCHit hit{};
  hit.geomID = hit.primID = hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return hit;
}

static PeerHit hit_of(float t, unsigned geometry, unsigned triangle, float u, float v) {
  return {t, geometry == RTC_INVALID_GEOMETRY_ID ? UINT32_MAX : triangle, u, v};
}

static void closest1(const Embree &embree, const PeerRay *rays, size_t n, PeerHit *hits) {
  RTCIntersectArguments arguments{embree.flags, RTC_FEATURE_FLAG_ALL, nullptr, nullptr, nullptr};
  for (size_t i = 0; i < n; i++) {
    RTCRayHit r;
    fill(r.ray, rays[i]);
    r.hit = no_hit();
    rtcIntersect1(embree.scene, &r, &arguments);
    hits[i] = hit_of(r.ray.tfar, r.hit.geomID, r.hit.primID, r.hit.u, r.hit.v);
  }
}

static void any1(const Embree &embree, const PeerRay *rays, size_t n, uint8_t *occluded) {
  RTCOccludedArguments arguments{embree.flags, RTC_FEATURE_FLAG_ALL, nullptr, nullptr, nullptr};
  for (size_t i = 0; i < n; i++) {
    RTCRay r;
    fill(r, rays[i]);
    rtcOccluded1(embree.scene, &r, &arguments);
    occluded[i] = r.tfar < 0;
  }
}

// Rays of a packet, the last repeated where there are fewer than N; `valid` is -1 for each that counts.
template <int N, class Rays> static int fill_packet(Rays &to, int *valid, const PeerRay *rays, size_t left) {
  const int count = int(std::min<size_t>(N, left));
  for (int k = 0; k < N; k++) {
    const PeerRay &from = rays[std::min(k, count - 1)];
    valid[k] = k < count ? -1 : 0;
    to.org_x[k] = from.ox, to.org_y[k] = from.oy, to.org_z[k] = from.oz, to.tnear[k] = from.tmin;
    to.dir_x[k] = from.dx, to.dir_y[k] = from.dy, to.dir_z[k] = from.dz, to.tfar[k] = from.tmax;
    to.time[k] = 0, to.mask[k] = ~0u, to.id[k] = 0, to.flags[k] = 0;
  }
  return count;
}

template <int N, class RaysAndHits>
static void closest_packets(const Embree &embree, const PeerRay *rays, size_t n, PeerHit *hits,
                            void (*intersect)(const int *, RTCScene, RaysAndHits *, RTCIntersectArguments *)) {
  RTCIntersectArguments arguments{embree.flags, RTC_FEATURE_FLAG_ALL, nullptr, nullptr, nullptr};
  for (size_t i = 0; i < n; i += N) {
    RaysAndHits r;
    alignas(64) int valid[N];
    const int count = fill_packet<N>(r.ray, valid, rays + i, n - i);
    for (int k = 0; k < N; k++) r.hit.geomID[k] = r.hit.primID[k] = r.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    intersect(valid, embree.scene, &r, &arguments);
    for (int k = 0; k < count; k++) hits[i + k] = hit_of(r.ray.tfar[k], r.hit.geomID[k], r.hit.primID[k], r.hit.u[k], r.hit.v[k]);
  }
}

template <int N, class Rays>
static void any_packets(const Embree &embree, const PeerRay *rays, size_t n, uint8_t *occluded,
                        void (*intersect)(const int *, RTCScene, Rays *, RTCOccludedArguments *)) {
  RTCOccludedArguments arguments{embree.flags, RTC_FEATURE_FLAG_ALL, nullptr, nullptr, nullptr};
  for (size_t i = 0; i < n; i += N) {
    Rays r;
    alignas(64) int valid[N];
    const int count = fill_packet<N>(r, valid, rays + i, n - i);
    intersect(valid, embree.scene, &r, &arguments);
    for (int k = 0; k < count; k++) occluded[i + k] = r.tfar[k] < 0;
  }
}

extern "C" void peer_closest(void *peer, const PeerRay *rays, size_t n, PeerHit *hits) {
  const auto &embree = *static_cast<Embree *>(peer);
  switch (embree.width) {
  case 8: return closest_packets<8>(embree, rays, n, hits, rtcIntersect8);
  case 16: return closest_packets<16>(embree, rays, n, hits, rtcIntersect16);
  default: return closest1(embree, rays, n, hits);
  }
}

extern "C" void peer_any(void *peer, const PeerRay *rays, size_t n, uint8_t *occluded) {
  const auto &embree = *static_cast<Embree *>(peer);
  switch (embree.width) {
  case 8: return any_packets<8>(embree, rays, n, occluded, rtcOccluded8);
  case 16: return any_packets<16>(embree, rays, n, occluded, rtcOccluded16);
  default: return any1(embree, rays, n, occluded);
  }
}

extern "C" size_t peer_bytes(void *peer) { return size_t(static_cast<Embree *>(peer)->bytes); }

extern "C" void peer_free(void *peer) {
  auto *embree = static_cast<Embree *>(peer);
  rtcReleaseScene(embree->scene);
  rtcReleaseDevice(embree->device);
  delete embree;
}
