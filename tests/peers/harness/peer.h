/* The C interface between the peers bench and one competitor, a shared library.
 *
 * Rays come in file order, so a competitor may treat neighbours as packets. Nothing may be remembered from one call to the next but
 * memory. The threads that call have flush-to-zero and denormals-are-zero set, as Embree recommends. */
#pragma once
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

/* Ray files are arrays of these, little-endian, without a header. */
typedef struct {
  float ox, oy, oz, tmin;
  float dx, dy, dz, tmax;
} PeerRay;

/* A ray as gz has it, for those who can use it: the origin in f64, and the triangle that the ray leaves, 0xffffffff for none. */
typedef struct {
  double ox, oy, oz;
  float tmin, dx, dy, dz, tmax;
  uint32_t leaves;
} PeerRay64;

/* A miss has prim 0xffffffff. */
typedef struct {
  float t;
  uint32_t prim;
  float u, v;
} PeerHit;

/* Names of the variants, separated by spaces. */
const char *peer_variants(void);

/* Builds what answers rays, on at most `threads` threads. Null for a variant or mesh that is refused. Vertices and indices stay where
 * they are until peer_free. */
void *peer_build(const char *variant, const float *vertices, uint32_t vertex_count, const uint32_t *indices, uint32_t triangle_count,
                 int threads);

/* The front-most hit of each of n rays; both sides of a triangle count. Called from several threads at once. */
void peer_closest(void *peer, const PeerRay *rays, size_t n, PeerHit *hits);

/* 1 for each ray that hits anything, else 0. */
void peer_any(void *peer, const PeerRay *rays, size_t n, uint8_t *occluded);

/* The same questions about rays of the other kind. Optional: who does not have them is asked about rays with origins rounded to f32. */
void peer_closest64(void *peer, const PeerRay64 *rays, size_t n, PeerHit *hits);
void peer_any64(void *peer, const PeerRay64 *rays, size_t n, uint8_t *occluded);

/* Bytes of the structure, 0 where that is unknown. */
size_t peer_bytes(void *peer);

void peer_free(void *peer);

#ifdef __cplusplus
}
#endif
