// The lights that reach each object: for forward techniques that draw objects with their lights, without a
// grid.
#pragma once

#include "passes/common/light_source.h"
#include "scene/view_lights.h"

namespace lightgrid {

// Axis-aligned in view space.
struct ViewBox {
  glm::dvec3 center, half;
};

ViewBox box_in_view(const glm::dmat4& view_from_object, const Aabb& box);

// Tests whether a light may reach a box: in double, conservative.
class LightReach {
 public:
  explicit LightReach(const LightBounds& light);

  // False only if the light adds nothing to any pixel of a surface in the box.
  bool may_reach(const ViewBox& box) const;

 private:
  glm::dvec3 position_, direction_;
  double radius_;
  double cos_, sin_;  // the cone's half-angle, widened
  bool cone_;         // narrower than 90 degrees
};

// Objects are parts of instances: successive clusters that the same lights reach.
class ObjectLights : public PassCache {
 public:
  struct Object {
    int instance;
    std::vector<uint32_t> clusters;             // clusters of the instance's mesh
    uint32_t first_light = 0, light_count = 0;  // range in lights, ascending
    IndexRanges ranges;                         // index ranges of these clusters
  };

  explicit ObjectLights(PassContext&) {}
  size_t memory_bytes() const override { return buffer_bytes_; }
  bool follow(PassContext&) override { return true; }  // every frame updates it

  // Finds the objects of a draw list, in its order, and uploads their lights to the buffer that
  // shaders/lights/object.glsl reads.
  void update(PassContext& work, const DrawList& list);

  const std::vector<Object>& objects() const { return objects_; }
  const std::vector<uint32_t>& lights() const { return lights_; }  // indices into LightPlan::local
  GLuint texture() const { return texture_.name(); }

 private:
  void add_item(PassContext& work, const DrawItem& item, const std::vector<uint32_t>& candidates);
  void upload_lists();

  std::vector<LightReach> reaches_;
  std::vector<Object> objects_;
  std::vector<uint32_t> lights_;
  GlBuffer buffer_;
  GlTexture texture_;
  size_t buffer_bytes_ = 0;
};

// The lights of the current object (uniform lights_of_draw).
LightSource from_objects(PassContext& work, const ObjectLights& objects);

// The pass: object-light pairs of opaque or blended surfaces, found on the CPU.
const ObjectLights& find_object_lights(PassContext& work, Cached<ObjectLights>& cache,
                                       const DrawList& surfaces);
const ObjectLights& find_blended_object_lights(PassContext& work, Cached<ObjectLights>& cache);

}  // namespace lightgrid
