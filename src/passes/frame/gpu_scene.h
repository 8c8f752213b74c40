// The scene in OpenGL's memory: what the plan names of it, and no more.
#pragma once

#include <vector>

#include "gl/objects.h"
#include "plan/frame_plan.h"
#include "scene/scene.h"
#include "shared/material_params.h"

namespace lightgrid {

// A run of neighbouring triangles, small enough to be seen or not as a whole. Object space.
struct TriangleCluster {
  uint32_t first_index = 0, index_count = 0;  // in the scene's one index buffer
  Aabb bounds;
  // All its triangles face away from an eye e with dot(normalize(apex - e), axis) >= cutoff; a cutoff of 1 or more:
  // no eye sees none of them.
  glm::vec3 cone_apex{0}, cone_axis{0};
  float cone_cutoff = 2;
};

struct GpuMesh {
  int base_vertex = 0;
  std::vector<TriangleCluster> clusters;  // in index order
};

class GpuScene {
 public:
  // software_gl: colour textures are stored linear in 16 bits, since a software rasteriser would pay for the sRGB
  // curve at every texel of every sample.
  GpuScene(const Scene& scene, const FramePlan& plan, bool software_gl);

  const GpuMesh& mesh(int index) const { return meshes_[index]; }
  GLuint positions_only() const { return positions_only_.name(); }  // vertex array of the depth prepass
  GLuint all_streams() const { return all_streams_.name(); }

  // Binds the material's uniform block and the textures of `features`.
  void bind_material(int material, uint32_t features) const;

  // Where the plan has reversed triangles, the index buffer holds all triangles once more, last to first, each with its
  // corners in the same order: the indices [a, b) are there as [2 index_count() - b, 2 index_count() - a).
  uint32_t index_count() const { return index_count_; }

  size_t geometry_bytes() const { return geometry_bytes_; }  // without reversed triangles
  size_t reversed_triangle_bytes() const { return reversed_triangle_bytes_; }
  size_t texture_bytes() const { return texture_bytes_; }

 private:
  void upload_meshes(const Scene& scene, const FramePlan& plan, const std::vector<bool>& used);
  void upload_materials(const Scene& scene, const FramePlan& plan);
  void upload_texture(const Scene& scene, int texture);

  bool decode_srgb_once_;
  std::vector<GpuMesh> meshes_;
  std::vector<GlBuffer> buffers_;
  GlVertexArray positions_only_, all_streams_;
  GlBuffer materials_;
  size_t material_stride_ = 0;
  struct Slots {
    int texture[5];
  };
  std::vector<Slots> slots_;             // texture index per map, -1: none
  std::vector<GlTexture> textures_;
  std::vector<GlSampler> samplers_;
  uint32_t index_count_ = 0;
  size_t geometry_bytes_ = 0, reversed_triangle_bytes_ = 0, texture_bytes_ = 0;
};

}  // namespace lightgrid
