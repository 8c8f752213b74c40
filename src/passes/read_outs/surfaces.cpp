#include "passes/read_outs/surfaces.h"

#include "passes/common/gbuffer.h"
#include "renderer/draw.h"

namespace lightgrid {
namespace {

Image read_image(int attachment, int width, int height) {
  Image image(width, height);
  glReadBuffer(GL_COLOR_ATTACHMENT0 + attachment);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, image.pixels.data());
  return image;
}

// Three images over the frame's depth, cleared and bound.
struct SurfaceTargets {
  explicit SurfaceTargets(RenderView& v)
      : width(v.view.width),
        height(v.view.height),
        textures{make_texture_2d(GL_RGBA32F, width, height), make_texture_2d(GL_RGBA32F, width, height),
                 make_texture_2d(GL_RGBA32F, width, height)},
        framebuffer(make_framebuffer({textures[0].name(), textures[1].name(), textures[2].name()}, v.targets.depth())) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glViewport(0, 0, width, height);
    for (int i = 0; i < 3; ++i) clear(i);
    glDepthMask(GL_FALSE);
    glDisable(GL_BLEND);
  }
  void clear(int i) {
    const float nothing[4] = {0, 0, 0, 0};
    glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, i, nothing);
  }
  Image read(int i) { return read_image(i, width, height); }
  // The target is freed: nothing is drawn into it afterwards.
  Image take(int i) {
    Image image = read(i);
    textures[i] = GlTexture();
    return image;
  }

  int width, height;
  GlTexture textures[3];
  GlFramebuffer framebuffer;
};

}  // namespace

SurfaceImages read_surfaces(RenderView& v) {
  SurfaceTargets targets(v);
  glEnable(GL_DEPTH_TEST);
  ScenePrograms& programs = v.programs({"shaders/scene.vert", "shaders/surfaces.frag", {}});
  glDepthFunc(GL_EQUAL);
  draw_list(v, v.opaque, DrawStreams::all, programs);
  const auto read = [&](int i) { return v.plan.blended.empty() ? targets.take(i) : targets.read(i); };
  SurfaceImages surfaces{read(0), read(1), read(2), {}};
  // A pixel belongs to a blended surface if it differs from the cleared target.
  surfaces.blended.assign(surfaces.normal_roughness.pixels.size(), false);
  if (!v.plan.blended.empty()) {
    targets.clear(0);
    glDepthFunc(GL_GEQUAL);
    draw_list(v, v.blended, DrawStreams::all, programs);
    const Image normals = targets.read(0);
    for (size_t i = 0; i < normals.pixels.size(); ++i)
      surfaces.blended[i] = glm::vec3(normals.pixels[i]) != glm::vec3(0);
  }
  return surfaces;
}

SurfaceImages read_gbuffer_surfaces(RenderView& v) {
  SurfaceTargets targets(v);
  const GBuffer gbuffer = gbuffer_of(v);
  v.bind_lights();
  bind_gbuffer(gbuffer);
  glDisable(GL_DEPTH_TEST);
  draw_screen(v.program("shaders/screen.vert", "shaders/gbuffer_surfaces.frag", gbuffer_defines(gbuffer)));
  return {targets.read(0), targets.read(1), targets.read(2), {}};
}

}  // namespace lightgrid
