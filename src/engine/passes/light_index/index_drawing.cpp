#include "passes/light_index/index_drawing.h"

#include "passes/light_index/blending.h"
#include "passes/light_index/lidr_settings.h"

namespace lightgrid {

// The stencil's lowest bit is clear where the surface is inside the current volume; the bits above count the
// remaining slots down. Decrementing an even value does both: it sets the lowest bit and takes one from the
// count.
static constexpr GLuint not_inside = 1;
static constexpr GLuint has_room = 128;  // top bit: the count is not exhausted

IndexDrawing::IndexDrawing(const ViewState& seen, const LightIndexLayout& layout, const LightVolumes& volumes,
                           const Programs& programs)
    : layout_(layout),
      volumes_(volumes),
      programs_(programs),
      inside_(seen.plan.settings[setting::lidr_volumes] == LidrVolumes::stencil),
      before_depth_(seen.plan.settings[setting::lidr_volumes] == LidrVolumes::no_prepass) {}

GLint IndexDrawing::cleared_stencil() const {
  if (layout_.sorted()) return 255;
  return GLint(inside_ ? 2 * (has_room / 2 - 1 + layout_.overlap) + not_inside
                       : has_room - 1 + layout_.overlap);
}

void IndexDrawing::draw(const VolumeBatch& batch) const {
  const bool counted = !layout_.sorted();
  if (inside_) mark_inside(batch);
  glUseProgram(programs_.write);
  // Later groups first: otherwise a light that fills one group's last slot would also be written to the
  // next group.
  for (uint32_t group = counted ? layout_.groups : 1; group-- > 0;) {
    write_group(layout_, counted ? group : batch.group);
    counted ? test_free_slot(group) : test_mark_only();
    inside_ ? write_marked(batch) : write_behind_front_faces(batch);
  }
}

// Marks surfaces behind a front face; write_marked then tests for a back face behind them. If the near
// plane cuts holes into front faces, each face behind a surface inverts the bit: an odd number means
// inside, for any closed mesh.
void IndexDrawing::mark_inside(const VolumeBatch& batch) const {
  glUseProgram(programs_.mark);
  write_group(layout_, no_channels);
  const bool count = crosses_near(batch);
  count ? glDisable(GL_CULL_FACE) : glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glDepthFunc(GL_GEQUAL);
  glStencilMask(not_inside);
  glStencilFunc(GL_ALWAYS, 0, 0);
  count ? glStencilOp(GL_KEEP, GL_INVERT, GL_KEEP) : glStencilOp(GL_KEEP, GL_KEEP, GL_ZERO);
  volumes_.draw(batch.first, batch.count);
}

// Tests for a free slot in this group and, with stencil, for the mark. A marked surface behind a back face
// is not inside and loses its mark.
void IndexDrawing::test_free_slot(uint32_t group) const {
  const GLuint step = inside_ ? 2 : 1;  // stencil steps a slot takes
  const GLuint of_group = layout_.groups > 1 ? step * layout_.slots : 0;
  glStencilMask(255);
  glStencilFunc(GL_EQUAL, GLint(has_room | (group == 0 ? of_group : 0)),
                has_room | of_group | (inside_ ? not_inside : 0));
  glStencilOp(GL_KEEP, inside_ ? GL_INCR : GL_KEEP, GL_DECR);
}

void IndexDrawing::test_mark_only() const {
  inside_ ? glStencilFunc(GL_EQUAL, 0, not_inside) : glStencilFunc(GL_ALWAYS, 0, 0);
  inside_ ? glStencilOp(GL_KEEP, GL_INVERT, GL_INVERT) : glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
}

void IndexDrawing::write_marked(const VolumeBatch& batch) const {
  glEnable(GL_CULL_FACE);
  glCullFace(GL_FRONT);
  glDepthFunc(crosses_near(batch) ? GL_ALWAYS : GL_LEQUAL);
  volumes_.draw(batch.first, batch.count);
}

// Writes to surfaces behind a front face or, if the near plane cuts holes into these, wherever there is a
// back face. Without a depth prepass, wherever there is either.
void IndexDrawing::write_behind_front_faces(const VolumeBatch& batch) const {
  glEnable(GL_CULL_FACE);
  glCullFace(crosses_near(batch) ? GL_FRONT : GL_BACK);
  glDepthFunc(crosses_near(batch) || before_depth_ ? GL_ALWAYS : GL_GEQUAL);
  volumes_.draw(batch.first, batch.count);
}

}  // namespace lightgrid
