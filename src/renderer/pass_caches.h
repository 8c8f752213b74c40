// What passes keep from frame to frame beyond targets and programs, each by its name.
#pragma once

#include <array>
#include <memory>

#include "renderer/work.h"

namespace lightgrid {

class PassCache {
 public:
  virtual ~PassCache() = default;
  virtual size_t memory_bytes() const { return 0; }
  // Called after the camera, the lights or the plan changed. Returns false if the cache no longer fits; it is
  // then made again at its next use.
  virtual bool follow(Work&, const Seen&) { return false; }
  // What follow() may leave for later: uploads of what the rasteriser does not read. PassCaches::upload calls
  // it while the device draws triangles; the pass calls it too, before it reads them. Only the first call
  // after follow() does anything.
  virtual void upload(Work&, const Seen&) {}
};

// One cache; T(Work&, const Seen&) makes it at first use.
template <typename T>
class Cached {
 public:
  T& of(Work& work, const Seen& seen) {
    if (!made_) made_ = std::make_unique<T>(work, seen);
    return static_cast<T&>(*made_);
  }

 private:
  friend struct PassCaches;
  std::unique_ptr<PassCache> made_;
};

struct PassCaches {
  Cached<class OpaqueTriangles> opaque_triangles;  // passes/rasterize.cpp
  Cached<class BlendedTriangleLists> blended_triangles;
  Cached<class Resolver> resolver;                                  // passes/resolve.cpp
  Cached<class TileShading> tile_shading;                           // passes/shade_tiles.cpp
  Cached<class LightSums> light_sums;                               // passes/fill_light_buffer.cpp
  Cached<class LightVolumes> light_volumes;                         // passes/light_volumes/light_volumes.h
  Cached<class LightIndexOrder> light_index;                        // passes/light_index.cpp
  Cached<class ObjectLights> object_lights, blended_object_lights;  // passes/find_object_lights.h
  Cached<class VoxelBuffers> voxels;                                // passes/build_voxels.cpp
  Cached<class ViewOfWorldGrid> world_grid;                         // passes/build_world_grid.cpp

  void follow(Work& work, const Seen& seen);
  // Of those that upload while the device draws triangles.
  void upload(Work& work, const Seen& seen);
  void clear();
  size_t memory_bytes() const;

 private:
  std::array<std::unique_ptr<PassCache>*, 11> all();
};

}  // namespace lightgrid
