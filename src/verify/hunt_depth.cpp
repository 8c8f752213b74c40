#include "verify/hunt_depth.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "reference/position.h"

namespace lightgrid::verify {
namespace {

// Of a block of pixels. Two distances, metres along the view axis; a pixel has one of them, or a distance
// between.
struct Block {
  enum { flat, layers, rough, edge, none } kind = flat;
  double a = 0, b = 0;
  float value = 0, other = 0;  // stored, of kind edge
};

// Of the image at a point, pixels: depth = tilt + b / d - a. 0 unless the near plane is oblique.
double tilt_at(const HuntView& h, double px, double py) {
  const glm::dmat4& clip = h.view.clip_from_view;
  if (clip[0][2] == 0 && clip[1][2] == 0) return 0;
  const View view = oracle_view(h.view);
  return clip[0][2] * view_x_of_pixel(view, px) + clip[1][2] * view_y_of_pixel(view, py);
}

// The value as stored in the format, 0 to 1.
float stored_depth(const HuntView& h, double distance, double tilt) {
  const double depth = std::clamp(depth_at(h.view, distance) + tilt, 0.0, 1.0);
  if (h.format == DepthFormat::d32f) return float(depth);
  const double steps = h.format == DepthFormat::d16 ? 65535 : 16777215;
  return float(std::round(depth * steps) / steps);
}

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
  if (h.format != DepthFormat::d32f) return stored_depth(h, distance_at(h.view, value), 0);
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
  return block;
}

float value_in(const Block& block, const HuntView& h, double tilt, Random& random) {
  switch (block.kind) {
    case Block::none:
      return depth_of_nothing(h.view);
    case Block::flat:
      return stored_depth(h, block.a, tilt);
    case Block::layers:
      return stored_depth(h, chance(random, 0.5) ? block.a : block.b, tilt);
    case Block::rough:
      return stored_depth(h, between(random, block.a, block.b), tilt);
    default:
      return chance(random, 0.5) ? block.value : block.other;
  }
}

}  // namespace

double distance_of(const HuntView& h, double depth, double px, double py) {
  return distance_at(h.view, depth - tilt_at(h, px, py));
}

float random_blended_depth(const HuntView& h, float opaque, double px, double py, Random& random) {
  const bool standard = has_standard_depth(h.view),
             edges = !h.view.slice_edges.empty() || !h.view.z_bin_edges.empty();
  const bool before_sky = opaque == depth_of_nothing(h.view);
  const double style = unit(random);
  if (style < 0.2) return standard ? 0.0f : 1.0f;
  if (style < 0.35) return opaque;
  double distance = before_sky ? h.far : distance_of(h, opaque, px, py);
  if (!(distance > h.near)) return opaque;
  float depth = edges && style < 0.55 ? value_on_edge(h, random) : 0;
  if (!(edges && style < 0.55)) {
    const bool even = is_orthographic(h.view) || chance(random, 0.3);
    distance = even ? between(random, h.near, distance) : log_between(random, h.near, distance);
    depth = float(std::clamp(depth_at(h.view, distance) + tilt_at(h, px, py), 0.0, 1.0));
  }
  return standard ? std::min(depth, opaque) : std::max(depth, opaque);
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
      const double tilt = tilt_at(h, x + 0.5, y + 0.5);
      for (int s = 0; s < samples; ++s) image.values.push_back(value_in(block, h, tilt, random));
    }
  }
  return image;
}

}  // namespace lightgrid::verify
