// A competitor: a shared library with the interface of peer.h, and one of its variants.
#pragma once
#include "files.hpp"
#include <dlfcn.h>

class Competitor {
public:
  // `what` is LIBRARY.so:VARIANT. The name is that of the library without folder, "lib" and ".so", and the variant.
  explicit Competitor(const std::string &what) {
    const size_t colon = what.rfind(':');
    if (colon == what.npos) fail(what + ": is not LIBRARY.so:VARIANT");
    const std::string path = what.substr(0, colon);
    variant_ = what.substr(colon + 1);
    void *library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) fail(dlerror());
    load(library, build_, "peer_build");
    load(library, closest_, "peer_closest");
    load(library, any_, "peer_any");
    load(library, bytes_, "peer_bytes");
    load(library, free_, "peer_free");
    closest64_ = reinterpret_cast<decltype(closest64_)>(dlsym(library, "peer_closest64"));
    any64_ = reinterpret_cast<decltype(any64_)>(dlsym(library, "peer_any64"));
    std::string stem = path.substr(path.rfind('/') + 1);
    stem = stem.substr(0, stem.rfind(".so"));
    name_ = (stem.rfind("lib", 0) == 0 ? stem.substr(3) : stem) + ":" + variant_;
  }

  void build(const Mesh &mesh, int threads) {
    peer_ = build_(variant_.c_str(), mesh.vertices.data(), mesh.vertex_count, mesh.indices.data(), mesh.triangle_count, threads);
    if (!peer_) fail(name_ + ": builds nothing");
  }
  void closest(const PeerRay *rays, size_t n, PeerHit *hits) const { closest_(peer_, rays, n, hits); }
  // Rays `first` to `first + n` of a set, which this competitor may want in one form or the other.
  void closest(const RaySet &rays, size_t first, size_t n, PeerHit *hits) const {
    if (closest64_ && !rays.wide.empty()) closest64_(peer_, &rays.wide[first], n, hits);
    else closest_(peer_, &rays.rays[first], n, hits);
  }
  void any(const RaySet &rays, size_t first, size_t n, uint8_t *occluded) const {
    if (any64_ && !rays.wide.empty()) any64_(peer_, &rays.wide[first], n, occluded);
    else any_(peer_, &rays.rays[first], n, occluded);
  }
  size_t bytes() const { return bytes_(peer_); }
  void release() {
    free_(peer_);
    peer_ = nullptr;
  }
  const std::string &name() const { return name_; }

private:
  template <class F> void load(void *library, F &function, const char *symbol) {
    function = reinterpret_cast<F>(dlsym(library, symbol));
    if (!function) fail(std::string(symbol) + " is missing in a competitor");
  }

  std::string name_, variant_;
  void *peer_ = nullptr;
  decltype(&peer_build) build_;
  decltype(&peer_closest) closest_;
  decltype(&peer_any) any_;
  decltype(&peer_closest64) closest64_;
  decltype(&peer_any64) any64_;
  decltype(&peer_bytes) bytes_;
  decltype(&peer_free) free_;
};
