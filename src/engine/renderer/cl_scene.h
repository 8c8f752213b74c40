// A scene's surfaces in OpenCL memory, for passes that shade triangles without OpenGL: attributes of
// vertices, materials and textures with their mip chains, each uploaded once, whatever its views see.
// Positions and indices are the rasteriser's.
#pragma once

#include <vector>

#include "cl/device.h"
#include "plan/settings.h"
#include "plan/settings/surfaces.h"
#include "scene/animation.h"
#include "scene/scene.h"
#include "shared/surface_records.h"

namespace lightgrid {

class ClScene {
 public:
  // Both outlive it. Meshes that no instance shows have no vertices, and textures that only such meshes use
  // are left out. `layout`: whether the maps of a material are packed into one chain where their sizes,
  // samplers and texture coordinates agree. Throws Error(machine) where memory runs out.
  ClScene(ClDevice& device, const Scene& scene, TexelLayout layout);

  // After the scene changed: uploads the attributes of meshes that deformed.
  void update(const SceneChanges& changes);

  // Attributes, SurfaceVertex each, of the scene's meshes one after the other. Materials, SurfaceMaterial
  // each, in the scene's order.
  const cl::Buffer& vertices() const { return vertices_; }
  const cl::Buffer& materials() const { return materials_; }

  // Chains of texels (renderer/upload/texel_chain.h): of 4 and of 8 channels, and of alphas alone.
  const cl::Buffer& texels_4() const { return texels_4_; }
  const cl::Buffer& texels_8() const { return texels_8_; }
  const cl::Buffer& alphas() const { return alphas_; }

  // MaterialFeature, of all meshes together: kernels are built for them.
  uint32_t features() const { return features_; }
  size_t texture_bytes() const { return texture_bytes_; }
  size_t memory_bytes() const { return vertex_bytes_ + material_bytes_ + texture_bytes_; }

 private:
  void write_attributes(int mesh, SurfaceVertex* to) const;

  ClDevice& device_;
  const Scene& scene_;
  std::vector<size_t> first_vertex_;  // by mesh, and the number of all
  std::vector<bool> shown_;           // by mesh
  cl::Buffer vertices_, materials_, texels_4_, texels_8_, alphas_;
  uint32_t features_ = 0;
  size_t vertex_bytes_ = 0, material_bytes_ = 0, texture_bytes_ = 0;
};

}  // namespace lightgrid
