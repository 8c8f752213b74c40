// The reach of each point and spot light, as a mesh to draw.
//
// A volume contains the light's sphere, or the part of it in its cone, with slack for all rounding up to a
// shaded pixel: every pixel that a light reaches is inside the volume as OpenGL draws it. The slack assumes a
// rasteriser that snaps corners to a grid of 2^-subpixel_bits pixels.
#pragma once

#include <span>

#include "passes/light_volumes/light_meshes.h"
#include "renderer/pass_caches.h"
#include "scene/view_lights.h"

namespace lightgrid {

struct LightVolume {
  static constexpr uint32_t everything = 0;  // a mesh in clip space, for lights that no sphere or cone can
                                             // enclose

  uint32_t light;             // index into the given lights, which are FramePlan::local's
  LightBounds bounds;         // of the light
  uint32_t mesh;              // index into light_meshes()
  glm::dmat4 view_from_mesh;  // unused for `everything`
  glm::mat4 clip_from_mesh;
  glm::dvec3 center;  // a sphere around the mesh, view space; `everything`: infinite radius
  double radius;
  bool crosses_near;           // a part is nearer than the near plane: front faces have a hole there
  glm::dvec2 low_px, high_px;  // bounds on screen, pixels
  glm::ivec2 first, end;       // pixels with their centre in these bounds: first <= p < end
};

// Every mesh that a volume may use.
const std::vector<LightMesh>& light_meshes();

// In the lights' order. Lights that cannot reach anything in view are omitted: off the screen, or of radius 0
// or below. `meshes` selects the meshes of spheres; `box` also those of cones.
std::vector<LightVolume> light_volumes(const View& view, std::span<const ViewLight> lights,
                                       VolumeMeshes meshes, int subpixel_bits);

// Draws volumes with shaders/common/light_volume.glsl. One vertex buffer for all meshes; matrix and light are
// attributes of an instance.
class LightVolumes : public PassCache {
 public:
  explicit LightVolumes(Work& work, const Seen& seen);
  size_t memory_bytes() const override;
  bool follow(Work& work, const Seen& seen) override;

  // Computes and uploads the frame's volumes: the cost per frame of a moving camera or moving lights.
  const std::vector<LightVolume>& update(const Seen& seen, VolumeMeshes meshes);
  // The same in the caller's order, to which the indices of draw() refer.
  void upload_volumes(std::vector<LightVolume> volumes);
  const std::vector<LightVolume>& volumes() const { return volumes_; }

  // Between begin() and end(), the vertex array is bound, only GL_CLIP_DISTANCE0 at the near plane clips in
  // depth, faces are counter-clockwise and none is culled. Stencil, depth test and blending are the caller's.
  void begin() const;
  void end() const;

  // Draws volumes first ... first + count - 1 in this order, successive ones with the same mesh in one call.
  void draw(size_t first, size_t count) const;

 private:
  std::vector<LightVolume> volumes_;
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
