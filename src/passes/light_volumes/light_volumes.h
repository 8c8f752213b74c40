// What each point and spot light reaches, as a mesh to draw.
//
// A volume contains the light's ball, or the part of it in its cone, with slack for all that rounds between here and a
// shaded pixel: a pixel that a light reaches is inside the volume as OpenGL draws it. Slack covers a rasteriser whose
// corners lie on a grid of 2^-subpixel_bits pixels.
#pragma once

#include <span>

#include "renderer/render_view.h"
#include "passes/light_volumes/light_meshes.h"
#include "scene/view_lights.h"

namespace lightgrid {

struct LightVolume {
  static constexpr uint32_t everything = 0;  // a mesh drawn in clip space, for what no ball or cone can hold

  uint32_t light;             // of those given, which are FramePlan::local's
  uint32_t mesh;              // of light_meshes()
  glm::dmat4 view_from_mesh;  // of `everything`: nothing
  glm::mat4 clip_from_mesh;
  glm::dvec3 center;          // a ball around the mesh, view space; `everything`: of infinite radius
  double radius;
  bool crosses_near;          // a part is nearer than the near plane: its front faces have a hole there
  glm::dvec2 low_px, high_px; // on screen: no pixel has its centre in it outside these
  glm::ivec2 first, end;      // the pixels of that: first <= p < end
};

// Every mesh that a volume may have.
const std::vector<LightMesh>& light_meshes();

// In the lights' order. A light that cannot reach anything in view has none: it is off the screen, or its radius is not
// above 0.
// `meshes`: those of balls; under `box` also those of cones.
std::vector<LightVolume> light_volumes(const View& view, std::span<const ViewLight> lights, VolumeMeshes meshes,
                                       int subpixel_bits);

// Draws volumes through shaders/common/light_volume.glsl. One vertex buffer for all meshes; matrix and light are attributes of
// an instance.
class LightVolumes : public PassState {
 public:
  explicit LightVolumes(RenderView& v);
  size_t memory_bytes() const override;
  bool follow(RenderView& v) override;

  // The frame's volumes, made anew and uploaded: what a camera or lights that move cost in each frame.
  const std::vector<LightVolume>& update(RenderView& v, VolumeMeshes meshes);
  // The same in an order of the caller's: what draw() then counts by.
  void upload(std::vector<LightVolume> volumes);
  const std::vector<LightVolume>& volumes() const { return volumes_; }
  // Point and spot lights of the last update, by LightVolume::light.
  const std::vector<ViewLight>& lights() const { return lights_; }

  // Between these, the vertex array is bound, near and far do not clip but for GL_CLIP_DISTANCE0 at the near plane, faces
  // are counter-clockwise and none is culled. Stencil, depth test and blending are the caller's.
  void begin() const;
  void end() const;

  // Volumes first ... first + count - 1, in this order; those that follow each other with one mesh in one call.
  void draw(size_t first, size_t count) const;

 private:
  std::vector<LightVolume> volumes_;
  std::vector<ViewLight> lights_;
  GlBuffer vertices_, indices_, instances_;
  GlVertexArray array_;
  struct Range {
    GLint base_vertex;
    GLsizei count;
    size_t first_index_byte;
  };
  std::vector<Range> ranges_;  // one a mesh
  size_t mesh_bytes_ = 0, instance_bytes_ = 0;
  int subpixel_bits_ = 4;
};

}  // namespace lightgrid
