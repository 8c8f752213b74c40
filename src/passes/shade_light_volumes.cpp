// Adds lights one after the other to the geometry buffer's image, and skips pixels out of their reach by one
// of the methods of Engel, "Designing a Renderer for Multiple Lights" (ShaderX7, 2009):
//
// scissor       The whole screen, cut to the rectangle of the light's tangents.
//
// depth-bounds  The same; pixels outside the depth interval leave the shader early. Few OpenGLs have such a test.
//
// back-faces    The volume's back faces where they are behind the surface: works with the eye inside the volume.
//
// stencil       Faces behind the surface are counted, back plus one, front minus one; nonzero means inside.
//               Then the same back faces are drawn where it is nonzero, and reset it to 0.
#include "passes/shade_light_volumes.h"

#include <algorithm>
#include <numeric>

#include "base/image.h"
#include "passes/common/light_source.h"
#include "passes/light_volumes/light_volumes.h"
#include "passes/light_volumes/screen_bounds.h"

namespace lightgrid {
namespace {

class VolumeDraws {
 public:
  VolumeDraws(RenderView& v, const GBuffer& gbuffer, const char* output)
      : v_(v),
        culling_(v.plan.settings.volume_culling),
        volumes_(v.state<LightVolumes>()) {
    std::vector<std::string> defines = base_lighting(v).defines;
    if (v.plan.spots) defines.emplace_back("SPOTS");
    for (const std::string& define : gbuffer_defines(gbuffer)) defines.push_back(define);
    if (culling_ == VolumeCulling::depth_bounds) defines.emplace_back("DEPTH_BOUNDS");
    if (drawn_as_volumes()) defines.emplace_back("LIGHT_VOLUME");
    if (output) defines.emplace_back(output);
    program_ = &v.program(drawn_as_volumes() ? "shaders/light_volume.vert" : "shaders/screen.vert",
                          "shaders/deferred_light.frag", defines);
    if (culling_ == VolumeCulling::stencil)
      marking_ = &v.program("shaders/light_volume.vert", "shaders/depth.frag", {});
  }

  const GlProgram& program() const { return *program_; }

  // Draws volumes first ... end - 1 into the bound framebuffer, which has the frame's depth.
  void draw(size_t first, size_t end) {
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

 private:
  bool drawn_as_volumes() const {
    return culling_ == VolumeCulling::back_faces || culling_ == VolumeCulling::stencil;
  }

  void draw_marked(size_t first, size_t end) {
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

  void draw_rectangles(size_t first, size_t end) {
    const GlVertexArray nothing = make_vertex_array();
    glBindVertexArray(nothing.name());
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_SCISSOR_TEST);
    glUseProgram(program_->name());
    const GLint light = program_->uniform("light"), depth_bounds = program_->uniform("depth_bounds");
    for (size_t i = first; i < end; ++i) {
      const LightVolume& volume = volumes_.volumes()[i];
      const ScreenBounds bounds =
          screen_bounds(v_.view, volumes_.lights()[volume.light], volume);
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

  RenderView& v_;
  VolumeCulling culling_;
  LightVolumes& volumes_;
  const GlProgram *program_ = nullptr, *marking_ = nullptr;
};

// Sets state for adding light to the image.
void begin_adding(RenderView& v, const GBuffer& gbuffer, GLuint framebuffer) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, v.view.width, v.view.height);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE);
  v.bind_lights();
  bind_gbuffer(gbuffer);
}

// Number of lights that one image of marks can distinguish: shaders/deferred_light.frag.
constexpr uint32_t lights_a_mark = 48;

// Draws the marks of all lights in batches, and calls visit(pixel, light) for each shader invocation.
template <typename Visit>
void visit_pairs(RenderView& v, const Visit& visit) {
  const GBuffer gbuffer = gbuffer_of(v);
  const int width = v.view.width, height = v.view.height;
  const GlTexture target = make_texture_2d(GL_RGBA32F, width, height);
  const GlFramebuffer framebuffer = make_framebuffer({target.name()}, gbuffer.depth);
  const std::vector<LightVolume>& volumes = v.state<LightVolumes>().volumes();
  VolumeDraws draws(v, gbuffer, "MARK");
  Image marks(width, height);
  for (size_t first = 0, end = 0; first < volumes.size(); first = end) {
    const uint32_t first_light = volumes[first].light;
    while (end < volumes.size() && volumes[end].light - first_light < lights_a_mark) ++end;
    const float nothing[4] = {0, 0, 0, 0};
    glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, 0, nothing);
    begin_adding(v, gbuffer, framebuffer.name());
    glUseProgram(draws.program().name());
    glUniform1ui(draws.program().uniform("first_light"), first_light);
    draws.draw(first, end);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, marks.pixels.data());
    for (size_t pixel = 0; pixel < marks.pixels.size(); ++pixel) {
      for (uint32_t channel = 0; channel < 4; ++channel) {
        uint32_t digits = uint32_t(marks.pixels[pixel][int(channel)]);
        for (uint32_t light = first_light + 12 * channel; digits > 0; ++light, digits /= 4) {
          for (uint32_t times = digits % 4; times > 0; --times) visit(pixel, light);
        }
      }
    }
  }
  glDisable(GL_BLEND);
}

}  // namespace

void shade_light_volumes(RenderView& v, const GBuffer& gbuffer) {
  if (!v.plan.local_lights) return;
  auto pass = v.timer.pass("shade_light_volumes", "gl");
  LightVolumes& volumes = v.state<LightVolumes>();
  volumes.update(v, v.plan.settings.volume_mesh);
  if (v.plan.stencil) {
    const GLint nothing = 0;
    glStencilMask(0xff);
    glClearNamedFramebufferiv(gbuffer.image.framebuffer, GL_STENCIL, 0, &nothing);
  }
  begin_adding(v, gbuffer, gbuffer.image.framebuffer);
  VolumeDraws(v, gbuffer, nullptr).draw(0, volumes.volumes().size());
  glDisable(GL_BLEND);
  const size_t pixels = size_t(v.view.width) * v.view.height;
  pass.moves(pixels * (4 + 16 + gbuffer.bytes()), pixels * 16);
}

ListedLights listed_of_light_volumes(RenderView& v) {
  ListedLights lists;
  const size_t pixels = size_t(v.view.width) * v.view.height;
  lists.count.resize(pixels), lists.cell_of_pixel.resize(pixels);
  if (!v.plan.local_lights) return list_every_light(0);
  visit_pairs(v, [&](size_t pixel, uint32_t) { ++lists.count[pixel]; });
  std::iota(lists.cell_of_pixel.begin(), lists.cell_of_pixel.end(), 0u);
  place_lists(lists);
  std::vector<uint64_t> next = lists.first;
  visit_pairs(v, [&](size_t pixel, uint32_t light) { lists.indices[next[pixel]++] = light; });
  return lists;
}

}  // namespace lightgrid
