#include "scene/light_tree.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

namespace lightgrid {
namespace {

constexpr float farthest = 1e15f;  // whose square is far from float's largest number

struct Leaf {
  glm::vec3 position{0};
  float luminance = 0;
  uint32_t light = 0;
};

float luminance_of(const ViewLight& light) {
  const glm::dvec3 i = largest_intensity(light);
  const double luminance = 0.2126 * i.r + 0.7152 * i.g + 0.0722 * i.b;
  return light.radius_m > 0 && luminance > 0 ? float(std::clamp(luminance, 1e-20, 1e20)) : 0;
}

void build(LightTree& tree, size_t node, std::span<Leaf> lights) {
  if (lights.empty()) return;
  glm::vec3 low = lights[0].position, high = low;
  double sum = 0;
  for (const Leaf& l : lights) {
    low = glm::min(low, l.position);
    high = glm::max(high, l.position);
    sum += l.luminance;
  }
  tree.nodes[node] = {glm::vec4(low, float(sum)), glm::vec4(high, 0)};
  const size_t leaves = tree.lights.size();
  if (node >= leaves) {
    tree.lights[node - leaves] = lights[0].light;
    return;
  }
  const glm::vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const size_t half = (lights.size() + 1) / 2;
  const auto before = [axis](const Leaf& a, const Leaf& b) {
    return a.position[axis] != b.position[axis] ? a.position[axis] < b.position[axis] : a.light < b.light;
  };
  if (half < lights.size())
    std::nth_element(lights.begin(), lights.begin() + std::ptrdiff_t(half), lights.end(), before);
  build(tree, 2 * node, lights.first(half));
  build(tree, 2 * node + 1, lights.subspan(half));
}

}  // namespace

LightTree light_tree(std::span<const ViewLight> lights) {
  std::vector<Leaf> leaves;
  for (size_t i = 0; i < lights.size(); ++i) {
    const float luminance = luminance_of(lights[i]);
    if (luminance > 0)
      leaves.push_back({glm::vec3(glm::clamp(lights[i].position, double(-farthest), double(farthest))),
                        luminance, uint32_t(i)});
  }
  LightTree tree;
  tree.lights.resize(std::bit_ceil(std::max<size_t>(leaves.size(), 1)));
  tree.nodes.resize(2 * tree.lights.size());
  build(tree, 1, leaves);
  return tree;
}

}  // namespace lightgrid
