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

inline std::vector<PeerRay> read_rays(const std::string &path) {
  FILE *file = fopen(path.c_str(), "rb");
  if (!file) fail(path + ": cannot be opened");
  fseek(file, 0, SEEK_END);
  std::vector<PeerRay> rays(size_t(ftell(file)) / sizeof(PeerRay));
  rewind(file);
  if (fread(rays.data(), sizeof(PeerRay), rays.size(), file) != rays.size()) fail(path + ": ends early");
  fclose(file);
  return rays;
}

// Whole or not at all: a run that is stopped must not leave half a file to the next one.
inline void write_rays(const std::string &path, const std::vector<PeerRay> &rays) {
  const std::string part = path + ".part";
  FILE *file = fopen(part.c_str(), "wb");
  if (!file || fwrite(rays.data(), sizeof(PeerRay), rays.size(), file) != rays.size() || fclose(file) != 0 ||
      rename(part.c_str(), path.c_str()) != 0)
    fail(path + ": cannot be written");
}
