// The sets of rays of a mesh.
//
//  primscan  a pinhole camera of 1024 by 1024 pixels, row by row
//  primtile  the same rays, in tiles of 8 by 8 pixels
//  shadow    towards one directional light, from the primary hits that face it, in tile order; asked whether anything is hit
//  reflect   mirrored at every primary hit, in tile order
//  random    from uniform points in the object's box in uniform directions
//
// Secondary rays start LIFT of the object's diagonal above the surface, on the side of the eye.
#pragma once
#include "competitor.hpp"
#include <algorithm>
#include <cmath>
#include <random>

struct Vec {
  float x, y, z;
};
inline Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator*(Vec a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline float dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline Vec unit(Vec a) { return a * (1.0f / std::sqrt(dot(a, a))); }

inline PeerRay unbounded(Vec origin, Vec direction) {
  return {origin.x, origin.y, origin.z, 0, direction.x, direction.y, direction.z, INFINITY};
}

inline Vec corner(const Mesh &mesh, size_t triangle, int k) {
  const float *p = &mesh.vertices[3 * size_t(mesh.indices[3 * triangle + k])];
  return {p[0], p[1], p[2]};
}

constexpr float PI = 3.14159265358979f;
constexpr int PIXELS = 1024, TILE = 8;
constexpr float VIEW_DEGREES = 42;
constexpr float LIFT = 1e-4f;

// The axis that the ground does not extend along.
inline int up_axis(const Mesh &mesh) {
  const size_t ground = mesh.triangle_count - 1;
  const Vec a = corner(mesh, ground, 0), b = corner(mesh, ground, 1), c = corner(mesh, ground, 2);
  return a.x == b.x && a.x == c.x ? 0 : a.y == b.y && a.y == c.y ? 1 : 2;
}

class Viewpoint {
public:
  explicit Viewpoint(const Mesh &mesh) : up_(up_axis(mesh)) {
    if (mesh.triangle_count < 3) fail("a mesh needs triangles beside its ground");
    // Of the object: the ground's four vertices are the last.
    for (size_t k = 0; k + 4 < mesh.vertex_count; k++) {
      const float *p = &mesh.vertices[3 * k];
      low = {std::min(low.x, p[0]), std::min(low.y, p[1]), std::min(low.z, p[2])};
      high = {std::max(high.x, p[0]), std::max(high.y, p[1]), std::max(high.z, p[2])};
    }
    diagonal = std::sqrt(dot(high - low, high - low));
    const Vec middle = (low + high) * 0.5f;
    eye = middle + unit(turned(0.55f, -0.8f, 0.42f)) * (0.85f * diagonal);
    light = unit(turned(0.45f, -0.35f, 0.8f));
    forward_ = unit(middle - eye);
    right_ = unit(cross(forward_, turned(0, 0, 1)));
    above_ = cross(right_, forward_);
  }

  PeerRay pixel(int column, int row) const {
    const float slope = std::tan(0.5f * VIEW_DEGREES * PI / 180);
    const float x = slope * (2 * (column + 0.5f) / PIXELS - 1), y = slope * (1 - 2 * (row + 0.5f) / PIXELS);
    return unbounded(eye, unit(forward_ + right_ * x + above_ * y));
  }

  Vec low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  float diagonal;
  Vec eye, light;

private:
  // A vector given as if z were up.
  Vec turned(float a, float b, float up) const { return up_ == 2 ? Vec{a, b, up} : up_ == 1 ? Vec{b, up, a} : Vec{up, a, b}; }

  int up_;
  Vec forward_, right_, above_;
};

inline std::vector<PeerRay> random_rays(const Viewpoint &view) {
  std::mt19937 generator(12345);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<PeerRay> rays;
  for (int k = 0; k < PIXELS * PIXELS; k++) {
    Vec origin;
    origin.x = view.low.x + (view.high.x - view.low.x) * uniform(generator);
    origin.y = view.low.y + (view.high.y - view.low.y) * uniform(generator);
    origin.z = view.low.z + (view.high.z - view.low.z) * uniform(generator);
    const float z = 2 * uniform(generator) - 1, angle = 2 * PI * uniform(generator), ring = std::sqrt(std::max(0.0f, 1 - z * z));
    rays.push_back(unbounded(origin, {ring * std::cos(angle), ring * std::sin(angle), z}));
  }
  return rays;
}

// Writes the five sets as PREFIX.SET.rays; `guide` finds the primary hits.
inline void make_rays(const Mesh &mesh, const std::string &prefix, Competitor &guide) {
  const Viewpoint view(mesh);
  std::vector<PeerRay> scan, tiled, shadow, reflect;
  for (int row = 0; row < PIXELS; row++)
    for (int column = 0; column < PIXELS; column++) scan.push_back(view.pixel(column, row));
  for (int top = 0; top < PIXELS; top += TILE)
    for (int left = 0; left < PIXELS; left += TILE)
      for (int row = 0; row < TILE; row++)
        for (int column = 0; column < TILE; column++) tiled.push_back(scan[size_t(top + row) * PIXELS + left + column]);

  guide.build(mesh, 1);
  std::vector<PeerHit> hits(tiled.size());
  guide.closest(tiled.data(), tiled.size(), hits.data());
  guide.release();
  for (size_t k = 0; k < tiled.size(); k++) {
    if (hits[k].prim == UINT32_MAX) continue;
    const Vec a = corner(mesh, hits[k].prim, 0), b = corner(mesh, hits[k].prim, 1), c = corner(mesh, hits[k].prim, 2);
    const Vec direction{tiled[k].dx, tiled[k].dy, tiled[k].dz};
    Vec normal = unit(cross(b - a, c - a));
    if (!(dot(normal, normal) > 0.5f)) continue; // too thin for a normal
    if (dot(normal, direction) > 0) normal = normal * -1;
    const Vec start = view.eye + direction * hits[k].t + normal * (LIFT * view.diagonal);
    if (dot(normal, view.light) > 0) shadow.push_back(unbounded(start, view.light));
    reflect.push_back(unbounded(start, direction - normal * (2 * dot(normal, direction))));
  }
  if (shadow.empty() || reflect.empty()) fail(prefix + ": the camera sees nothing that is lit");
  write_rays(prefix + ".primscan.rays", scan);
  write_rays(prefix + ".primtile.rays", tiled);
  write_rays(prefix + ".shadow.rays", shadow);
  write_rays(prefix + ".reflect.rays", reflect);
  write_rays(prefix + ".random.rays", random_rays(view));
}
