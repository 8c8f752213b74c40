// What is kept of shadows from frame to frame (shared/shadow_certificates.h): certificates, in a table of the
// size that the setting shadow-kept says, and tiles with their bits; and what of it a change ends.
#pragma once

#include <vector>

#include "cl/buffers.h"
#include "cl/launch.h"
#include "culling/light_culler.h"
#include "passes/shadows/moved_instances.h"
#include "renderer/work.h"
#include "shared/shadow_records.h"

namespace lightgrid {

// All that the points of a view's pixels depend on but their depths and triangles, and how rays are traced.
struct ShadowSight {
  ShadowView view;
  ViewParams params;
  size_t layers;  // of blended surfaces: those that the frame before did not have kept nothing then
  std::vector<int32_t> number_offsets;
  std::string defines;
  bool operator==(const ShadowSight&) const;
};

class ShadowCertificates {
 public:
  // What the setting says, 0: none are kept.
  static size_t bytes_of(const Settings& settings);

  // bytes: a power of two, at least 64 KiB.
  ShadowCertificates(ClDevice& device, size_t bytes);

  // After the scene or the view changed. rays: of the scene as it is now; all_lights: by their indices in the
  // plan, as shining, whether or not this frame finds their shadows; directional ones have their direction
  // and no range.
  void follow(Work& work, const RayScene& rays, const std::vector<CullLight>& all_lights, ShadowSight sight);
  // ShadowLight::stamp: what is kept of another one is not found again.
  uint32_t stamp(size_t light) const { return stamps_[light]; }
  uint32_t sight_stamp() const { return sight_stamp_; }  // ShadowView::stamp

  // CERTIFICATE_ARGUMENTS and KEPT_TILE_ARGUMENTS, for the next frame. pairs: of a tile and a light.
  ClArguments arguments(ClDevice& device, size_t tiles, size_t pairs);
  size_t decided(ClDevice& device) const;  // in the last frame; waits
  size_t memory_bytes() const;

 private:
  void renew(size_t light) { stamps_[light] = ++last_stamp_; }

  cl::Buffer table_;
  GrowingBuffer decided_;
  GrowingBuffer tiles_, surfaces_, bits_[2];  // KeptShadows of this frame and the last in turn
  size_t tile_count_ = 0;
  uint32_t frames_ = 0, last_stamp_ = 0, sight_stamp_ = 0;
  ShadowSight sight_{};
  std::vector<CullLight> lights_;
  std::vector<uint32_t> stamps_;
  MovedInstances moved_;
};

}  // namespace lightgrid
