#include "passes/draw_light_buffer.h"

#include "passes/light_volumes/volume_draws.h"

namespace lightgrid {

LightBuffer draw_light_buffer(RenderView& v, const NormalImage& normals) {
  auto pass = v.timer.pass("draw_light_buffer", "gl");
  const LightBuffer buffer = light_buffer_of(v);
  std::vector<GLuint> images = {buffer.first};
  if (buffer.second) images.push_back(buffer.second);
  const GLuint framebuffer = v.targets.framebuffer(images, v.targets.depth());
  const float nothing[4] = {0, 0, 0, 0};
  for (size_t i = 0; i < images.size(); ++i)
    glClearNamedFramebufferfv(framebuffer, GL_COLOR, GLint(i), nothing);
  LightVolumes& volumes = v.state<LightVolumes>();
  volumes.update(v, v.plan.settings.volume_mesh);
  std::vector<std::string> defines = every_light(v).defines;
  if (normals.layout->define) defines.emplace_back(normals.layout->define);
  for (std::string& define : light_buffer_defines(v)) defines.push_back(std::move(define));
  begin_adding_lights(v, framebuffer);
  bind_texture(Sampler::normals, normals.texture);
  bind_texture(Sampler::depth_image, v.targets.depth());
  VolumeDraws(v, "shaders/light_buffer.frag", std::move(defines)).draw(0, volumes.volumes().size());
  glDisable(GL_BLEND);
  pass.moves(v.pixels() * (4 + normals.layout->image.bytes + buffer.bytes()), v.pixels() * buffer.bytes());
  return buffer;
}

}  // namespace lightgrid
