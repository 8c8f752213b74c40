#include "passes/draw_light_buffer.h"

#include "passes/light_volumes/volume_draws.h"

namespace lightgrid {

LightBuffer draw_light_buffer(Work& work, const Seen& seen, Cached<LightVolumes>& cache,
                              const NormalImage& normals) {
  auto pass = work.timer.pass("draw_light_buffer", "gl");
  const LightBuffer buffer = light_buffer_of(work, seen);
  std::vector<GLuint> images = {buffer.first};
  if (buffer.second) images.push_back(buffer.second);
  const GLuint framebuffer = work.targets.framebuffer(images, work.targets.depth());
  const float nothing[4] = {0, 0, 0, 0};
  for (size_t i = 0; i < images.size(); ++i)
    glClearNamedFramebufferfv(framebuffer, GL_COLOR, GLint(i), nothing);
  LightVolumes& volumes = cache.of(work, seen);
  volumes.update(seen, seen.plan.settings.volume_mesh);
  std::vector<std::string> defines = light_loop(seen).defines;
  if (normals.layout->define) defines.emplace_back(normals.layout->define);
  for (std::string& define : light_buffer_defines(seen)) defines.push_back(std::move(define));
  begin_adding_lights(work, seen, framebuffer);
  bind_texture(Sampler::normals, normals.texture);
  bind_texture(Sampler::depth_image, work.targets.depth());
  VolumeDraws(work, seen, cache.of(work, seen), "shaders/light_buffer.frag", std::move(defines))
      .draw(0, volumes.volumes().size());
  glDisable(GL_BLEND);
  pass.moves(seen.grid().values() * (4 + normals.layout->image.bytes + buffer.bytes()),
             seen.grid().values() * buffer.bytes());
  return buffer;
}

}  // namespace lightgrid
