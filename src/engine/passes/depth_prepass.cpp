// Depth first, so that each pixel is shaded once and culling has depth bounds for each tile.
#include "passes/depth_prepass.h"

#include "passes/common/mask_stencil.h"
#include "renderer/drawing/draw.h"

namespace lightgrid {

// Reversed depth: float's fine steps near 0 serve the far distances (Reed, "Depth Precision Visualized",
// 2015).
static void begin_depth(const ViewState& seen, GLuint framebuffer, GLenum test) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, seen.grid().width, seen.grid().height);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(test);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  const float nothing = 0.0f;
  glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &nothing);
}

// Alpha masks read more than positions.
static uint32_t features_of_depth(uint32_t features) {
  return features & feature_mask ? features & (features_of_base_color | feature_mask) : 0;
}

GlTexture depth_of_centres(PassContext& work) {
  if (work.grid().samples == 1) return {};
  GlTexture depth = make_texture_2d(work.targets.depth_format(), work.grid().width, work.grid().height);
  const GlFramebuffer framebuffer = make_framebuffer({}, depth.name());
  begin_depth(work, framebuffer.name(), GL_GEQUAL);
  draw_masked(
      work, work.opaque, framebuffer.name(),
      work.programs(
          {"shaders/depth.vert", "shaders/depth.frag", {"MASKS_OF_CENTRES"}, false, features_of_depth}));
  return depth;
}

DepthImage depth_prepass(PassContext& work, GLuint surface_numbers) {
  auto pass = work.timer.pass("depth_prepass", "gl");
  const GLuint depth_alone = work.depth_framebuffer();
  const GLuint framebuffer =
      surface_numbers ? work.targets.framebuffer({surface_numbers}, work.targets.depth()) : depth_alone;
  begin_depth(work, framebuffer, surface_numbers ? GL_GEQUAL : GL_GREATER);
  std::vector<std::string> defines;
  if (surface_numbers) defines.emplace_back("NUMBER_LOCATION 0");
  draw_list(work, work.opaque, DrawStreams::positions_where_possible,
            work.programs({"shaders/depth.vert", "shaders/depth.frag", defines, false, features_of_depth}));
  const size_t number_bytes = surface_numbers ? surface_number_bytes(work.plan) : 0;
  pass.moves(work.gpu.in_gl().geometry_bytes(), work.grid().values() * (4 + number_bytes));
  return {depth_alone};
}

DepthImage no_depth_yet(PassContext& work) {
  const GLuint framebuffer = work.depth_framebuffer();
  begin_depth(work, framebuffer, GL_GREATER);
  return {framebuffer};
}

// Masks and normal maps read more than vertices.
static uint32_t features_of_normals(uint32_t features) {
  constexpr uint32_t places = feature_textured | feature_uv1 | feature_uv_transform;
  uint32_t read = 0;
  if (features & feature_mask) read |= places | feature_vertex_color | feature_base_color_map | feature_mask;
  if (features & feature_normal_map) read |= places | feature_normal_map;
  return features & read;
}

static uint32_t features_of_normals_and_roughness(uint32_t features) {
  uint32_t read = 0;
  if (features & feature_metallic_roughness_map)
    read = feature_textured | feature_uv1 | feature_uv_transform | feature_metallic_roughness_map;
  return features_of_normals(features) | (features & read);
}

NormalImage fill_normals(PassContext& work) {
  auto pass = work.timer.pass("fill_normals", "gl");
  const NormalImage normals = normal_image_of(work);
  begin_depth(work, normals.framebuffer, GL_GEQUAL);
  const float nothing[4] = {0, 0, 0, 0};
  glClearNamedFramebufferfv(normals.framebuffer, GL_COLOR, 0, nothing);
  std::vector<std::string> defines;
  if (normals.layout->define) defines.emplace_back(normals.layout->define);
  const bool roughness = stores_roughness(work.plan.settings);
  if (roughness) defines.emplace_back("PREPASS_STORED");
  if (normals.surface_numbers) {
    const GLuint number[4] = {0, 0, 0, 0};
    glClearNamedFramebufferuiv(normals.framebuffer, GL_COLOR, 1, number);
    defines.emplace_back("NUMBER_LOCATION 1");
  }
  draw_masked(work, work.opaque, normals.framebuffer,
              work.programs({"shaders/scene.vert", "shaders/normals.frag", std::move(defines), false,
                             roughness ? features_of_normals_and_roughness : features_of_normals}));
  pass.moves(work.gpu.in_gl().geometry_bytes(),
             work.grid().values() * (4 + normals.layout->image.bytes + surface_number_bytes(work.plan)));
  return normals;
}

}  // namespace lightgrid
