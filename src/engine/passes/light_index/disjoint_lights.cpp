#include "passes/light_index/disjoint_lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace lightgrid {
namespace {

bool apart(const LightExtent& a, const glm::dvec3& low, const glm::dvec3& high) {
  for (int k = 0; k < 3; ++k) {
    if (a.high[k] < low[k] || high[k] < a.low[k]) return true;
  }
  return false;
}

bool touch(const LightExtent& a, const LightExtent& b) {
  if (apart(a, b.low, b.high)) return false;
  if (std::isinf(a.radius) || std::isinf(b.radius)) return true;
  const double reach = (a.radius + b.radius) * (1 + 1e-9);
  const glm::dvec3 apart = a.center - b.center;
  return glm::dot(apart, apart) <= reach * reach;
}

// A tree of boxes, each around two others or a few extents. A box has a summary of the extents that were placed in
// it: the OR of their bits, or their largest number.
class ExtentTree {
 public:
  enum class Summary { bits, largest };

  ExtentTree(const std::vector<LightExtent>& extents, Summary summary)
      : extents_(extents), summary_(summary), order_(extents.size()), values_(extents.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (!extents.empty()) build(0, uint32_t(extents.size()), none);
  }

  void place(uint32_t extent, uint64_t value) {
    values_[extent] = value;
    for (uint32_t box = leaf_of_[extent]; box != none; box = boxes_[box].parent) {
      Box& b = boxes_[box];
      b.low = glm::min(b.low, extents_[extent].low);
      b.high = glm::max(b.high, extents_[extent].high);
      b.summary = summary_ == Summary::bits ? b.summary | value : std::max(b.summary, value);
    }
  }

  // Calls found(other) once for each placed extent that touches this one, except where wanted(value) is false of
  // a summary or a value of 0 bits. Later calls of wanted() may return false where earlier ones did not.
  template <typename Wanted, typename Found>
  void near(const LightExtent& extent, const Wanted& wanted, const Found& found) const {
    std::array<uint32_t, 64> waiting;
    size_t count = 0;
    if (!boxes_.empty()) waiting[count++] = 0;
    while (count > 0) {
      const Box& box = boxes_[waiting[--count]];
      if (!wanted(box.summary) || apart(extent, box.low, box.high)) continue;
      if (box.second != none) {
        // First the later rounds, and large extents, which decide most.
        const bool first_later =
            summary_ == Summary::largest && boxes_[box.first_child].summary > boxes_[box.second].summary;
        waiting[count++] = first_later ? box.second : box.first_child;
        waiting[count++] = first_later ? box.first_child : box.second;
        continue;
      }
      for (uint32_t i = box.first; i < box.end; ++i) {
        const uint32_t other = order_[i];
        if (wanted(values_[other]) && touch(extent, extents_[other])) found(other);
      }
    }
  }

 private:
  static constexpr uint32_t none = 0xffffffffu, extents_in_leaf = 4;
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  struct Box {
    glm::dvec3 low, high;
    uint32_t parent, first, end;  // the extents order_[first ... end - 1]
    uint32_t first_child = none, second = none;
    uint64_t summary = 0;
  };

  static double middle(const LightExtent& e, int axis) {
    const double sum = e.low[axis] + e.high[axis];
    return std::isfinite(sum) ? sum : 0;
  }

  static double size_of(const LightExtent& e) {
    const glm::dvec3 sides = e.high - e.low;
    return std::clamp(std::max({sides.x, sides.y, sides.z}), 1e-30, 1e300);
  }

