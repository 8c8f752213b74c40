#include "passes/common/gbuffer.h"

#include <algorithm>

namespace lightgrid {

const GBufferLayout& gbuffer_layout(const Settings& settings) {
  return *std::find_if(std::begin(gbuffer_layouts), std::end(gbuffer_layouts),
                       [&](const GBufferLayout& layout) { return layout.bits == settings.buffer_bits; });
}

GBufferInCl gbuffer_in_cl_of(RenderView& v, BaseLighting base_lighting, TargetUse use) {
  constexpr const char* names[] = {"gbuffer 0", "gbuffer 1", "gbuffer 2"};
  GBufferInCl g{.base_lighting = base_lighting, .layout = &gbuffer_layout(v.plan.settings), .coats = v.plan.clearcoat};
  for (size_t i = 0; i < g.images(); ++i) g.surfaces[i] = &v.shared_pixels(names[i], g.layout->images[i].bytes, use);
  g.image = &v.shared_pixels("image", 16);
  return g;
}

GBuffer gbuffer_of(RenderView& v, BaseLighting base_lighting) {
  GBuffer g;
  g.base_lighting = base_lighting;
  g.layout = &gbuffer_layout(v.plan.settings);
  g.coats = v.plan.clearcoat;
  for (size_t i = 0; i < g.images(); ++i) {
    g.textures[i] =
        v.targets.texture(g.layout->images[i].name, g.layout->images[i].format, TargetUse::gbuffer);
  }
  g.depth = v.targets.depth();
  const GLuint image = v.targets.texture("color", GL_RGBA32F);
  std::vector<GLuint> drawn = {g.textures[0], g.textures[1]};
  if (base_lighting == BaseLighting::in_image) drawn.push_back(image);
  if (g.coats) drawn.push_back(g.textures[2]);
  g.framebuffer = v.targets.framebuffer(drawn, g.depth);
  g.depth_image = {v.depth_framebuffer()};
  g.image = {v.color_framebuffer()};
  return g;
}

std::vector<std::string> gbuffer_defines(const GBuffer& gbuffer) {
  std::vector<std::string> defines;
  if (gbuffer.layout->define) defines.emplace_back(gbuffer.layout->define);
  if (gbuffer.coats) defines.emplace_back("CLEARCOAT");
  return defines;
}

void bind_gbuffer(const GBuffer& gbuffer) {
  glBindTextureUnit(0, gbuffer.textures[0]);
  glBindTextureUnit(1, gbuffer.textures[1]);
  glBindTextureUnit(2, gbuffer.depth);
  if (gbuffer.coats) glBindTextureUnit(3, gbuffer.textures[2]);
}

}  // namespace lightgrid
