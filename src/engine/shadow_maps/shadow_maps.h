// Shadow maps of many lights in one buffer, drawn and looked up in OpenCL: an approximation, which leaks and
// acnes at the edges of shadows by about a texel (docs/shadow_maps.md). Exact: rays/ray_scene.h.
//
//   ShadowMaps maps(device, programs, options);
//   maps.draw(rays, plan_shadow_atlas(lights, view, rays.origin(), box, options));  // when anything moves
//
// Errors are of type Error alone, as ray_scene.h has them.
#pragma once

#include "cl/buffers.h"
#include "rays/ray_scene.h"
#include "shadow_maps/shadow_atlas.h"

namespace lightgrid {

class ShadowMaps {
 public:
  // Compiles nothing yet. `device` and `programs` outlive it.
  ShadowMaps(ClDevice& device, ProgramCache& programs, const ShadowMapOptions& options);

  // All triangles that cast and that a face sees, from both sides. Faces whose `kept` is set are not drawn,
  // if their texels are still there: they lie where an atlas that was drawn before had the same face, of
  // which no triangle in the light's range moved. Does not wait for the queue. Throws machine where a face's
  // texels have no 32-bit numbers. texels: where to, of atlas.bytes, into which all faces are drawn; null:
  // into a buffer of its own, which look_up() and arguments() read.
  void draw(const RayScene& rays, const ShadowAtlas& atlas, const std::vector<uint8_t>& kept = {},
            const cl::Buffer& texels = {});

  // How many of the taps are hidden, for 16 points a packet. Each point's `own` is the triangle that it lies
  // on. Waits for the queue. Throws input: a packet whose block or light does not exist. For tests: kernels
  // include kernels/shadow_maps/shadow_maps.h.
  std::vector<uint8_t> look_up(const RayScene& rays, std::span<const RayPoint> points,
                               std::span<const RayPacket> packets);

  // SHADOW_MAPS_ARGUMENTS and the -D of kernels/shadow_maps/shadow_maps.h.
  ClArguments arguments() const;
  std::string defines() const;
  // All faces', by ShadowFace::first: whole steps of the range in 2 or 4 bytes, or float metres.
  const cl::Buffer& texels() const { return texels_.get(); }
  size_t memory_bytes() const;  // on the device

 private:
  ClDevice& device_;
  ProgramCache& programs_;
  ShadowMapOptions options_;
  UploadedBuffer faces_, lights_, tiles_;
  GrowingBuffer texels_;
  size_t light_count_ = 0;                      // lights of the atlas that was drawn
  std::map<std::string, NamedKernel> kernels_;  // by file and defines
  bool lanes() const;
  NamedKernel& kernel(const std::string& name, const RayScene& rays);
};

}  // namespace lightgrid
