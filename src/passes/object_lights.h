// Which lights reach each object: for forward techniques that draw an object with its lights and know no
// grid.
#pragma once

#include "passes/frame/light_reach.h"
#include "passes/passes.h"
#include "scene/listed_lights.h"

namespace lightgrid {

// Objects are parts of instances: clusters of triangles that follow each other and are reached by the same
// lights.
class ObjectLights : public Kept {
 public:
  struct Object {
    int instance;
    std::vector<uint32_t> clusters;             // of its mesh
    uint32_t first_light = 0, light_count = 0;  // in lights, ascending
  };

  explicit ObjectLights(Frame&) {}
  size_t memory_bytes() const override { return buffer_bytes_; }

  // The instances' objects in the order of drawing, without those that `distances` (null: nothing is known) shows
  // to be hidden; then their lights into the buffer that shaders/lights/object.glsl reads.
  void update(Frame& f, const std::vector<int>& instances, DrawOrder order, const TileDistances* distances);

  const std::vector<Object>& objects() const { return objects_; }
  const std::vector<uint32_t>& lights() const { return lights_; }  // places in FramePlan::local
  GLuint texture() const { return texture_.name(); }

 private:
  void add_part(Frame& f, const VisiblePart& part, const std::vector<uint32_t>& candidates);
  void upload();

  std::vector<LightReach> reaches_;
  std::vector<Object> objects_;
  std::vector<uint32_t> lights_;
  GlBuffer buffer_;
  GlTexture texture_;
  size_t buffer_bytes_ = 0;
};

class BlendedObjectLights : public ObjectLights {
 public:
  using ObjectLights::ObjectLights;
};

// The passes: object-light pairs of opaque surfaces and of blended ones, found on the CPU.
const ObjectLights& find_object_lights(Frame& f, const TileDistances& distances);
const ObjectLights& find_blended_object_lights(Frame& f);

// Each object at the depth that the prepass left: its own light over what is there, then its lights in the
// order of their indices, `lights_a_draw` in each draw. own_apart: the first draw has none of them.
ShadedImage shade_objects(Frame& f, const ObjectLights& objects, uint32_t lights_a_draw, bool own_apart);

// Blended objects over the image, back to front, each in one draw with all of its lights: a second one would lay
// the surface over itself.
void shade_blended(Frame& f, const ShadedImage& image, const ObjectLights& objects);

// What the last frame of shade_objects shaded each pixel with. For the oracle, not part of a frame.
ListedLights listed_of_objects(Frame& f);

}  // namespace lightgrid
