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

// The images that some surfaces need.
struct MoreImages {
  bool coats, models, specular;
};

// Images over the frame's depth, cleared and bound: three, two of coats, one of models, one of reflectance.
struct SurfaceTargets {
  SurfaceTargets(Work& work, const Seen& seen, MoreImages more)
      : width(seen.view.width), height(seen.view.height) {
    std::vector<GLuint> names;
    for (int i = 0; i < 3 + 2 * more.coats + more.models + more.specular; ++i) {
      textures.push_back(make_texture_2d(GL_RGBA32F, width, height));
      names.push_back(textures.back().name());
    }
    framebuffer = make_framebuffer(names, work.targets.depth());
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glViewport(0, 0, width, height);
    for (size_t i = 0; i < textures.size(); ++i) clear(int(i));
    glDepthMask(GL_FALSE);
    glDisable(GL_BLEND);
  }
  void clear(int i) {
    const float nothing[4] = {0, 0, 0, 0};
    glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, i, nothing);
  }
  Image read(size_t i) { return read_image(int(i), width, height); }
  // The target is freed: nothing is drawn into it afterwards.
  Image take(size_t i) {
    Image image = read(i);
    textures[i] = GlTexture();
    return image;
  }

  int width, height;
  std::vector<GlTexture> textures;
  GlFramebuffer framebuffer;
};

// read: the image of a number, in the order of SurfaceTargets.
template <typename Read>
SurfaceImages surface_images_of(MoreImages more, const Read& read) {
  SurfaceImages s{.normal_roughness = read(0), .base_color_metallic = read(1), .emissive_occlusion = read(2)};
  size_t next = 3;
  if (more.coats) s.coat_normal_roughness = read(next), s.coat_factor = read(next + 1), next += 2;
  if (more.models) s.model = read(next++);
  if (more.specular) s.specular = read(next);
  return s;
}

}  // namespace

SurfaceImages read_surfaces(Work& work, const Seen& seen) {
  const MoreImages more{.coats = (seen.plan.features & feature_clearcoat) != 0,
                        .models = (seen.plan.features & (feature_skin | feature_minnaert)) != 0,
                        .specular = (seen.plan.features & feature_specular) != 0};
  SurfaceTargets targets(work, seen, more);
  glEnable(GL_DEPTH_TEST);
  std::vector<std::string> defines;
  if (more.coats) defines.emplace_back("COATS");
  if (more.models) defines.emplace_back("MODELS");
  if (more.specular) defines.emplace_back("SPECULAR_IMAGE");
  ScenePrograms& programs = work.programs({"shaders/scene.vert", "shaders/surfaces.frag", defines});
  glDepthFunc(GL_EQUAL);
  draw_list(work, seen, seen.opaque, DrawStreams::all, programs);
  const auto read = [&](size_t i) { return seen.plan.blended.empty() ? targets.take(i) : targets.read(i); };
  SurfaceImages surfaces = surface_images_of(more, read);
  surfaces.models = material_models(seen.scene);
  // A pixel belongs to a blended surface if it differs from the cleared target.
  surfaces.blended.assign(surfaces.normal_roughness.pixels.size(), false);
  if (!seen.plan.blended.empty()) {
    targets.clear(0);
    glDepthFunc(GL_GEQUAL);
    draw_list(work, seen, seen.blended, DrawStreams::all, programs);
    const Image normals = targets.read(0);
    for (size_t i = 0; i < normals.pixels.size(); ++i)
      surfaces.blended[i] = glm::vec3(normals.pixels[i]) != glm::vec3(0);
  }
  return surfaces;
}

SurfaceImages read_gbuffer_surfaces(Work& work, const Seen& seen) {
  const MoreImages more{.coats = seen.plan.clearcoat,
                        .models = seen.plan.skin || seen.plan.minnaert,
                        .specular = seen.plan.specular};
  SurfaceTargets targets(work, seen, more);
  const GBuffer gbuffer = gbuffer_of(work, seen);
  work.bind_lights();
  bind_gbuffer(gbuffer);
  glDisable(GL_DEPTH_TEST);
  draw_screen(work.program("shaders/screen.vert", "shaders/gbuffer_surfaces.frag", gbuffer_defines(gbuffer)));
  SurfaceImages surfaces = surface_images_of(more, [&](size_t i) { return targets.read(i); });
  surfaces.models = material_models(seen.scene);
  return surfaces;
}

}  // namespace lightgrid
