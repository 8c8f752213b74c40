// Any-hit shadow rays: whether a segment from a light to a point meets a triangle. Needs OpenCL with doubles
// (cl_khr_fp64) only.
//
//   RayScene scene(device, programs);
//   scene.set_meshes(meshes);                     // when they change
//   scene.set_instances(instances);               // when they change or move
//   std::vector<uint32_t> bits = scene.occlusion(points, lights, packets);
//
// or in a kernel of the host program's own: kernel_text().
//
// Exact: an answer is that of real arithmetic, unless the segment passes within the rounding of its ends from
// a triangle's edge or from its end to a triangle. It depends on meshes, instances, light and point alone:
// the same bits in both kernel shapes, for any tree, and on every device that rounds divisions correctly.
// Neighbours that share two corners leave no gap. docs/rays.md has the arithmetic.
//
// Errors are of type Error (base/error.h) alone: input where an argument is wrong or a call is missing,
// machine where the device or its memory does not suffice. Objects of one device are for one thread at a
// time.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cl/device.h"
#include "cl/launch.h"
#include "cl/program_cache.h"
#include "shared/cull_settings.h"

namespace lightgrid {

// Object space. Three indices a triangle, each below positions.size(). Both are copied.
struct RayMesh {
  std::span<const glm::vec3> positions;  // one a vertex
  std::span<const uint32_t> indices;     // three a triangle
};

// Masks that let light through triangles with an alpha material, where its alpha at the point that is met is
// below the cutoff: bilinear at the base level, or nearest where the map magnifies so. The buffers are kept
// alive, not copied.
struct RayMasks {
  cl::Buffer vertices;   // SurfaceVertex each (shared/surface_records.h), of all meshes one after the other
  cl::Buffer materials;  // SurfaceMaterial each, by alpha_material
  cl::Buffer alphas;     // chains of alphas, four a texel
};

// A mesh at a place.
struct RayInstance {
  int mesh = 0;                     // by its number in set_meshes
  glm::dmat4 world_from_object{1};  // affine, finite
  int alpha_material = -1;          // 0 or more: the material whose alpha decides where it lets light through
  bool casts = true;                // false: its triangles have numbers and hide nothing
  bool blends =
      false;  // alpha hides that share of a light, in place of a cutoff: for kernels (rays_share) alone
};

// Choices of a RayScene.
struct RayOptions {
  KernelShape shape =
      KernelShape::automatic;  // shape of occlusion(): lanes on a CPU, group elsewhere; the same bits
  // Else the centre of the instances' bounds when they are set first, rounded to floats.
  std::optional<glm::dvec3> origin;
};

// Relative to the scene's origin, metres.
struct RayPoint {
  glm::vec3 position{0};  // position on the surface
  float gap = 1e-3f;      // the last metres before it, in which nothing hides it
  int own = -1;           // the triangle that it lies on, which does not hide it
};

// w 1: a point relative to the scene's origin. w 0: x y z is a unit direction, from points towards the light.
using RayLight = glm::dvec4;

// 16 points, from 16 * block on, that share a light.
struct RayPacket {
  uint32_t block = 0, light = 0;  // index of the points over 16; of the light
  uint32_t lanes = 0xffff;        // a bit for each point that is meant
};

// Triangles that hide lights, and the tree over them.
class RayScene {
 public:
  // Compiles nothing yet. `device` and `programs` outlive it. Throws machine: no cl_khr_fp64; input: an
  // origin that is not finite.
  RayScene(ClDevice& device, ProgramCache& programs, const RayOptions& options = {});
  ~RayScene();
  RayScene(RayScene&&) noexcept;

  // A new origin discards the tree: instances then have to come again. Throws input: it is not finite.
  void set_origin(const glm::dvec3& origin);
  // Instances then have to come again. Throws input: an index out of range, a number of indices that is no
  // multiple of 3.
  void set_meshes(std::span<const RayMesh> meshes);
  // Null buffers: masked triangles hide light whole. Throws input where some are null and others are not.
  void set_masks(const RayMasks& masks);
  // Triangles are numbered from 0 in this order, each instance's in the order of its mesh's indices. The
  // first call builds the tree on the host. After one with as many instances, of which no more changed than
  // matrices and the meshes' positions, the device refits what moved, and the origin stays: answers are those
  // of a tree built anew at this origin. A tree grows worse as triangles move apart: set_meshes({}) discards
  // it. Throws input: a mesh that does not exist, a matrix that is not finite or not affine; machine: 2^31
  // triangles or more.
  void set_instances(std::span<const RayInstance> instances);

  // A bit for each of the packets' points that is hidden: 16 a packet. Waits for the queue. Throws input: a
  // packet whose block or light does not exist, masks with fewer vertices or materials than the scene needs.
  std::vector<uint32_t> occlusion(std::span<const RayPoint> points, std::span<const RayLight> lights,
                                  std::span<const RayPacket> packets);

  glm::dvec3 origin() const;                       // each coordinate is a float
  uint32_t triangles() const;                      // triangles of all instances, also those left out
  uint32_t first_triangle(size_t instance) const;  // its number
  // Left out, since a corner is not finite or further than 1e15 m from the origin.
  uint32_t invalid_triangles() const;
  int builds() const;  // builds of the tree, until now

  // For kernels that include kernels/rays/rays.h: RAYS_ARGUMENTS, and the -D that it takes. Both may differ
  // after each set_... Throw input: there are no instances; masks as occlusion() does.
  ClArguments arguments() const;
  std::string defines() const;
  // kernels/rays/rays.h with all that it includes, for ProgramCache::kernel_of_source: put before it.
  static std::string kernel_text();
  size_t memory_bytes() const;  // on the device

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lightgrid
