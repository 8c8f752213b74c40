// Draws light volumes into light index images: which pixels are inside, and which have a free slot, is in the
// stencil (docs/details/lidr.md).
#pragma once

#include "passes/light_index/layout.h"
#include "passes/light_volumes/light_volumes.h"

namespace lightgrid {

// Volumes that one call draws.
struct VolumeBatch {
  size_t first, count;
  uint32_t group;     // sorted packings: the group whose channels are written
  uint32_t pass = 0;  // over the surfaces, in whose images they are
};

class IndexDrawing {
 public:
  // Programs of shaders/light_index.vert and light_index.frag. mark: draws the front faces that mark the
  // inside; discarded fragments mark nothing.
  struct Programs {
    GLuint mark, write;
  };
  IndexDrawing(const ViewState& seen, const LightIndexLayout& layout, const LightVolumes& volumes,
               const Programs& programs);

  // The initial stencil value: the number of free slots.
  GLint cleared_stencil() const;

  // Into the bound framebuffer, between LightVolumes::begin() and end().
  void draw(const VolumeBatch& batch) const;

 private:
  void mark_inside(const VolumeBatch& batch) const;
  void test_free_slot(uint32_t group) const;
  void test_mark_only() const;
  void write_marked(const VolumeBatch& batch) const;
  void write_behind_front_faces(const VolumeBatch& batch) const;
  bool crosses_near(const VolumeBatch& batch) const { return volumes_.volumes()[batch.first].crosses_near; }

  const LightIndexLayout& layout_;
  const LightVolumes& volumes_;
  Programs programs_;
  bool inside_, before_depth_;
};

}  // namespace lightgrid