  // Splits order_[first ... end - 1] into two parts, by place, and first by size if sizes differ much: one large
  // extent makes the box of small ones large. Returns where the second begins.
  uint32_t split(uint32_t first, uint32_t end) {
    glm::dvec3 least(infinite), greatest(-infinite);
    double smallest = infinite, largest = 0;
    for (uint32_t i = first; i < end; ++i) {
      const LightExtent& e = extents_[order_[i]];
      smallest = std::min(smallest, size_of(e));
      largest = std::max(largest, size_of(e));
      for (int axis = 0; axis < 3; ++axis) {
        least[axis] = std::min(least[axis], middle(e, axis));
        greatest[axis] = std::max(greatest[axis], middle(e, axis));
      }
    }
    const auto begin = order_.begin();
    if (largest > 4 * smallest) {
      const double between = std::sqrt(smallest) * std::sqrt(largest);
      return uint32_t(std::partition(begin + first, begin + end,
                                     [&](uint32_t i) { return size_of(extents_[i]) < between; }) -
                      begin);
    }
    const glm::dvec3 size = greatest - least;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t half = first + (end - first) / 2;
    std::nth_element(begin + first, begin + half, begin + end, [&](uint32_t a, uint32_t b) {
      return middle(extents_[a], axis) < middle(extents_[b], axis);
    });
    return half;
  }

  uint32_t build(uint32_t first, uint32_t end, uint32_t parent) {
    const uint32_t number = uint32_t(boxes_.size());
    boxes_.push_back({glm::dvec3(infinite), glm::dvec3(-infinite), parent, first, end});
    if (end - first <= extents_in_leaf) {
      leaf_of_.resize(extents_.size());
      for (uint32_t i = first; i < end; ++i) leaf_of_[order_[i]] = number;
      return number;
    }
    const uint32_t half = split(first, end);
    const uint32_t first_child = build(first, half, number), second = build(half, end, number);
    boxes_[number].first_child = first_child;
    boxes_[number].second = second;
    return number;
  }

  const std::vector<LightExtent>& extents_;
  Summary summary_;
  std::vector<uint32_t> order_, leaf_of_;
  std::vector<uint64_t> values_;  // by extent; 0: not placed
  std::vector<Box> boxes_;        // the first is around all
};

}  // namespace

// Groups past the 64th share bits. Such a bit is in no mask of taken groups, so it only costs time.
static uint64_t bit_of(uint32_t group) { return uint64_t(1) << group % 64; }

std::vector<uint32_t> group_lights(const std::vector<LightExtent>& extents, uint32_t groups, uint32_t slots) {
  std::vector<uint32_t> group_of(extents.size(), no_group);
  ExtentTree placed(extents, ExtentTree::Summary::bits);
  std::vector<std::vector<uint32_t>> touched(groups);  // earlier extents of each group
  for (uint32_t i = 0; i < extents.size(); ++i) {
    for (auto& of_group : touched) of_group.clear();
    std::vector<bool> taken(groups, false);
    uint64_t taken_bits = 0;
    const auto take = [&](uint32_t group) {
      taken[group] = true;
      if (groups <= 64) taken_bits |= bit_of(group);
    };
    const auto may_take = [&](uint64_t bits) { return (bits & ~taken_bits) != 0; };
    placed.near(extents[i], may_take, [&](uint32_t other) {
      const uint32_t group = group_of[other];
      if (slots == 1) return take(group);
      // Boxes of which each two touch have a point in common (Helly); for balls this is conservative.
      std::vector<uint32_t>& earlier = touched[group];
      for (const uint32_t one : earlier) {
        if (touch(extents[one], extents[other])) return take(group);
      }
      earlier.push_back(other);
    });
    const auto free = std::find(taken.begin(), taken.end(), false);
    if (free == taken.end()) continue;
    group_of[i] = uint32_t(free - taken.begin());
    placed.place(i, bit_of(group_of[i]));
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
  ExtentTree placed(extents, ExtentTree::Summary::largest);
  for (uint32_t i = 0; i < extents.size(); ++i) {
    // Placed extents have the round that follows theirs.
    const auto is_later = [&](uint64_t next) { return next > rounds[i]; };
    placed.near(extents[i], is_later, [&](uint32_t other) { rounds[i] = rounds[other] + 1; });
    placed.place(i, rounds[i] + 1);
  }
  return rounds;
}

}  // namespace lightgrid
