// A scene in OpenGL's memory: every mesh, material and texture, uploaded once, independent of its views
// (GpuScene::in_gl).
#pragma once

#include <map>
#include <vector>

#include "renderer/renderer.h"
#include "scene/animation.h"
#include "scene/scene.h"
#include "shared/material_params.h"

namespace lightgrid {

// A run of neighbouring triangles, small enough to be culled as a whole. Object space.
struct TriangleCluster {
  uint32_t first_index = 0, index_count = 0;  // in the scene's one index buffer
  Aabb bounds;
  // All its triangles face away from an eye e with dot(normalize(apex - e), axis) >= cutoff. A cutoff of 1 or
  // more never culls.
  glm::vec3 cone_apex{0}, cone_axis{0};
  float cone_cutoff = 2;
};

struct GlMesh {
  int base_vertex = 0;
  std::vector<TriangleCluster> clusters;  // in index order
};

class GlScene {
 public:
  // Both outlive it, and the renderer has OpenGL. Meshes that no instance shows are left out, and so are
  // their textures. A software OpenGL gets textures as linear 16 bits, because it would decode sRGB at every
  // texel of every sample, and filters 8 bits in fixed point.
  GlScene(const Renderer& renderer, const Scene& scene);

  // After the scene changed: uploads the vertices of meshes that deformed, and nothing else. Views read
  // instances, lights and cameras from the scene.
  void update(const SceneChanges& changes);

  const Scene& scene() const { return scene_; }
  const GlMesh& mesh(int index) const { return meshes_[index]; }

  // Vertex arrays over the scene's one vertex and index buffer: positions alone for the depth prepass, or all
  // streams.
  GLuint positions_only() const { return positions_only_.name(); }
  GLuint all_streams() const { return all_streams_.name(); }

  // Binds the material's uniform block and the textures of `features` (MaterialFeature).
  void bind_material(int material, uint32_t features) const;

  // The models of materials by number, as shared/model_records.h lays them out; uploaded at the first call.
  GLuint model_records();

  // Appends all triangles to the index buffer once more, last to first, each with its corners in the same
  // order. The indices [a, b) are repeated at [2 index_count() - b, 2 index_count() - a).
  void add_reversed_triangles();
  uint32_t index_count() const { return index_count_; }
  std::vector<uint32_t> read_indices()
      const;  // of all triangles in order, without the reversed ones, each of its mesh

  // A buffer texture: of each triangle of read_indices(), its number in its mesh, the first of several that
  // connect the same vertices. Made at the first call.
  GLuint triangle_numbers();

  size_t geometry_bytes() const { return geometry_bytes_; }  // without reversed triangles
  size_t reversed_triangle_bytes() const { return reversed_triangle_bytes_; }
  size_t texture_bytes() const { return texture_bytes_; }

 private:
  void upload_meshes(const std::vector<bool>& used);
  void update_mesh(int index);
  void upload_indices(const std::vector<uint32_t>& indices);
  void upload_materials(const std::vector<bool>& used_meshes);
  void upload_texture(int texture);

  const Renderer& renderer_;
  const Scene& scene_;
  std::vector<GlMesh> meshes_;
  std::vector<GlBuffer> streams_;
  GLuint stream_of_[6] = {};                        // by attribute location; 0: no material reads it
  std::map<int, std::vector<uint32_t>> deforming_;  // meshes that deform: their indices, cluster by cluster
  GlBuffer indices_, materials_, model_records_;
  GlBuffer triangle_numbers_;
  GlTexture triangle_numbers_texture_;
  GlBuffer absent_;  // zeros, then -1s, for streams that no mesh has
  GlVertexArray positions_only_, all_streams_;
  size_t material_stride_ = 0;
  struct Slots {
    int texture[MATERIAL_MAPS];
  };
  std::vector<Slots> slots_;  // texture index per map, -1: none
  std::vector<GlTexture> textures_;
  std::vector<GlSampler> samplers_;
  uint32_t index_count_ = 0;
  size_t geometry_bytes_ = 0, reversed_triangle_bytes_ = 0, texture_bytes_ = 0;
};

}  // namespace lightgrid
