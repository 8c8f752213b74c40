#include "verify/hunt_depth.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lightgrid::verify {
namespace {

// Of a block of pixels. Two distances, metres along the view axis; a pixel has one of them, or a value
// between.
struct Block {
  enum { flat, layers, rough, edge, none } kind = flat;
  double a = 0, b = 0;
  float value = 0, other = 0;  // stored
};

double random_distance(const HuntView& h, Random& random) {
  if (!is_orthographic(h.view) && chance(random, 0.8)) return log_between(random, h.near * 1.0001, h.far);
  return between(random, h.near + (h.far - h.near) * 1e-6, h.far);
}

// A stored value whose key equals an edge's or is next to it.
float value_on_edge(const HuntView& h, Random& random) {
  const bool slices = h.view.z_bin_edges.empty() || (!h.view.slice_edges.empty() && chance(random, 0.5));
  const std::vector<float>& edges = slices ? h.view.slice_edges : h.view.z_bin_edges;
  const size_t i = random.next() % edges.size();
  const float key = slices ? slice_keys(h.view)[i] : z_bin_keys(h.view)[i];
  float value = has_standard_depth(h.view) ? key : -key;
  if (h.format != DepthFormat::d32f) return stored_depth(h, distance_at(h.view, value));
  for (int steps = int(random.next() % 5) - 2; steps != 0; steps += steps < 0 ? 1 : -1) {
    value = std::nextafter(value, steps < 0 ? 0.0f : 1.0f);
  }
  return std::clamp(value, 0.0f, 1.0f);
}

Block random_block(const HuntView& h, Random& random) {
  Block block;
  const bool edges = !h.view.slice_edges.empty() || !h.view.z_bin_edges.empty();
  const double t = unit(random);
  block.a = random_distance(h, random), block.b = random_distance(h, random);
  block.kind = t < 0.05 ? Block::none : t < 0.45 ? Block::flat : t < 0.7 ? Block::layers : Block::rough;
  if (edges && chance(random, 0.35)) {
    block.kind = Block::edge;
    block.value = value_on_edge(h, random),
    block.other = chance(random, 0.5) ? block.value : value_on_edge(h, random);
    return block;
  }
  if (block.kind == Block::rough && chance(random, 0.5)) block.b = block.a + (block.b - block.a) * 1e-3;
  block.value = stored_depth(h, block.a), block.other = stored_depth(h, block.b);
  return block;
}

float value_in(const Block& block, const HuntView& h, Random& random) {
  switch (block.kind) {
    case Block::none:
      return depth_of_nothing(h.view);
    case Block::flat:
      return block.value;
    case Block::rough:
      return stored_depth(h, between(random, block.a, block.b));
    default:
      return chance(random, 0.5) ? block.value : block.other;
  }
}

}  // namespace

float stored_depth(const HuntView& h, double distance) {
  const double depth = std::clamp(depth_at(h.view, distance), 0.0, 1.0);
  if (h.format == DepthFormat::d32f) return float(depth);
  const double steps = h.format == DepthFormat::d16 ? 65535 : 16777215;
  return float(std::round(depth * steps) / steps);
}

DepthImage random_surfaces(const HuntView& h, int samples, Random& random) {
  const int side = one_of(random, {8, 16, 32, 64}), across = (h.view.width + side - 1) / side;
  std::vector<Block> blocks(size_t(across) * ((h.view.height + side - 1) / side));
  for (Block& block : blocks) block = random_block(h, random);
  DepthImage image;
  image.samples = samples;
  image.values.reserve(size_t(h.view.width) * h.view.height * samples);
  for (int y = 0; y < h.view.height; ++y) {
    for (int x = 0; x < h.view.width; ++x) {
      const Block& block = blocks[size_t(y / side) * across + x / side];
      for (int s = 0; s < samples; ++s) image.values.push_back(value_in(block, h, random));
    }
  }
  return image;
}

}  // namespace lightgrid::verify
