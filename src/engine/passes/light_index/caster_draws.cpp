#include "passes/light_index/caster_draws.h"

#include "plan/settings/model.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace lightgrid {

CasterDraws::CasterDraws(PassContext&) : array_(make_vertex_array()) {}

void CasterDraws::make_volumes(PassContext& work, const RayScene& rays) {
  const LightRanges ranges = ranges_of(work.plan.settings);
  const int shape = work.gpu.shape_version(), instances = work.gpu.instances_version(),
            lights = work.gpu.lights_version();
  if (shape == shape_ && instances == instances_ && lights == lights_ && ranges_ == ranges) return;
  shape_ = shape;
  instances_ = instances;
  lights_ = lights;
  ranges_ = ranges;
  std::vector<CastingLight> casting;
  for (const int i : work.plan.lights.local) {
    const Light& light = work.scene.lights[size_t(i)];
    casting.push_back({light.position, light.casts_shadow ? range_of(light, size_t(i), ranges) : 0});
  }
  const CasterVolumes made = caster_volumes(work.scene, rays, casting);
  of_light_ = made.of_light;
  index_bytes_ = made.indices.size() * sizeof made.indices[0];
  indices_ = GlBuffer();  // freed first, so that both need not fit at once
  indices_ = make_buffer(index_bytes_, made.indices.data());
  glVertexArrayElementBuffer(array_.name(), indices_.name());
}

void CasterDraws::begin_frame(PassContext& work, const RayScene& rays) {
  auto pass = work.timer.pass("shadow_volumes", "gl");
  make_volumes(work, rays);
  const glm::dvec3 origin = rays.origin() - work.view.eye;
  const glm::dmat4 view_from_rays = glm::translate(glm::dmat4(glm::dmat3(work.view.view_from_world)), origin);
  clip_from_rays_ = glm::mat4(work.view.clip_from_view * view_from_rays);
  stencil_ = work.targets.texture("shadow stencil", GL_DEPTH32F_STENCIL8);
  framebuffer_ = work.targets.framebuffer({}, stencil_);
  glTextureParameteri(stencil_, GL_DEPTH_STENCIL_TEXTURE_MODE, GL_STENCIL_INDEX);
  glTextureParameteri(stencil_, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(stencil_, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  const int width = work.grid().width, height = work.grid().height;
  glDepthMask(GL_TRUE);
  glBlitNamedFramebuffer(work.depth_framebuffer(), framebuffer_, 0, 0, width, height, 0, 0, width, height,
                         GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  glDepthMask(GL_FALSE);
  pass.moves(work.grid().values() * 4, work.grid().values() * 4);
}

void CasterDraws::draw(PassContext& work, std::span<const LightVolume> lights) const {
  const GlProgram& program = work.program("shaders/shadow_volume.vert", "shaders/depth.frag", {});
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, work.grid().width, work.grid().height);
  glBindVertexArray(array_.name());
  glUseProgram(program.name());
  glUniformMatrix4fv(program.uniform("clip_from_rays"), 1, GL_FALSE, glm::value_ptr(clip_from_rays_));
  glEnable(GL_DEPTH_CLAMP);
  glEnable(GL_CLIP_DISTANCE0);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glEnable(GL_STENCIL_TEST);
  glEnable(GL_SCISSOR_TEST);
  glDisable(GL_CULL_FACE);
  glFrontFace(GL_CCW);
  glDepthFunc(GL_GREATER);  // fails behind the surface: depth is reversed
  glStencilMask(255);
  glStencilFunc(GL_ALWAYS, 0, 255);
  glStencilOpSeparate(GL_BACK, GL_KEEP, GL_INCR_WRAP, GL_KEEP);
  glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_DECR_WRAP, GL_KEEP);
  const GLint light = program.uniform("light"), none = 0;
  for (const LightVolume& volume : lights) {
    const glm::ivec2 size = volume.end - volume.first;
    glScissor(volume.first.x, volume.first.y, size.x, size.y);
    glClearNamedFramebufferiv(framebuffer_, GL_STENCIL, 0, &none);
    const CasterVolumes::Range& range = of_light_[volume.light];
    if (!has_own_shadow(work.plan, volume.light) || range.count == 0) continue;
    glUniform1ui(light, volume.light);
    glDrawElementsBaseVertex(GL_TRIANGLES, GLsizei(range.count), GL_UNSIGNED_INT,
                             reinterpret_cast<const void*>(range.first * sizeof(uint32_t)), 0);
  }
  glDisable(GL_SCISSOR_TEST);
}

}  // namespace lightgrid
