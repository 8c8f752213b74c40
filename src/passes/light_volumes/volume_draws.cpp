// Pixels out of a light's reach are skipped by one of the methods of Engel, "Designing a Renderer for
// Multiple Lights" (ShaderX7, 2009):
//
// scissor       The whole screen, cut to the rectangle of the light's tangents.
//
// depth-bounds  The same; pixels outside the depth interval leave the shader early. Few OpenGLs have such a
// test.
//
// back-faces    The volume's back faces where they are behind the surface: works with the eye inside the
// volume.
//
// stencil       Faces behind the surface are counted, back plus one, front minus one; nonzero means inside.
//               Then the same back faces are drawn where it is nonzero, and reset it to 0.
#include "passes/light_volumes/volume_draws.h"

#include "passes/light_volumes/screen_bounds.h"

namespace lightgrid {

VolumeDraws::VolumeDraws(Work& work, const Seen& seen, LightVolumes& volumes, const char* fragment,
                         std::vector<std::string> defines)
    : seen_(seen), culling_(seen.plan.settings.volume_culling), volumes_(volumes) {
  if (culling_ == VolumeCulling::depth_bounds) defines.emplace_back("DEPTH_BOUNDS");
  if (drawn_as_volumes()) defines.emplace_back("LIGHT_VOLUME");
  program_ = &work.program(drawn_as_volumes() ? "shaders/light_volume.vert" : "shaders/screen.vert", fragment,
                           defines);
  if (culling_ == VolumeCulling::stencil)
    marking_ = &work.program("shaders/light_volume.vert", "shaders/depth.frag", {});
}

void VolumeDraws::draw(size_t first, size_t end) {
  if (!drawn_as_volumes()) return draw_rectangles(first, end);
  volumes_.begin();
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_FRONT);
  glDepthFunc(GL_LEQUAL);  // behind the surface: depth is reversed
  if (culling_ == VolumeCulling::stencil) {
    draw_marked(first, end);
  } else {
    glUseProgram(program_->name());
    volumes_.draw(first, end - first);
  }
  glCullFace(GL_BACK);
  volumes_.end();
}

bool VolumeDraws::drawn_as_volumes() const {
  return culling_ == VolumeCulling::back_faces || culling_ == VolumeCulling::stencil;
}

void VolumeDraws::draw_marked(size_t first, size_t end) {
  glEnable(GL_STENCIL_TEST);
  for (size_t i = first; i < end; ++i) {
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDisable(GL_CULL_FACE);
    glDepthFunc(GL_GREATER);
    glStencilFunc(GL_ALWAYS, 0, 0xff);
    glStencilOpSeparate(GL_BACK, GL_KEEP, GL_INCR_WRAP, GL_KEEP);
    glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_DECR_WRAP, GL_KEEP);
    glUseProgram(marking_->name());
    volumes_.draw(i, 1);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glEnable(GL_CULL_FACE);
    glDepthFunc(GL_LEQUAL);
    glStencilFunc(GL_NOTEQUAL, 0, 0xff);
    glStencilOp(GL_KEEP, GL_ZERO, GL_ZERO);
    glUseProgram(program_->name());
    volumes_.draw(i, 1);
  }
  glDisable(GL_STENCIL_TEST);
}

void VolumeDraws::draw_rectangles(size_t first, size_t end) {
  const GlVertexArray nothing = make_vertex_array();
  glBindVertexArray(nothing.name());
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_SCISSOR_TEST);
  glUseProgram(program_->name());
  const GLint light = program_->uniform("light"), depth_bounds = program_->uniform("depth_bounds");
  for (size_t i = first; i < end; ++i) {
    const LightVolume& volume = volumes_.volumes()[i];
    const ScreenBounds bounds = screen_bounds(seen_.view, volume);
    const glm::ivec2 size = bounds.end - bounds.first;
    glScissor(bounds.first.x, bounds.first.y, size.x, size.y);
    glUniform1ui(light, volume.light);
    if (culling_ == VolumeCulling::depth_bounds) {
      glUniform2f(depth_bounds, bounds.depth.x, bounds.depth.y);
    }
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  glDisable(GL_SCISSOR_TEST);
  glBindVertexArray(0);
}

void begin_adding_lights(Work& work, const Seen& seen, GLuint framebuffer) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  if (seen.plan.stencil) {
    const GLint nothing = 0;
    glStencilMask(0xff);
    glClearNamedFramebufferiv(framebuffer, GL_STENCIL, 0, &nothing);
  }
  glViewport(0, 0, seen.grid().width, seen.grid().height);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE);
  work.bind_lights();
}

}  // namespace lightgrid
