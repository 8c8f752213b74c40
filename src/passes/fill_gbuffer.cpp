// Surfaces into the geometry buffer, once a pixel and material; lights come after, and look at no material.
#include "passes/gbuffer.h"

#include <algorithm>

#include "passes/frame/draw.h"
#include "passes/frame/light_defines.h"

namespace lightgrid {
namespace {

const GBufferLayout& layout_of(const Settings& settings) {
  return *std::find_if(std::begin(gbuffer_layouts), std::end(gbuffer_layouts),
                       [&](const GBufferLayout& layout) { return layout.bits == settings.buffer_bits; });
}

// A pixel, beside depth.
size_t written_bytes(const GBuffer& gbuffer) {
  return gbuffer.layout->bytes() + (gbuffer.own_light == OwnLight::in_image ? 16 : 0);
}

void clear(Frame& f, const GBuffer& gbuffer) {
  const float background[4] = {f.scene.background.r, f.scene.background.g, f.scene.background.b, 1};
  const float nothing[4] = {0, 0, 0, 0};
  if (gbuffer.own_light == OwnLight::in_image) glClearNamedFramebufferfv(gbuffer.image.framebuffer, GL_COLOR, 0, background);
  for (int i = 0; i < 2; ++i) glClearNamedFramebufferfv(gbuffer.framebuffer, GL_COLOR, i, nothing);
}

void draw_surfaces(Frame& f, const GBuffer& gbuffer, const TileDistances* distances) {
  glBindFramebuffer(GL_FRAMEBUFFER, gbuffer.framebuffer);
  glViewport(0, 0, f.view.width, f.view.height);
  clear(f, gbuffer);
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  f.bind_lights();
  draw_instances(
      f, f.plan.opaque, DrawStreams::all,
      [&](uint32_t features) -> const GlProgram& {
        std::vector<std::string> defines = own_light_defines(f, features);
        if (gbuffer.layout->define) defines.emplace_back(gbuffer.layout->define);
        if (gbuffer.own_light == OwnLight::in_image) defines.emplace_back("OWN_LIGHT");
        return f.program("shaders/scene.vert", "shaders/gbuffer.frag", defines);
      },
      distances);
}

}  // namespace

GBuffer gbuffer_of(Frame& f, OwnLight own_light) {
  GBuffer g;
  g.own_light = own_light;
  g.layout = &layout_of(f.plan.settings);
  for (int i = 0; i < 2; ++i) {
    g.textures[i] =
        f.targets.texture(g.layout->images[i].name, g.layout->images[i].format, TargetUse::gbuffer);
  }
  g.depth = f.targets.depth();
  const GLuint image = f.targets.texture("color", GL_RGBA32F);
  g.framebuffer = own_light == OwnLight::in_image ? f.targets.framebuffer({g.textures[0], g.textures[1], image}, g.depth)
                                                  : f.targets.framebuffer({g.textures[0], g.textures[1]}, g.depth);
  g.depth_image = {f.depth_framebuffer()};
  g.image = {f.color_framebuffer()};
  return g;
}

GBuffer fill_gbuffer(Frame& f, OwnLight own_light) {
  auto pass = f.timer.pass("fill_gbuffer", "gl");
  const GBuffer gbuffer = gbuffer_of(f, own_light);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDepthFunc(GL_GEQUAL);  // of equal depths the last wins, as where others shade at equal depth
  glDepthMask(GL_TRUE);
  const float nothing = 0.0f;
  glClearNamedFramebufferfv(gbuffer.framebuffer, GL_DEPTH, 0, &nothing);
  draw_surfaces(f, gbuffer, nullptr);
  const size_t pixels = size_t(f.view.width) * f.view.height;
  pass.moves(f.gpu.geometry_bytes(), pixels * (4 + written_bytes(gbuffer)));
  return gbuffer;
}

GBuffer fill_gbuffer(Frame& f, const TileDistances& distances, OwnLight own_light) {
  auto pass = f.timer.pass("fill_gbuffer", "gl");
  const GBuffer gbuffer = gbuffer_of(f, own_light);
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  draw_surfaces(f, gbuffer, &distances);
  const size_t pixels = size_t(f.view.width) * f.view.height;
  pass.moves(f.gpu.geometry_bytes() + pixels * 4, pixels * written_bytes(gbuffer));
  return gbuffer;
}

std::vector<std::string> gbuffer_defines(const GBuffer& gbuffer) {
  return gbuffer.layout->define ? std::vector<std::string>{gbuffer.layout->define}
                                : std::vector<std::string>{};
}

void bind_gbuffer(const GBuffer& gbuffer) {
  glBindTextureUnit(0, gbuffer.textures[0]);
  glBindTextureUnit(1, gbuffer.textures[1]);
  glBindTextureUnit(2, gbuffer.depth);
}

}  // namespace lightgrid
