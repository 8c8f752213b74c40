#include "rays/ray_tree.h"

#include <algorithm>

#include "base/parallel.h"
#include "rays/ray_split.h"

namespace lightgrid {

namespace {

constexpr int max_in_leaf = 4;
constexpr float step_cost = 0.7f;        // of a node's boxes, in tests of a triangle
constexpr int depth_of_halves = 32;      // from there on ranges are halved: 31 levels are left for 2^31 boxes
constexpr int levels_of_tasks = 6;       // that are split before subtrees are handed to threads
constexpr uint32_t min_in_task = 20000;  // boxes

static_assert(depth_of_halves + 31 < RAY_STACK);

// Items `first` to below `end` become the node nodes[place] and what follows it. A subtree has fewer nodes
// than items, so each range of items has room for its nodes at its own place, and threads share nothing.
struct Task {
  uint32_t first, end, place;
  int depth;
  uint32_t cut;  // where the range is cut in two
  uint32_t size() const { return end - first; }
};

class Builder {
 public:
  Builder(const std::vector<RayBox>& boxes, RayTree& tree) : items_(boxes.size()), tree_(tree) {
    for (uint32_t i = 0; i < boxes.size(); ++i) {
      RayItem& item = items_[i] = {{}, {}, i};
      for (int k = 0; k < 3; ++k) {
        item.low[k] = boxes[i].low[k];
        item.high[k] = boxes[i].high[k];
      }
    }
  }

  void build() {
    const uint32_t count = uint32_t(items_.size());
    tree_.nodes.resize(std::max(count, 1u));
    if (count <= max_in_leaf) {
      RayNode& root = tree_.nodes[0] = RayNode{.count_1 = RAY_NOTHING};
      set_child(root, 0, 0, count, bounds(0, count));
      if (count == 0) root.count_0 = RAY_NOTHING;
    } else {
      build_nodes(count);
    }
    for (const RayItem& item : items_) tree_.order.push_back(item.number);
  }

 private:
  void build_nodes(uint32_t count) {
    std::vector<Task> tasks{{0, count, 0, 0, middle(0, count, 0, bounds(0, count))}};
    for (int level = 0; level < levels_of_tasks; ++level) {
      std::vector<std::vector<Task>> children(tasks.size());
      parallel_for(int(tasks.size()), [&](int i) {
        if (tasks[i].size() < min_in_task) return void(children[i] = {tasks[i]});
        split(tasks[i], children[i]);
      });
      tasks.clear();
      for (const std::vector<Task>& made : children) tasks.insert(tasks.end(), made.begin(), made.end());
    }
    parallel_for(int(tasks.size()), [&](int i) { finish(tasks[i]); });
    compact();
  }

  RayItemBounds bounds(uint32_t first, uint32_t end) const {
    RayItemBounds all;
    for (uint32_t i = first; i < end; ++i) all.add(items_[i].low, items_[i].high);
    return all;
  }

  // Where the range is cut in two; `first` where it is a leaf.
  uint32_t middle(uint32_t first, uint32_t end, int depth, const RayItemBounds& box) {
    const uint32_t count = end - first, half = first + count / 2;
    if (count == 1) return first;
    if (depth >= depth_of_halves) return count <= max_in_leaf ? first : half;
    const RaySplit best = best_ray_split({&items_[first], end - first});
    if (count <= max_in_leaf && best.cost > (float(count) - step_cost) * box.area()) return first;
    if (best.axis < 0) return count <= max_in_leaf ? first : half;
    const auto left = [&](const RayItem& item) {
      return bin_of(item, best.axis, best.low, best.scale) <= best.last_bin;
    };
    return uint32_t(std::partition(items_.begin() + first, items_.begin() + end, left) - items_.begin());
  }

  void set_child(RayNode& node, int side, uint32_t child, uint32_t count, const RayItemBounds& box) {
    for (int k = 0; k < 3; ++k) {
      (side ? node.low_1 : node.low_0)[k] = count || child ? box.low[k] : 0;
      (side ? node.high_1 : node.high_0)[k] = count || child ? box.high[k] : 0;
    }
    (side ? node.child_1 : node.child_0) = int(child);
    (side ? node.count_1 : node.count_0) = int(count);
  }

  // Writes the task's node; what is left to do of its children is appended.
  void split(const Task& t, std::vector<Task>& children) {
    RayNode node{};
    for (int side = 0; side < 2; ++side) {
      const uint32_t first = side ? t.cut : t.first, end = side ? t.end : t.cut;
      const RayItemBounds box = bounds(first, end);
      const uint32_t cut = middle(first, end, t.depth + 1, box);
      if (cut == first) {
        set_child(node, side, first, end - first, box);
        continue;
      }
      const uint32_t place = t.place + (side ? t.cut - t.first : 1);
      set_child(node, side, place, 0, box);
      children.push_back({first, end, place, t.depth + 1, cut});
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

  std::vector<RayItem> items_;
  RayTree& tree_;
};

}  // namespace

RayTree ray_tree(const std::vector<RayBox>& boxes) {
  RayTree tree;
  Builder(boxes, tree).build();
  return tree;
}

}  // namespace lightgrid
