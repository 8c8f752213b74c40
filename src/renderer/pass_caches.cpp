#include "renderer/pass_caches.h"

namespace lightgrid {

std::array<std::unique_ptr<PassCache>*, 11> PassCaches::all() {
  return {&opaque_triangles.made_, &blended_triangles.made_, &resolver.made_,
          &tile_shading.made_,     &light_sums.made_,        &light_volumes.made_,
          &light_index.made_,      &object_lights.made_,     &blended_object_lights.made_,
          &voxels.made_,           &world_grid.made_};
}

void PassCaches::follow(Work& work, const Seen& seen) {
  for (std::unique_ptr<PassCache>* cache : all()) {
    if (*cache && !(*cache)->follow(work, seen)) cache->reset();
  }
}

void PassCaches::upload(Work& work, const Seen& seen) {
  for (std::unique_ptr<PassCache>* cache :
       {&opaque_triangles.made_, &blended_triangles.made_, &resolver.made_}) {
    if (*cache) (*cache)->upload(work, seen);
  }
}

void PassCaches::clear() {
  for (std::unique_ptr<PassCache>* cache : all()) cache->reset();
}

size_t PassCaches::memory_bytes() const {
  size_t bytes = 0;
  for (const std::unique_ptr<PassCache>* cache : const_cast<PassCaches*>(this)->all())
    bytes += *cache ? (*cache)->memory_bytes() : 0;
  return bytes;
}

}  // namespace lightgrid
