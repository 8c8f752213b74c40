// The part of a scene that is uploaded: its shown meshes, its materials and their textures as the resolve
// kernels read them (shared/surface_records.h), its models.
#pragma once

#include <new>
#include <vector>

#include "plan/settings.h"
#include "plan/settings/surfaces.h"
#include "scene/scene.h"
#include "shared/model_records.h"
#include "shared/surface_records.h"

namespace lightgrid {

// Memory that a CPU's OpenCL can use as a buffer without a copy: aligned as its widest vectors are.
template <typename T>
struct BufferMemory {
  using value_type = T;
  static constexpr std::align_val_t alignment{128};
  BufferMemory() = default;
  template <typename U>
  BufferMemory(const BufferMemory<U>&) {}
  T* allocate(size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), alignment)); }
  void deallocate(T* values, size_t) { ::operator delete(values, alignment); }
  bool operator==(const BufferMemory&) const = default;
};
template <typename T>
using BufferVector = std::vector<T, BufferMemory<T>>;

struct SurfaceTexels {
  std::vector<SurfaceMaterial> materials;  // in the scene's order; unused ones have only factors
  BufferVector<uint16_t> texels_4;         // chains of 4 channels: RGBA of one texture
  // Chains of 8 channels, all maps of a material in one texel: base colour (3), normal (3), roughness,
  // metalness. A map that the material lacks is 1 everywhere, and its factor alone counts.
  BufferVector<uint16_t> texels_8;
  // The same chains with TexelLayout::packed_8, in bytes: base colours as their square roots, whose steps the
  // eye sees alike.
  BufferVector<uint8_t> small_texels_8;
  BufferVector<uint32_t>
      alphas;  // chains of alpha_quads, for masked materials, and for blended ones if asked for
};

// Textures that no used material has are left out. A texture or a set of packed ones is there once, however
// many materials share it. Maps are packed, unless TexelLayout::separate, where a material has two or more of
// base colour, metallic-roughness and normal map, of one size, with one sampler and one set of texture
// coordinates, and is not blended: a packed texel has no alpha.
SurfaceTexels surface_texels(const Scene& scene, const std::vector<bool>& used_materials, TexelLayout layout,
                             bool blended_alphas = false);

// By mesh: true if an instance shows it and it has triangles. OpenGL's and OpenCL's copies of a scene, and
// the rasteriser's, leave out the others: their vertices are numbered alike.
std::vector<bool> shown_meshes(const Scene& scene);

// By number. MOST_MODELS + 1 records, whatever the scene has: those without a model are Lambert's, so that no
// number that a kernel reads past the end of an image is past the end of the table. Models past MOST_MODELS
// are left out.
std::vector<MaterialModelRecord> model_records(const Scene& scene);

}  // namespace lightgrid
