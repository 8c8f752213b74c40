// Triangles to visibility: the number and the depth of the nearest triangle at each pixel. Needs OpenCL only.
//
//   RasterScene scene(device);
//   scene.set_meshes(meshes);                     // when they change
//   RasterView view(scene, programs, options);    // any number: a camera, a second eye, a shadow map
//   view.set_instances(instances);                // when they change or move
//   view.set_camera(camera);                      // each frame
//   const Visibility visibility = view.draw();
//   culler.depth_bounds({visibility.depth});
//
// A visibility buffer (Burns, Hunt, "The Visibility Buffer: A Cache-Friendly Approach to Deferred Shading",
// JCGT 2013), filled by tiles in software (Laine, Karras, "High-Performance Software Rasterization on GPUs",
// HPG 2011).
//
// The picture depends on meshes, instances and camera only: the same bytes on every device that
// rounds divisions correctly, in every kernel shape, for any number of threads. docs/raster.md has the
// arithmetic; in short:
//
// - A vertex is transformed in float, by a matrix that the host makes in double relative to the eye, and
//   snapped once to 1/256 pixel. Coverage of the snapped triangle is exact, at pixel centres, by the top-left
//   rule: a centre on an edge belongs to the triangle of which it is a left edge, or a horizontal top edge
//   (rows count upwards).
// - A triangle that crosses the near plane or leaves a guard band, 16,368 pixels on either side of the view's
//   centre, is cut. Where an edge is cut depends on its two end points alone, so that neighbours meet without
//   a gap.
// - Depth is that of the triangle itself, neither snapped nor cut, clamped to its corners' depths; of one
//   thinner than snapping moves corners, that of the snapped one. A depth below 2^-126, as at or past the far
//   plane, is not drawn. docs/raster.md has its error.
// - The greatest depth wins (depth is reversed). Of equal ones the highest triangle number wins, which is the
//   one drawn last, as with OpenGL's GL_GEQUAL.
// - A triangle with a corner that is not finite in clip space is left out and counted.
// - Clusters of triangles that all face away are left out early. OpenGL draws such a triangle where it is so
//   thin on the screen that snapping turns it towards the eye; so does RasterOptions::cluster_cones = false.
//
// Errors are of type Error (base/error.h) alone: input where an argument is wrong or a call is missing,
// machine where the device or its memory does not suffice. Nothing is left out to make it fit: room that
// proves short is counted, grown, and the frame drawn again. Objects of one device are for one thread at a
// time. The geometry is the scene's (raster/raster_scene.h); a view holds its instances, their positions in
// clip space, lists of triangles and its image.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <span>

#include "base/pixel_grid.h"
#include "cl/device.h"
#include "cl/program_cache.h"
#include "raster/raster_samples.h"
#include "raster/raster_scene.h"
#include "shared/cull_settings.h"
#include "shared/raster_instance.h"
#include "shared/sample_masks.h"

