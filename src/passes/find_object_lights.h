// The lights that reach each object: for forward techniques that draw objects with their lights, without a
// grid.
#pragma once

#include "passes/common/light_source.h"
#include "passes/light_volumes/light_reach.h"

namespace lightgrid {

// Objects are parts of instances: successive clusters that the same lights reach.
class ObjectLights : public PassCache {
 public:
  struct Object {
    int instance;
    std::vector<uint32_t> clusters;             // clusters of the instance's mesh
    uint32_t first_light = 0, light_count = 0;  // range in lights, ascending
    IndexRanges ranges;                         // of these clusters
  };

  explicit ObjectLights(Work&, const Seen&) {}
  size_t memory_bytes() const override { return buffer_bytes_; }
  bool follow(Work&, const Seen&) override { return true; }  // every frame updates it

  // Finds the objects of a draw list, in its order, and uploads their lights to the buffer that
  // shaders/lights/object.glsl reads.
  void update(Work& work, const Seen& seen, const DrawList& list);

  const std::vector<Object>& objects() const { return objects_; }
  const std::vector<uint32_t>& lights() const { return lights_; }  // indices into FramePlan::local
  GLuint texture() const { return texture_.name(); }

 private:
  void add_item(Work& work, const Seen& seen, const DrawItem& item, const std::vector<uint32_t>& candidates);
  void upload_lists();

  std::vector<LightReach> reaches_;
  std::vector<Object> objects_;
  std::vector<uint32_t> lights_;
  GlBuffer buffer_;
  GlTexture texture_;
  size_t buffer_bytes_ = 0;
};

// The lights of the current object (uniform lights_of_draw).
LightSource from_objects(Work& work, const Seen& seen, const ObjectLights& objects);

// The pass: object-light pairs of opaque or blended surfaces, found on the CPU.
const ObjectLights& find_object_lights(Work& work, const Seen& seen, Cached<ObjectLights>& cache,
                                       const DrawList& surfaces);
const ObjectLights& find_blended_object_lights(Work& work, const Seen& seen, Cached<ObjectLights>& cache);

}  // namespace lightgrid
