// The geometry that views of a scene draw (raster/raster_view.h): on the device once, for any number of
// views. Needs OpenCL only. Errors are of type Error, as raster_view.h has them.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <span>

#include "cl/device.h"

namespace lightgrid {

// Object space. Three indices a triangle, each below positions.size(), counter-clockwise seen from the front.
// Both are copied.
struct RasterMesh {
  std::span<const glm::vec3> positions;  // one a vertex, metres or the instance's unit
  std::span<const uint32_t> indices;     // three a triangle
  // Its triangles are taken in the order of its indices, as views with RasterOptions::drawing_order need;
  // else in one that leaves out more of those that are out of view or face away. Images are the same.
  bool drawing_order = false;
};

// The data that decide which pixels triangles of instances with an alpha material cover
// (shared/surface_records.h). The buffers are kept alive, not copied.
struct RasterMasks {
  cl::Buffer vertices;   // SurfaceVertex each, of all meshes one after the other
  cl::Buffer materials;  // SurfaceMaterial each, by alpha_material
  cl::Buffer alphas;     // chains of alphas, four a texel
};

// Meshes on a device, and the masks of their materials.
class RasterScene {
 public:
  // `device` outlives it, and it outlives its views. It may be moved.
  explicit RasterScene(ClDevice& device);
  ~RasterScene();
  RasterScene(RasterScene&&) noexcept;

  // Throws input: an index out of range, a number of indices that is no multiple of 3; machine: 2^32 - 64
  // indices or vertices, or more. Each view then needs its instances again.
  void set_meshes(std::span<const RasterMesh> meshes);
  // From the next frame of each view. Null buffers: masked triangles are drawn whole. Throws input where some
  // are null and others are not.
  void set_masks(const RasterMasks& masks);

  size_t geometry_bytes() const;  // bytes of positions and indices as given
  size_t memory_bytes() const;    // on the device, without the masks'

 private:
  friend class RasterView;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lightgrid
