#include "rays/ray_tree.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"

namespace lightgrid {

float RayBox::area() const {
  const glm::vec3 size = high - low;
  return size.x < 0 ? 0 : size.x * size.y + size.y * size.z + size.z * size.x;
}

namespace {

constexpr int bins = 16;
constexpr int most_in_leaf = 4;
constexpr float step_cost = 0.7f;    // of a node's boxes, in tests of a triangle
constexpr int depth_of_halves = 32;  // from there on ranges are halved: 31 levels are left for 2^31 boxes
constexpr int levels_of_tasks = 6;   // that are split before subtrees are handed to threads
constexpr uint32_t least_in_task = 20000;  // boxes

static_assert(depth_of_halves + 31 < RAY_STACK);

// Boxes order[first] to below order[end] become the node nodes[place] and what follows it. A subtree has
// fewer nodes than boxes, so each range of boxes has room for its nodes at its own place, and threads share
// nothing.
struct Task {
  uint32_t first, end, place;
  int depth;
  uint32_t size() const { return end - first; }
};

struct Split {
  int axis = -1;  // below 0: none
  int last_bin = 0;
  float low = 0, scale = 0;
  float cost = std::numeric_limits<float>::infinity();
  bool takes(const RayBox& b) const { return bin_of(b) <= last_bin; }
  int bin_of(const RayBox& b) const { return int((b.low[axis] + b.high[axis] - low) * scale); }
};

class Builder {
 public:
  Builder(const std::vector<RayBox>& boxes, RayTree& tree) : boxes_(boxes), tree_(tree) {}

  void build() {
    const uint32_t count = uint32_t(tree_.order.size());
    tree_.nodes.resize(std::max(count, 1u));
    if (count <= most_in_leaf) {
      RayNode& root = tree_.nodes[0] = RayNode{.count_1 = RAY_NOTHING};
      set_child(root, 0, 0, count, bounds(0, count));
      if (count == 0) root.count_0 = RAY_NOTHING;
      return;
    }
    std::vector<Task> tasks{{0, count, 0, 0}};
    for (int level = 0; level < levels_of_tasks; ++level) {
      std::vector<std::vector<Task>> children(tasks.size());
      parallel_for(int(tasks.size()), [&](int i) {
        if (tasks[i].size() < least_in_task) return void(children[i] = {tasks[i]});
        split(tasks[i], children[i]);
      });
      tasks.clear();
      for (const std::vector<Task>& made : children) tasks.insert(tasks.end(), made.begin(), made.end());
    }
    parallel_for(int(tasks.size()), [&](int i) { finish(tasks[i]); });
    compact();
  }

 private:
  RayBox bounds(uint32_t first, uint32_t end) const {
    RayBox all;
    for (uint32_t i = first; i < end; ++i) all.add(boxes_[tree_.order[i]]);
    return all;
  }

  Split best_split(uint32_t first, uint32_t end) const {
    RayBox centers;  // twice the centre
    for (uint32_t i = first; i < end; ++i) {
      const RayBox& b = boxes_[tree_.order[i]];
      centers.add(b.low + b.high);
    }
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
      const float width = centers.high[axis] - centers.low[axis];
      if (!(width > 0)) continue;
      Split split{.axis = axis, .low = centers.low[axis], .scale = bins * 0.9999f / width};
      if (!std::isfinite(split.scale)) continue;
      RayBox in_bin[bins];
      int counts[bins] = {};
      for (uint32_t i = first; i < end; ++i) {
        const RayBox& b = boxes_[tree_.order[i]];
        const int bin = split.bin_of(b);
        in_bin[bin].add(b);
        ++counts[bin];
      }
      float right_cost[bins];
      RayBox right, left;
      int count = 0;
      for (int bin = bins - 1; bin > 0; --bin) {
        right.add(in_bin[bin]);
        count += counts[bin];
        right_cost[bin] = float(count) * right.area();
      }
      count = 0;
      for (int bin = 0; bin + 1 < bins; ++bin) {
        left.add(in_bin[bin]);
        count += counts[bin];
        const float cost = float(count) * left.area() + right_cost[bin + 1];
        if (count == 0 || uint32_t(count) == end - first || !(cost < best.cost)) continue;
        best = split;
        best.last_bin = bin, best.cost = cost;
      }
    }
    return best;
  }

