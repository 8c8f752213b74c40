#include "rays/wide_tree.h"

#include <algorithm>

namespace lightgrid {
namespace {

// A child of the binary tree.
struct Child {
  int node, side;  // whose child it is
  const float *low, *high;
  int child, count;

  float half_area() const {
    const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return x * y + y * z + z * x;
  }
};

class Widener {
 public:
  explicit Widener(std::span<const RayNode> nodes) : nodes_(nodes), leaves_(nodes.size()) {
    wide_.slots.resize(nodes.size(), {-1, -1});
    for (size_t i = nodes.size(); i-- > 0;) {  // children come after their parents
      for (const Child& c : children(int(i))) leaves_[i] += c.count == 0 ? leaves_[size_t(c.child)] : 1;
    }
  }

  WideTree widened() {
    add(0);
    return std::move(wide_);
  }

 private:
  std::vector<Child> children(int node) const {
    const RayNode& n = nodes_[size_t(node)];
    std::vector<Child> children;
    if (n.count_0 != RAY_NOTHING) children.push_back({node, 0, n.low_0, n.high_0, n.child_0, n.count_0});
    if (n.count_1 != RAY_NOTHING) children.push_back({node, 1, n.low_1, n.high_1, n.child_1, n.count_1});
    return children;
  }

  // The child of greatest weight is opened. Those with few leaves fill a node, so that few nodes are nearly
  // empty.
  float weight(const Child& c) const {
    if (c.count != 0) return -1;
    const float leaves = float(leaves_[size_t(c.child)]);
    return leaves > RAY_WIDTH ? 1 + c.half_area() : 1 / leaves;
  }

  // In the binary tree's order.
  std::vector<Child> opened(int node) const {
    std::vector<Child> all = children(node);
    while (all.size() < RAY_WIDTH) {
      const auto next = std::ranges::max_element(all, {}, [&](const Child& c) { return weight(c); });
      if (next == all.end() || next->count != 0) break;
      const std::vector<Child> inner = children(next->child);
      *next = inner[0];
      all.insert(next + 1, inner.begin() + 1, inner.end());
    }
    return all;
  }

  int add(int node) {
    const int place = int(wide_.nodes.size());
    wide_.nodes.emplace_back();
    RayWideNode made{};
    std::fill_n(&made.planes[0][0], 3 * RAY_WIDTH, no_box_m);
    std::fill_n(&made.planes[3][0], 3 * RAY_WIDTH, -no_box_m);
    int k = 0;
    for (const Child& c : opened(node)) {
      for (int axis = 0; axis < 3; ++axis) {
        made.planes[axis][k] = c.low[axis];
        made.planes[3 + axis][k] = c.high[axis];
      }
      made.child[k] = c.count == 0 ? add(c.child) : c.child;
      made.count[k] = c.count;
      wide_.slots[size_t(c.node)][size_t(c.side)] = RAY_WIDTH * place + k++;
    }
    wide_.nodes[size_t(place)] = made;
    return place;
  }

  static constexpr float no_box_m = 1e30f;  // a box from here to -here, which nothing meets
  std::span<const RayNode> nodes_;
  std::vector<int> leaves_;  // below each node
  WideTree wide_;
};

}  // namespace

WideTree wide_tree(std::span<const RayNode> nodes) { return Widener(nodes).widened(); }

}  // namespace lightgrid
