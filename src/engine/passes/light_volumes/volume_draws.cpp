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
//
// If the stencil has masks (MaskPlan::stencil_bits), a light is drawn only where its own shares a bit with
// the surface's; lights come sorted by their masks. Faces are then not counted: each turns the top bit over,
// only at pixels whose mask shares a bit. Behind a surface inside the volume there is an odd number of faces.
#include "passes/light_volumes/volume_draws.h"

#include "plan/settings/surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lightgrid {

VolumeDraws::VolumeDraws(PassContext& work, LightVolumes& volumes, const char* fragment,
                         std::vector<std::string> defines)
    : seen_(work), culling_(work.plan.settings[setting::volume_culling]), volumes_(volumes) {
  if (culling_ == VolumeCulling::depth_bounds) defines.emplace_back("DEPTH_BOUNDS");
  if (drawn_as_volumes()) defines.emplace_back("LIGHT_VOLUME");
  if (work.plan.masks.stencil_bits > 0) defines.emplace_back("EARLY_TESTS");
  program_ = &work.program(drawn_as_volumes() ? "shaders/light_volume.vert" : "shaders/screen.vert", fragment,
                           defines);
  if (culling_ == VolumeCulling::stencil)
    marking_ = &work.program("shaders/light_volume.vert", "shaders/depth.frag", {});
  if (work.plan.masks.stencil_bits > 0) masks_ = stencil_masks(work).of_light;
}

// True where (stencil & mask) != 0.
void VolumeDraws::test_mask(size_t volume) const {
  if (!masks_.empty()) glStencilFunc(GL_NOTEQUAL, 0, masks_[volumes_.volumes()[volume].light]);
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
    draw_back_faces(first, end);
  }
  glCullFace(GL_BACK);
  volumes_.end();
}

bool VolumeDraws::drawn_as_volumes() const {
  return culling_ == VolumeCulling::back_faces || culling_ == VolumeCulling::stencil;
}

void VolumeDraws::draw_back_faces(size_t first, size_t end) {
  if (masks_.empty()) return volumes_.draw(first, end - first);
  const auto mask_of_volume = [&](size_t i) { return masks_[volumes_.volumes()[i].light]; };
  glEnable(GL_STENCIL_TEST);
  for (size_t i = first, next = i; i < end; i = next) {
    while (next < end && mask_of_volume(next) == mask_of_volume(i)) ++next;
    test_mask(i);
    volumes_.draw(i, next - i);
  }
  glDisable(GL_STENCIL_TEST);
}

void VolumeDraws::draw_marked(size_t first, size_t end) {
  const GLuint marks = masks_.empty() ? 0xff : 0x80;
  glEnable(GL_STENCIL_TEST);
  glStencilMask(marks);
  for (size_t i = first; i < end; ++i) {
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDisable(GL_CULL_FACE);
    glDepthFunc(GL_GREATER);
    if (masks_.empty()) {
      glStencilFunc(GL_ALWAYS, 0, 0xff);
      glStencilOpSeparate(GL_BACK, GL_KEEP, GL_INCR_WRAP, GL_KEEP);
      glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_DECR_WRAP, GL_KEEP);
    } else {
      test_mask(i);
      glStencilOp(GL_KEEP, GL_INVERT, GL_KEEP);
    }
    glUseProgram(marking_->name());
    volumes_.draw(i, 1);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glEnable(GL_CULL_FACE);
    glDepthFunc(GL_LEQUAL);
    glStencilFunc(GL_NOTEQUAL, 0, marks);
    glStencilOp(GL_KEEP, GL_ZERO, GL_ZERO);
    glUseProgram(program_->name());
    volumes_.draw(i, 1);
  }
  glStencilMask(0xff);
  glDisable(GL_STENCIL_TEST);
}

void VolumeDraws::draw_rectangles(size_t first, size_t end) {
  const GlVertexArray nothing = make_vertex_array();
  glBindVertexArray(nothing.name());
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_SCISSOR_TEST);
  if (!masks_.empty()) glEnable(GL_STENCIL_TEST);
  glUseProgram(program_->name());
  const GLint light = program_->uniform("light"), depth_bounds = program_->uniform("depth_bounds");
  for (size_t i = first; i < end; ++i) {
    const LightVolume& volume = volumes_.volumes()[i];
    const ScreenBounds bounds = screen_bounds(seen_.view, volume);
    const glm::ivec2 size = bounds.end - bounds.first;
    glScissor(bounds.first.x, bounds.first.y, size.x, size.y);
    glUniform1ui(light, volume.light);
    test_mask(i);
    if (culling_ == VolumeCulling::depth_bounds) {
      glUniform2f(depth_bounds, bounds.depth.x, bounds.depth.y);
    }
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
  glBindVertexArray(0);
}

