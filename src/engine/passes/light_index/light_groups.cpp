#include "passes/light_index/light_groups.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace lightgrid {
namespace {

bool touch(const LightExtent& a, const LightExtent& b) {
  for (int k = 0; k < 3; ++k) {
    if (a.high[k] < b.low[k] || b.high[k] < a.low[k]) return false;
  }
  if (std::isinf(a.radius) || std::isinf(b.radius)) return true;
  const double reach = (a.radius + b.radius) * (1 + 1e-9);
  const glm::dvec3 apart = a.center - b.center;
  return glm::dot(apart, apart) <= reach * reach;
}

// Extents by the cells of a hash grid that they overlap; those in too many cells are in a separate list.
class Neighbours {
 public:
  explicit Neighbours(const std::vector<LightExtent>& extents) : extents_(extents) {
    std::vector<double> sizes;
    for (const LightExtent& e : extents)
      sizes.push_back(std::max({e.high.x - e.low.x, e.high.y - e.low.y, e.high.z - e.low.z}));
    if (sizes.empty()) return;
    std::nth_element(sizes.begin(), sizes.begin() + sizes.size() / 2, sizes.end());
    const double median = sizes[sizes.size() / 2];
    if (std::isfinite(median) && median > 0) cell_ = median;
  }

  void add(uint32_t extent) {
    if (!each_cell(extents_[extent], [&](uint64_t cell) { in_cell_[cell].push_back(extent); }))
      large_.push_back(extent);
    all_.push_back(extent);
  }

  // Calls `found` for each extent that may touch this one; repetitions are possible.
  template <typename Found>
  void near(const LightExtent& extent, const Found& found) const {
    for (uint32_t other : large_) found(other);
    const bool in_few = each_cell(extent, [&](uint64_t cell) {
      const auto list = in_cell_.find(cell);
      if (list == in_cell_.end()) return;
      for (uint32_t other : list->second) found(other);
    });
    if (in_few) return;
    for (uint32_t other : all_) found(other);
  }

 private:
  static constexpr double max_cells = 64;

  template <typename Visit>
  bool each_cell(const LightExtent& e, const Visit& visit) const {
    const glm::dvec3 low = glm::floor(e.low / cell_), high = glm::floor(e.high / cell_),
                     count = high - low + 1.0;
    if (!(count.x * count.y * count.z <= max_cells) || !(glm::length(low) < 1e15)) return false;
    for (double z = low.z; z <= high.z; ++z) {
      for (double y = low.y; y <= high.y; ++y) {
        for (double x = low.x; x <= high.x; ++x) visit(key(int64_t(x), int64_t(y), int64_t(z)));
      }
    }
    return true;
  }

  // Hash collisions only add candidates.
  static uint64_t key(int64_t x, int64_t y, int64_t z) {
    return uint64_t(x) * 0x9e3779b97f4a7c15 ^ uint64_t(y) * 0xc2b2ae3d27d4eb4f ^
           uint64_t(z) * 0x165667b19e3779f9;
  }

  const std::vector<LightExtent>& extents_;
  double cell_ = 1;
  std::unordered_map<uint64_t, std::vector<uint32_t>> in_cell_;
  std::vector<uint32_t> large_, all_;
};

}  // namespace

std::vector<uint32_t> group_lights(const std::vector<LightExtent>& extents, uint32_t groups, uint32_t slots) {
  std::vector<uint32_t> group_of(extents.size(), no_group);
  Neighbours placed(extents);
  std::vector<std::vector<uint32_t>> touched(groups);  // earlier extents of each group
  for (uint32_t i = 0; i < extents.size(); ++i) {
    for (auto& of_group : touched) of_group.clear();
    std::vector<bool> taken(groups, false);
    placed.near(extents[i], [&](uint32_t other) {
      const uint32_t group = group_of[other];
      if (taken[group] || !touch(extents[i], extents[other])) return;
      if (slots == 1) {
        taken[group] = true;
        return;
      }
      // Boxes of which each two touch have a point in common (Helly); for balls this is conservative.
      std::vector<uint32_t>& earlier = touched[group];
      if (std::ranges::find(earlier, other) != earlier.end()) return;
      for (const uint32_t one : earlier) {
        if (touch(extents[one], extents[other])) taken[group] = true;
      }
      earlier.push_back(other);
    });
    const auto free = std::find(taken.begin(), taken.end(), false);
    if (free == taken.end()) continue;
    group_of[i] = uint32_t(free - taken.begin());
    placed.add(i);
  }
  return group_of;
}

const std::vector<uint32_t>& StillLightGroups::of(std::vector<LightExtent> extents,
                                                  std::vector<uint32_t> order, uint32_t groups,
                                                  uint32_t slots) {
  if (sorted_ && extents == extents_ && order == order_) return groups_;
  ++sorted_;
  extents_ = std::move(extents);
  order_ = std::move(order);
  std::vector<LightExtent> in_order;
  for (const uint32_t light : order_) in_order.push_back(extents_[light]);
  const std::vector<uint32_t> found = group_lights(in_order, groups, slots);
  groups_.assign(extents_.size(), no_group);
  for (size_t i = 0; i < found.size(); ++i) groups_[order_[i]] = found[i];
  return groups_;
}

std::vector<uint32_t> draw_rounds(const std::vector<LightExtent>& extents) {
  std::vector<uint32_t> rounds(extents.size(), 0);
  Neighbours placed(extents);
  for (uint32_t i = 0; i < extents.size(); ++i) {
    placed.near(extents[i], [&](uint32_t other) {
      if (rounds[other] >= rounds[i] && touch(extents[i], extents[other])) rounds[i] = rounds[other] + 1;
    });
    placed.add(i);
  }
  return rounds;
}

}  // namespace lightgrid
