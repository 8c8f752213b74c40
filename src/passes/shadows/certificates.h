// Certificates of shadows, kept from frame to frame in a table of the size that the setting shadow-kept says
// (kernels/shadows/certificates.h), and what of them a change of the scene ends.
#pragma once

#include <vector>

#include "cl/buffers.h"
#include "cl/launch.h"
#include "culling/light_culler.h"
#include "renderer/work.h"

namespace lightgrid {

class ShadowCertificates {
 public:
  // What the setting says, 0: none are kept.
  static size_t bytes_of(const Settings& settings);

  // bytes: a power of two, at least 64 KiB.
  ShadowCertificates(ClDevice& device, size_t bytes);

  // After the scene or the view changed. rays: of the scene as it is now; all_lights: by their indices in the
  // plan, as shining, whether or not this frame finds their shadows.
  void follow(Work& work, const RayScene& rays, const std::vector<CullLight>& all_lights);
  // ShadowLight::stamp: certificates of another one are not found again.
  uint32_t stamp(size_t light) const { return stamps_[light]; }

  // CERTIFICATE_ARGUMENTS, for the next frame. parts: counts of decided pairs.
  ClArguments arguments(ClDevice& device, size_t parts);
  size_t decided(ClDevice& device) const;  // in the last frame; waits
  size_t table_bytes() const { return lightgrid::bytes_of(table_); }
  size_t memory_bytes() const { return table_bytes() + decided_.bytes(); }

 private:
  struct Placed {
    glm::dmat4 world_from_object;
    int mesh_version;
    WorldBox box;
  };
  void renew(size_t light) { stamps_[light] = ++last_stamp_; }

  cl::Buffer table_;
  GrowingBuffer decided_;
  size_t parts_ = 0;
  uint32_t frames_ = 0, last_stamp_ = 0;
  int builds_ = 0;  // of the tree that the triangles' places are of
  std::vector<CullLight> lights_;
  std::vector<uint32_t> stamps_;
  std::vector<Placed> instances_;
};

}  // namespace lightgrid
