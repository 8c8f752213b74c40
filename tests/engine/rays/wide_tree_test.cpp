// The wide tree has the leaves and boxes of the binary tree that it is made from.
#include "rays/wide_tree.h"

#include <gtest/gtest.h>

#include <map>

#include "rays/ray_tree.h"
#include "rays/soups.h"

namespace lightgrid {
namespace {

RayTree tree_of(int boxes) {
  RandomNumbers random(7);
  std::vector<RayBox> all(static_cast<size_t>(boxes));
  for (RayBox& box : all) {
    for (int i = 0; i < 2; ++i) box.add(glm::vec3(random.in_cube(4)) * glm::vec3(2, 0.25f, 1));
  }
  return ray_tree(all);
}

struct Leaf {
  int count;
  std::array<float, 6> box;
  bool operator==(const Leaf&) const = default;
};

// By first triangle.
std::map<int, Leaf> leaves_of(const RayTree& tree) {
  std::map<int, Leaf> leaves;
  for (const RayNode& n : tree.nodes) {
    const float *a = n.low_0, *b = n.high_0, *c = n.low_1, *d = n.high_1;
    if (n.count_0 > 0) leaves[n.child_0] = {n.count_0, {a[0], a[1], a[2], b[0], b[1], b[2]}};
    if (n.count_1 > 0) leaves[n.child_1] = {n.count_1, {c[0], c[1], c[2], d[0], d[1], d[2]}};
  }
  return leaves;
}

std::map<int, Leaf> leaves_of(const WideTree& tree) {
  std::map<int, Leaf> leaves;
  for (const RayWideNode& n : tree.nodes) {
    for (int k = 0; k < RAY_WIDTH; ++k) {
      if (n.count[k] == 0) continue;
      Leaf& leaf = leaves[n.child[k]] = {n.count[k], {}};
      for (size_t plane = 0; plane < 6; ++plane) leaf.box[plane] = n.planes[plane][k];
    }
  }
  return leaves;
}

TEST(WideTree, HasTheLeavesAndBoxesOfTheBinaryTree) {
  for (const int boxes : {0, 1, 4, 5, 17, 40, 3000}) {
    const RayTree tree = tree_of(boxes);
    const WideTree wide = wide_tree(tree.nodes);
    EXPECT_EQ(leaves_of(wide), leaves_of(tree)) << boxes;
    ASSERT_EQ(wide.slots.size(), tree.nodes.size());
    size_t filled = 0;
    for (size_t i = 0; i < tree.nodes.size(); ++i) {
      for (const int side : {0, 1}) {
        const int slot = wide.slots[i][size_t(side)];
        if (slot < 0) continue;
        ++filled;
        const RayWideNode& n = wide.nodes[size_t(slot / RAY_WIDTH)];
        for (int axis = 0; axis < 3; ++axis) {
          const RayNode& b = tree.nodes[i];
          EXPECT_EQ(n.planes[axis][slot % RAY_WIDTH], (side ? b.low_1 : b.low_0)[axis]);
          EXPECT_EQ(n.planes[3 + axis][slot % RAY_WIDTH], (side ? b.high_1 : b.high_0)[axis]);
        }
      }
    }
    // Every node but the root is a child.
    EXPECT_EQ(filled, leaves_of(tree).size() + wide.nodes.size() - 1);
  }
}

TEST(WideTree, HasAtLeastHalfOfItsChildren) {
  const WideTree wide = wide_tree(tree_of(3000).nodes);
  EXPECT_LT(wide.nodes.size(), 3000u / 8);
}

// A box that nothing meets: its low planes lie above its high ones.
TEST(WideTree, HasNoBoxWhereAChildIsMissing) {
  const WideTree wide = wide_tree(tree_of(5).nodes);
  int missing = 0;
  for (int k = 0; k < RAY_WIDTH; ++k) {
    const RayWideNode& root = wide.nodes.at(0);
    missing += root.planes[0][k] > root.planes[3][k] && root.planes[2][k] > root.planes[5][k];
  }
  EXPECT_GE(missing, RAY_WIDTH - 5);
  EXPECT_LT(missing, RAY_WIDTH);
}

}  // namespace
}  // namespace lightgrid
