// The reach of each point and spot light, as a mesh to draw.
//
// A volume contains the light's sphere, or the part of it in its cone, with slack for all rounding up to a
// shaded pixel: every pixel that a light reaches is inside the volume as OpenGL draws it. The slack assumes a
// rasteriser that snaps corners to a grid of 2^-subpixel_bits pixels.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "plan/settings/surfaces.h"
#include "renderer/pass_context.h"
#include "scene/view_lights.h"

namespace lightgrid {

// A closed mesh that encloses the reach of a light: the unit sphere, or a cone of it. Triangles are
// counter-clockwise, seen from outside; each edge belongs to two of them.
struct LightMesh {
  std::vector<glm::vec3> positions;
  std::vector<uint16_t> indices;
};

// Encloses the unit sphere; an icosahedron whose faces are cut into four `subdivisions` times.
LightMesh ball_mesh(int subdivisions);

// From -1 to 1 on each axis.
LightMesh box_mesh();

// Encloses points within the half-angle of the +z axis, up to pi / 2, at distance 1 or less from the apex,
// the origin.
LightMesh cone_mesh(double half_angle_rad);

// The cone of slope 1 around +z up to z = 1, for narrow cones: scaling x and y gives any slope.
LightMesh pyramid_mesh();

// A clip-space triangle over the whole screen at depth 0, seen from behind. Not closed: it is the far side of
// a volume that contains everything visible.
LightMesh everything_mesh();

struct LightVolume {
  static constexpr uint32_t everything = 0;  // a mesh in clip space, for lights that no sphere or cone can
                                             // enclose

  uint32_t light;             // index into the given lights, which are LightPlan::local's
  LightBounds bounds;         // bounds of the light
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
  explicit LightVolumes(PassContext& work);
  size_t memory_bytes() const override;
  bool follow(PassContext& work) override;

  // Computes and uploads the frame's volumes: the cost per frame of a moving camera or moving lights. In the
  // lights' order; where the stencil has masks, those of the same mask one after the other.
  const std::vector<LightVolume>& update(const ViewState& seen);
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