namespace lightgrid {

// A mesh at a place.
struct RasterInstance {
  int mesh = 0;                     // by its number in set_meshes
  glm::dmat4 world_from_object{1};  // affine, finite; front faces turn around if it mirrors (base/facing.h)
  bool two_sided = false;           // true: its back faces are drawn too
  int alpha_material = -1;          // 0 or more: the material whose alpha decides which pixels it covers
  bool drawn = true;                // false: its triangles keep their numbers and are left out
};

// The view that is drawn.
struct RasterCamera {
  // 1 to 16,384 pixels a side. A pixel has 1 sample, at its centre, or 2, 4 or 8 (raster/raster_samples.h),
  // drawn in one pass.
  PixelGrid grid;
  // As CullView's: m[column][row], depth zero to one, here always reversed (near 1, far 0); perspective or
  // orthographic, off-centre, far plane infinite or not.
  glm::dmat4 clip_from_view{1};
  glm::dmat4 view_from_world{1};  // rigid; its translation is not used
  glm::dvec3 eye{0};              // world, metres
};

// Visibility::triangle where no triangle is.
constexpr uint32_t no_triangle = 0xffffffffu;

// The view's own buffers, written again by the next draw(), of grid.values() values in PixelGrid's order.
struct Visibility {
  static constexpr size_t spare_pixels = 16;  // depth values that kernels may read past its end
  // A sample: uint, the nearest triangle's number, or no_triangle; float, reversed z / w of clip_from_view, 0
  // where no triangle is: DepthInput::values.
  cl::Buffer triangle, depth;
  PixelGrid grid;
};

// The data that a triangle number refers to, on the device. Made by set_instances, with the scene's
// `indices`; each draw() writes `clip`.
struct RasterBuffers {
  cl::Buffer indices;            // uint[3] a triangle of each mesh, mesh after mesh
  cl::Buffer instances;          // RasterInstanceRecord an instance
  cl::Buffer triangle_instance;  // uint a triangle number: its instance
  cl::Buffer clip;               // float4 (x, y, z, w) a vertex of each instance
};

// How a view draws. But for `masks` the image does not depend on them, other than thin triangles (above).
struct RasterOptions {
  KernelShape shape = KernelShape::automatic;  // lanes on a CPU, group elsewhere; the same bytes
  bool portable = false;                       // no builtins of one kind of CPU; the same bytes
  bool cluster_cones = true;                   // leaves out clusters that face away
  bool wide_atomics = true;    // group shape: false uses 32-bit atomics, in two passes; the same bytes
  bool drawing_order = false;  // for list(): triangles in drawing order; by the lanes shape on any device
  SampleMasks masks = SampleMasks::centre;  // with several samples per pixel
};

// The triangles of each tile of RASTER_TILE x RASTER_TILE pixels (shared/raster_params.h), for passes that
// draw them otherwise: tile t, x fastest from the lower left, has records[lists[i]] for i from tile_begin[t]
// to below tile_begin[t + 1]. The view's own buffers, written again by the next draw() or list().
struct RasterLists {
  cl::Buffer records, tile_begin, lists;  // RasterRecord each (shared/raster_params.h); uint each; uint each
  uint32_t tiles_x = 0, tiles_y = 0;      // tiles, the last ones may be cut
};

// The counts of the last draw().
struct RasterCounts {
  uint64_t triangles = 0;          // triangles of all drawn instances
  uint64_t clusters = 0;           // clusters of up to 64 triangles that may be in view
  uint64_t records = 0;            // triangles, or parts that clipping left, that were rasterised
  uint64_t tile_entries = 0;       // pairs of a record and a tile of 64 x 64 pixels
  uint64_t invalid_triangles = 0;  // left out since a corner is not finite
  int redone = 0;                  // how often room was short and the frame was drawn again
};

class RasterPipeline;

// One camera's image of a scene, again and again.
class RasterView {
 public:
  // Compiles the kernels. `scene` and `programs`, both of one device, outlive it.
  RasterView(const RasterScene& scene, ProgramCache& programs, const RasterOptions& options = {});
  ~RasterView();
  RasterView(RasterView&&) noexcept;

  // Triangles are numbered from 0 in this order, each instance's in the order of its mesh's indices. Throws
  // input: a mesh that does not exist, or that is not in drawing order where RasterOptions::drawing_order
  // asks for it; a matrix that is not finite or not affine; machine: 2^31 triangles or 2^32 - 64 vertices or
  // more, before it takes memory for them.
  void set_instances(std::span<const RasterInstance> instances);
  // As RasterInstance::drawn, from now on. Throws input: there is no such instance.
  void set_drawn(size_t instance, bool drawn);
  // Throws input: a size out of range, a matrix or an eye that is not finite, a projection that is not of the
  // kinds above.
  void set_camera(const RasterCamera& camera);

  // Throws input where set_camera is missing, where the scene's meshes were set again after set_instances,
  // and where its masks have fewer vertices or materials than meshes and instances need. Waits for the queue,
  // after a call of `meanwhile`: work of the host that the device does not need yet.
  Visibility draw(const std::function<void()>& meanwhile = {});

  // The same without an image, for pixels' centres alone: blended surfaces are laid over one another from
  // these lists. Throws input without RasterOptions::drawing_order too. Parts of a triangle that clipping
  // left follow up to 15 triangles of its mesh that come after it.
  RasterLists list();

  const RasterBuffers& buffers() const;  // null before set_instances
  const RasterCounts& counts() const;    // counts of the last draw() or list()
  size_t memory_bytes() const;           // on the device, without the scene's

 private:
  void run(bool image, const std::function<void()>& meanwhile);
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lightgrid
