// The order in which light volumes are drawn into light index images, and with sorted packings the group of
// channels, and the pass, in which each light is (docs/details/lidr.md#packings).
#pragma once

#include "passes/light_index/disjoint_lights.h"
#include "passes/light_index/index_drawing.h"

namespace lightgrid {

// Volumes in the order drawn; batches of one pass follow each other.
struct LightIndexBatches {
  std::vector<LightVolume> volumes;
  std::vector<VolumeBatch> batches;
  struct Pass {
    bool points_alone = true;  // no spot lights: the light loop needs no cones
  };
  std::vector<Pass> passes = {{false}};  // over the surfaces, one at least: each has images of its own
};

class LightIndexOrder : public PassCache {
 public:
  // Throws Error as light_index does.
  explicit LightIndexOrder(PassContext& work);
  // Lights that come into view need groups as well.
  bool follow(PassContext& work) override;

  const LightIndexLayout& layout() const { return layout_; }
  // Lights without a group in any pass are left out.
  void order(const ViewState& seen, std::vector<LightVolume> volumes);
  const LightIndexBatches& batches() const { return batches_; }
  // How often the scene's lights were put into groups, with lidr-sort=still.
  int sorted_still() const { return still_[0].sorted(); }

 private:
  bool before(uint32_t a, uint32_t b) const { return influence_[a] > influence_[b]; }
  void find_influence(const ViewState& seen);
  void put_in_groups(const ViewState& seen, std::vector<LightVolume>& volumes);
  void put_in_groups_of_view(const ViewState& seen, const std::vector<LightVolume>& volumes);
  bool put_in_still_groups(const ViewState& seen, const std::vector<LightVolume>& volumes);
  std::vector<uint32_t> rounds_of(const ViewState& seen, const std::vector<LightVolume>& volumes) const;

  LightIndexLayout layout_;
  std::vector<double> influence_;         // one per light
  std::vector<uint32_t> group_of_light_;  // (type * passes + pass) * layout().groups + group
  bool grouped_ = false;                  // group_of_light_ is the view's, and does not depend on the frame
  static constexpr uint32_t light_types = 2;
  std::vector<uint32_t> type_;  // one per light: 1 for spots, where types have separate passes
  StillLightGroups still_[light_types];
  LightIndexBatches batches_;
};

}  // namespace lightgrid