void begin_adding_lights(PassContext& work, GLuint framebuffer) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  if (work.plan.stencil && work.plan.masks.stencil_bits == 0) {
    const GLint nothing = 0;
    glStencilMask(0xff);
    glClearNamedFramebufferiv(framebuffer, GL_STENCIL, 0, &nothing);
  }
  glViewport(0, 0, work.grid().width, work.grid().height);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE);
  work.bind_lights();
}

namespace {

// The slack of light_volumes.cpp: float rounding under 1e-5 of the distances, and 1/256 of the radius.
double reach(const LightBounds& light) {
  const glm::dvec3 p = glm::abs(light.position);
  return light.radius_m * (1 + 1.0 / 256) + 1e-5 * (p.x + p.y + p.z + light.radius_m);
}

// The least slope, coordinate / distance, of what is in front of the eye of the circle of radius r about (c,
// d): its tangent's, a root of (d^2 - r^2) s^2 - 2 c d s + c^2 - r^2, written so that nothing cancels.
double min_slope(double c, double d, double r) {
  constexpr double none = -std::numeric_limits<double>::infinity();
  const double squared = c * c + d * d - r * r;
  if (squared <= 0) return none;  // the eye is in the circle
  const double root = r * std::sqrt(squared);
  if (c <= 0) return d > r ? (c * d - root) / ((d - r) * (d + r)) : none;
  return c * d + root > 0 ? (c - r) * (c + r) / (c * d + root) : none;
}

// Pixels between slopes (orthographic: coordinates), plus one on each side.
glm::ivec2 pixels_between(const glm::dvec2& slopes, double clip_scale, double clip_offset, int size) {
  const glm::dvec2 ndc = slopes * clip_scale + clip_offset;
  const glm::dvec2 pixels = (ndc * 0.5 + 0.5) * double(size);
  return glm::ivec2(
      glm::clamp(glm::dvec2(std::floor(pixels.x) - 1, std::ceil(pixels.y) + 1), 0.0, double(size)));
}

void cut_to_tangents(const View& view, const LightBounds& light, ScreenBounds& bounds) {
  const double r = reach(light), d = -light.position.z;
  const glm::dmat4& clip = view.clip_from_view;
  const int size[2] = {view.width, view.height};
  for (int axis = 0; axis < 2; ++axis) {
    const double c = light.position[axis];
    const glm::dvec2 slopes =
        view.orthographic ? glm::dvec2(c - r, c + r) : glm::dvec2(min_slope(c, d, r), -min_slope(-c, d, r));
    const double offset = view.orthographic ? clip[3][axis] : -clip[2][axis];
    const glm::ivec2 between = pixels_between(slopes, clip[axis][axis], offset, size[axis]);
    bounds.first[axis] = std::max(bounds.first[axis], between.x);
    bounds.end[axis] = std::max(std::min(bounds.end[axis], between.y), bounds.first[axis]);
  }
}

// Reversed depth at a distance along the view axis.
double depth_at(const View& view, double distance) {
  if (!view.orthographic && distance <= view.near_m) return 1;
  const glm::dvec4 clip = view.clip_from_view * glm::dvec4(0, 0, -distance, 1);
  return std::clamp(clip.z / clip.w, 0.0, 1.0);
}

}  // namespace

ScreenBounds screen_bounds(const View& view, const LightVolume& volume) {
  const LightBounds& light = volume.bounds;
  ScreenBounds bounds{volume.first, volume.end};
  if (!(reach(light) < 1e15)) return bounds;
  cut_to_tangents(view, light, bounds);
  const double nearest = std::max(-light.position.z - reach(light), -volume.center.z - volume.radius);
  const double farthest = std::min(-light.position.z + reach(light), -volume.center.z + volume.radius);
  // Two more float steps for the rounding here.
  bounds.depth.x = float(depth_at(view, farthest)) * (1 - 0x1p-22f);
  bounds.depth.y = float(depth_at(view, nearest)) * (1 + 0x1p-22f);
  return bounds;
}

}  // namespace lightgrid
