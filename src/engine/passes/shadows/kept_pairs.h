// With the setting shadow-reuse: bits of the view's previous frame that are still right although a light or an
// instance changed. A pair of a tile and a light keeps its bits if the camera, the tile's pixels, the light and
// everything in the light's range are those of the previous frame. All are compared exactly
// (kernels/shadows/kept_pairs.h).
#pragma once

#include <optional>
#include <vector>

#include "passes/shadows/shadow_lights.h"
#include "renderer/moved_instances.h"
#include "renderer/pass_context.h"

namespace lightgrid {

class KeptPairs {
 public:
  // Not with shadow maps, which keep their faces instead, nor with picked rays, which belong to all lights of a
  // tile.
  static bool serve(const Settings& settings);

  // After the view, lights or surfaces changed: finds the lights that keep bits. records:
  // shadow_light_records().
  void look(PassContext& work, const RayScene& rays, const std::vector<ShadowLight>& records);
  // The next frame keeps nothing.
  void forget() { is_found_ = keeps_ = false; }

  // Before the bits of so many images are found. Takes the table and bits of the previous frame out of
  // work.shadows if some may be kept and if they fit into shadow-memory together with the `bytes` of this frame.
  void begin(PassContext& work, size_t images, size_t bytes);
  // Finds the tiles whose pixels changed. receivers: the first arguments of
  // kernels/shadows/same_receivers.cl, for the opaque image. is_numbered: the kernel takes -DNUMBERED.
  void compare(PassContext& work, const ClArguments& receivers, bool is_numbered);
  // KEPT_ARGUMENTS of an image. tiles: of all images. may_keep: its pixels change only if instances do, or it
  // was compared.
  ClArguments arguments(ClDevice& device, size_t tiles, bool may_keep);
  void end() {
    is_found_ = true;
    keeps_ = false;
  }

  bool has_same_receivers() const { return has_same_receivers_; }  // no instance changed
  // Tiles with lights whose bits are all those of the previous frame. tiles: of the opaque image. is_unchanged:
  // no bits were found.
  size_t kept_tiles(ClDevice& device, size_t tiles, bool is_unchanged) const;
  size_t kept_bytes() const { return tiles_.bytes() + bits_.bytes(); }
  size_t memory_bytes() const;

 private:
  std::vector<uint32_t> kept_lights(const PassContext& work, const std::vector<ShadowLight>& records,
                                    const std::vector<int>& numbers, const glm::dvec3& origin,
                                    const std::vector<WorldBox>& moved) const;

  MovedInstances moved_;
  // These belong to the previous frame.
  View view_;
  glm::dvec3 origin_{0};
  std::vector<ShadowLight> records_;
  std::vector<int> numbers_;  // in the scene, of the lights of records_
  size_t images_ = 0;
  bool is_found_ = false;
  bool has_numbers_shown_ = false;  // numbers_shown_ and depths_shown_ are those of the previous frame

  bool keeps_ = false, has_same_receivers_ = true;  // of this frame
  SharedTexture tiles_, bits_;
  UploadedBuffer lights_;
  GrowingBuffer numbers_shown_, depths_shown_, same_tiles_, outcome_;
  NamedKernel compare_;
};

}  // namespace lightgrid
