// Meshes and rays in files.
//
// A mesh file, little-endian: "TRIM", u32 vertices, u32 triangles, then three f32 a vertex and three u32 a triangle. The last two
// triangles are a ground plane across the up axis.
#pragma once
#include "peer.h"
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

[[noreturn]] inline void fail(const std::string &what) {
  fprintf(stderr, "race: %s\n", what.c_str());
  exit(1);
}

struct Mesh {
  std::vector<float> vertices;
  std::vector<uint32_t> indices;
  uint32_t vertex_count = 0, triangle_count = 0;
};

inline Mesh read_mesh(const std::string &path) {
  FILE *file = fopen(path.c_str(), "rb");
  if (!file) fail(path + ": cannot be opened");
  char magic[4];
  uint32_t counts[2];
  if (fread(magic, 1, 4, file) != 4 || memcmp(magic, "TRIM", 4) || fread(counts, 4, 2, file) != 2) fail(path + ": is no mesh file");
  Mesh mesh;
  mesh.vertex_count = counts[0];
  mesh.triangle_count = counts[1];
  const size_t floats = 3 * size_t(counts[0]), numbers = 3 * size_t(counts[1]);
  // One vertex more than there are: Embree reads 16 bytes of each.
  mesh.vertices.resize(floats + 4);
  mesh.indices.resize(numbers);
  if (fread(mesh.vertices.data(), 4, floats, file) != floats || fread(mesh.indices.data(), 4, numbers, file) != numbers)
    fail(path + ": ends early");
  for (uint32_t k : mesh.indices)
    if (k >= mesh.vertex_count) fail(path + ": names a vertex that does not exist");
  fclose(file);
  return mesh;
}

// The rays of a set. `wide` is empty unless the set has origins in f64; `rays` are then the same, rounded.
struct RaySet {
  std::vector<PeerRay> rays;
  std::vector<PeerRay64> wide;
};

template <class Ray> std::vector<Ray> read_array(const std::string &path) {
  FILE *file = fopen(path.c_str(), "rb");
  if (!file) fail(path + ": cannot be opened");
  fseek(file, 0, SEEK_END);
  std::vector<Ray> rays(size_t(ftell(file)) / sizeof(Ray));
  rewind(file);
  if (fread(rays.data(), sizeof(Ray), rays.size(), file) != rays.size()) fail(path + ": ends early");
  fclose(file);
  return rays;
}

// A file PREFIX.rays holds PeerRay, a file PREFIX.rays64 holds PeerRay64. A rounded origin may lie behind the surface that it leaves:
// `lift` is the tmin of rays that are rounded, as renderers in f32 have it.
inline RaySet read_rays(const std::string &path, float lift) {
  RaySet set;
  const std::string end = ".rays64";
  if (path.size() < end.size() || path.compare(path.size() - end.size(), end.size(), end) != 0) {
    set.rays = read_array<PeerRay>(path);
    return set;
  }
  set.wide = read_array<PeerRay64>(path);
  for (const PeerRay64 &r : set.wide)
    set.rays.push_back({float(r.ox), float(r.oy), float(r.oz), r.tmin + lift, r.dx, r.dy, r.dz, r.tmax});
  return set;
}

// Whole or not at all: a run that is stopped must not leave half a file to the next one.
inline void write_rays(const std::string &path, const std::vector<PeerRay> &rays) {
  const std::string part = path + ".part";
  FILE *file = fopen(part.c_str(), "wb");
  if (!file || fwrite(rays.data(), sizeof(PeerRay), rays.size(), file) != rays.size() || fclose(file) != 0 ||
      rename(part.c_str(), path.c_str()) != 0)
    fail(path + ": cannot be written");
}