  // Where the range is cut in two; `first` where it is a leaf.
  uint32_t middle(uint32_t first, uint32_t end, int depth, const RayBox& box) {
    const uint32_t count = end - first, half = first + count / 2;
    if (count == 1) return first;
    if (depth >= depth_of_halves) return count <= most_in_leaf ? first : half;
    const Split best = best_split(first, end);
    if (count <= most_in_leaf && best.cost > (float(count) - step_cost) * box.area()) return first;
    if (best.axis < 0) return count <= most_in_leaf ? first : half;
    const auto from = tree_.order.begin();
    return uint32_t(
        std::partition(from + first, from + end, [&](uint32_t i) { return best.takes(boxes_[i]); }) - from);
  }

  void set_child(RayNode& node, int side, uint32_t child, uint32_t count, const RayBox& box) {
    for (int k = 0; k < 3; ++k) {
      (side ? node.low_1 : node.low_0)[k] = count || child ? box.low[k] : 0;
      (side ? node.high_1 : node.high_0)[k] = count || child ? box.high[k] : 0;
    }
    (side ? node.child_1 : node.child_0) = int(child);
    (side ? node.count_1 : node.count_0) = int(count);
  }

  // Writes the task's node; what is left to do of its children is appended.
  void split(const Task& t, std::vector<Task>& children) {
    uint32_t cut = middle(t.first, t.end, t.depth, bounds(t.first, t.end));
    if (cut == t.first) cut = t.first + t.size() / 2;  // only the root: others were leaves already
    RayNode node{};
    for (int side = 0; side < 2; ++side) {
      const uint32_t first = side ? cut : t.first, end = side ? t.end : cut;
      const RayBox box = bounds(first, end);
      if (end - first <= most_in_leaf && middle(first, end, t.depth + 1, box) == first) {
        set_child(node, side, first, end - first, box);
        continue;
      }
      const uint32_t place = t.place + (side ? cut - t.first : 1);
      set_child(node, side, place, 0, box);
      children.push_back({first, end, place, t.depth + 1});
    }
    tree_.nodes[t.place] = node;
  }

  void finish(const Task& task) {
    std::vector<Task> left{task};
    while (!left.empty()) {
      const Task next = left.back();
      left.pop_back();
      split(next, left);
    }
  }

  // Closes the gaps that subtrees of fewer nodes left.
  void compact() {
    std::vector<RayNode> kept;
    kept.reserve(tree_.nodes.size() / 2);
    struct Visit {
      uint32_t from;
      int parent, side;
    };
    std::vector<Visit> visits{{0, -1, 0}};
    while (!visits.empty()) {
      const Visit visit = visits.back();
      visits.pop_back();
      const int place = int(kept.size());
      kept.push_back(tree_.nodes[visit.from]);
      if (visit.parent >= 0) (visit.side ? kept[visit.parent].child_1 : kept[visit.parent].child_0) = place;
      const RayNode& node = kept.back();
      if (node.count_1 == 0) visits.push_back({uint32_t(node.child_1), place, 1});
      if (node.count_0 == 0) visits.push_back({uint32_t(node.child_0), place, 0});
    }
    tree_.nodes = std::move(kept);
  }

  const std::vector<RayBox>& boxes_;
  RayTree& tree_;
};

}  // namespace

RayTree ray_tree(const std::vector<RayBox>& boxes) {
  RayTree tree;
  tree.order.resize(boxes.size());
  std::iota(tree.order.begin(), tree.order.end(), 0u);
  Builder(boxes, tree).build();
  return tree;
}

}  // namespace lightgrid
