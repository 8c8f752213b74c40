#include <algorithm>
#include <cmath>
#include <numbers>

#include "oracle/position.h"
#include "shared/cull_tests.h"
#include "verify/check.h"
#include "verify/hunt_space.h"

namespace lightgrid::lab::verify {
namespace {

// Variants that depth_cases and light_cases build anyway.
void choose_from_few(HuntSetting& s, Random& random) {
  const bool vary_test = chance(random, 0.5);
  if (vary_test)
    s.options.cull_test = one_of(random, cull_tests).test;
  else
    s.options.depth_bounds = one_of(random, depth_bounds_modes).mode;
  s.spots = vary_test && chance(random, 0.5);
  if (!vary_test && s.options.depth_bounds == DepthBoundsMode::minmax) {
    s.slices = one_of(random, {1, 24});
    s.z_bins = one_of(random, {1, 256});
  }
}

// A block of pixels has two distances, metres along the view axis; a pixel is at one of them, or between.
struct Block {
  enum { flat, layers, rough, edge, none } kind = flat;
  double a = 0, b = 0;
  float value = 0, other = 0;  // stored, of kind edge
};

// The tilt of depth at a point of the image, pixels: depth = tilt + b / d - a. 0 unless the near plane is
// oblique.
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
  block.a = random_distance(h, random);
  block.b = random_distance(h, random);
  block.kind = t < 0.05 ? Block::none : t < 0.45 ? Block::flat : t < 0.7 ? Block::layers : Block::rough;
  if (edges && chance(random, 0.35)) {
    block.kind = Block::edge;
    block.value = value_on_edge(h, random);
    block.other = chance(random, 0.5) ? block.value : value_on_edge(h, random);
    return block;
  }
  if (block.kind == Block::rough && chance(random, 0.5)) block.b = block.a + (block.b - block.a) * 1e-3;
  return block;
}

float value_in(const Block& block, const HuntView& h, double tilt, Random& random) {
  if (block.kind == Block::none) return depth_of_nothing(h.view);
  if (block.kind == Block::edge) return chance(random, 0.5) ? block.value : block.other;
  const double distance = block.kind == Block::flat    ? block.a
                          : block.kind == Block::rough ? between(random, block.a, block.b)
                          : chance(random, 0.5)        ? block.a
                                                       : block.b;
  return stored_depth(h, distance, tilt);
}

using std::numbers::pi;
constexpr double steepest_half = 1145.9;    // tan(179.9 / 2 degrees)
constexpr double gentlest_half = 0.000873;  // tan(0.1 / 2 degrees)

constexpr glm::ivec2 sizes[] = {{256, 256}, {333, 190}, {640, 67}, {61, 515},
                                {128, 128}, {17, 1031}, {480, 272}};

// The parameters of a view; each class sets its own.
struct Plan {
  double half = 1;  // the steeper of the two half-slopes
  double off = 0;   // the image's centre, slopes
  bool orthographic = false, standard = false, finite = false, oblique = false, blended = false;
  bool placed = false;
  double eye_m = 0;
  double unit_m = 1;
};

double half_of(double low_deg, double high_deg, Random& random) {
  return log_between(random, std::tan(low_deg / 2 * pi / 180), std::tan(high_deg / 2 * pi / 180));
}

Plan mixed_plan(Random& random) {
  Plan p;
  p.orthographic = chance(random, 0.25);
  p.half =
      p.orthographic ? log_between(random, 1e-4, 1e5) : log_between(random, gentlest_half, steepest_half);
  p.standard = chance(random, 0.4);
  p.finite = p.orthographic || chance(random, 0.5);
  if (chance(random, 0.3))
    p.off = between(random, -1, 1) * (p.orthographic ? 100 * p.half : std::min(1000.0, 20 * p.half));
  p.placed = chance(random, 0.5);
  p.unit_m = chance(random, 0.5) ? 1 : log_between(random, 1e-12, p.orthographic ? 1e6 : 1e12);
  p.eye_m = p.unit_m * log_between(random, 1, 1e6);
  p.blended = chance(random, 0.3);
  p.oblique = !p.orthographic && chance(random, 0.2);
  return p;
}

Plan plan_of(HuntClass hunted, Random& random) {
  using enum HuntClass;
  if (hunted == mixed) return mixed_plan(random);
  Plan p;
  p.half = half_of(5, 150, random);
  p.placed = chance(random, 0.5);
  p.eye_m = log_between(random, 0.1, 1000);
  const bool any_depth = hunted == d16 || hunted == d24 || hunted == blended;
  if (hunted == narrow) p.half = half_of(1, 5, random);
  if (hunted == narrowest) p.half = half_of(0.1, 1, random);
  if (hunted == wide) p.half = half_of(150, 179.9, random);
  if (hunted == off_centre) {
    p.half = log_between(random, 0.01, 5);
    p.off = (chance(random, 0.5) ? -1 : 1) * log_between(random, 0.1, 100);
  }
  if (hunted == turned_far) {
    p.placed = true;
    p.eye_m = log_between(random, 1e3, 1e15);
  }
  if (hunted == orthographic) p.orthographic = true;
  if (hunted == standard) {
    p.standard = true;
    p.finite = chance(random, 0.5);
  }
  if (hunted == finite_far) p.finite = true;
  if (hunted == scaled) {
    p.unit_m = log_between(random, 1e-12, 1e15);
    p.eye_m = std::min(p.eye_m * p.unit_m, max_hunt_m);
  }
  if (hunted == oblique) {
    p.oblique = true;
    p.standard = chance(random, 0.5);
    if (chance(random, 0.3)) p.off = between(random, -2, 2) * p.half;
  }
  if (hunted == blended) p.blended = true;
  if (any_depth) {
    p.standard = chance(random, 0.5);
    p.finite = chance(random, 0.5);
    p.orthographic = chance(random, 0.25);
  }
  if (p.orthographic) {
    p.half = log_between(random, 1e-4, 1e5);
    p.finite = true;
    if (chance(random, 0.3)) p.off = between(random, -100, 100) * p.half;
  }
  return p;
}

// Limit of surfaces' distances as a multiple of near: up to it the format can distinguish distances.
double farthest_ratio(DepthFormat format, const Plan& p) {
  if (format == DepthFormat::d16) return 0x1p12;
  if (format == DepthFormat::d24 || p.standard || p.oblique) return 0x1p19;
  return 0x1p26;
}

// Nearest and farthest of the surfaces.
void choose_range(HuntView& h, const Plan& p, Random& random) {
  if (p.orthographic) {
    const double across = p.unit_m * p.half;
    h.near = chance(random, 0.3) ? 0 : between(random, -20, 5) * across;
    h.far = h.near + across * log_between(random, 0.01, 100);
    return;
  }
  const double steepest = p.half + std::abs(p.off) + 1, most = max_hunt_m / (4 * steepest);
  h.near = std::min(p.unit_m * log_between(random, 1e-3, 1), most / 2);
  h.far = std::min(h.near * log_between(random, 1.2, farthest_ratio(h.format, p)), most);
}

DepthFormat format_of(HuntClass hunted, Random& random) {
  if (hunted == HuntClass::d16) return DepthFormat::d16;
  if (hunted == HuntClass::d24) return DepthFormat::d24;
  if (hunted != HuntClass::mixed && hunted != HuntClass::oblique && hunted != HuntClass::blended)
    return DepthFormat::d32f;
  return one_of(random, {DepthFormat::d32f, DepthFormat::d32f, DepthFormat::d24, DepthFormat::d16});
}

CullView lens_of(const HuntView& h, const Plan& p, const glm::ivec2& size, Random& random) {
  const double aspect = double(size.x) / size.y, metres = p.orthographic ? p.unit_m : 1;
  Lens lens{.near = h.near, .orthographic = p.orthographic};
  lens.half_x = metres * (aspect >= 1 ? p.half : p.half * aspect);
  lens.half_y = metres * (aspect >= 1 ? p.half / aspect : p.half);
  lens.shift_x = p.off * metres * (chance(random, 0.8) ? 1 : 0);
  lens.shift_y = p.off * metres * between(random, -1, 1);
  lens.order = p.standard ? DepthOrder::standard : DepthOrder::reversed;
  if (p.finite)
    lens.far = p.orthographic ? h.near + (h.far - h.near) * between(random, 1.01, 3)
                              : h.far * log_between(random, 1.001, 100);
  return view_through(lens, size.x, size.y);
}

// Cuts the view at a plane that no image axis is parallel to (Lengyel, "Oblique View Frustum Depth Projection
// and Clipping", 2005). On the ray through (x, y, -1), x and y slopes, f = 1 - nx (x - sx) - ny (y - sy) is
// the plane's normal along the ray, where (sx, sy) is the image's centre. The plane is at
// near * steepest / f, so h.near is the nearest point of it in the image; rays with f <= 0 never meet it.
void tilt_near_plane(HuntView& h, const Plan& p, Random& random) {
  glm::dmat4& clip = h.view.clip_from_view;
  const double tilt = chance(random, 0.8) ? log_between(random, 0.01, 0.95) : between(random, 1, 3),
               share = unit(random), sign_x = chance(random, 0.5) ? -1 : 1,
               sign_y = chance(random, 0.5) ? -1 : 1;
  const double nx = sign_x * tilt * share * clip[0][0], ny = sign_y * tilt * (1 - share) * clip[1][1];
  const double steepest = 1 + tilt, centre = 1 + nx * clip[2][0] / clip[0][0] + ny * clip[2][1] / clip[1][1];
  // Depth is 1 - k (f / steepest - near / d), or k (...) if standard; where k > 1 there is a far plane.
  const double k = (chance(random, 0.5) ? 1 : log_between(random, 0.5, 2)) * (p.standard ? -1 : 1);
  clip[0][2] = k * nx / steepest;
  clip[1][2] = k * ny / steepest;
  clip[2][2] = k * centre / steepest - (p.standard ? 0 : 1);
  clip[3][2] = k * h.near;
}

void choose_lights_elsewhere(HuntView& h, Random& random) {
  if (h.hunted == HuntClass::spread || (h.hunted == HuntClass::mixed && chance(random, 0.25))) {
    h.elsewhere = 0.55;
    h.elsewhere_m = h.hunted == HuntClass::spread ? log_between(random, 1e3, 1e15)
                                                  : h.far * log_between(random, 1e3, 1e6);
    h.elsewhere_radius_m = h.elsewhere_m * 1e-3;
  }
  if (h.hunted == HuntClass::parked) {
    h.elsewhere = one_of(random, {1e-9, 0.5, 0.75});  // the first gives a single light
    h.elsewhere_m = one_of(random, {1e19, 1e30, double(std::numeric_limits<float>::max())});
    h.elsewhere_radius_m = one_of(random, {0.0, 1.0});
  }
}

}  // namespace

HuntSetting random_setting(Random& random, bool few) {
  HuntSetting s;
  CullerOptions& o = s.options;
  o.tile = one_of(random, {8, 16, 16, 32, 64});
  if (few) {
    choose_from_few(s, random);
    return s;
  }
  o.cull_test = one_of(random, cull_tests).test;
  o.depth_bounds = one_of(random, depth_bounds_modes).mode;
  s.slices = one_of(random, {1, 24});
  s.z_bins = one_of(random, {1, 64});
  s.spots = chance(random, 0.5);
  o.lists = s.slices == 1 && chance(random, 0.25) ? GridLists::masks : GridLists::lists;
  o.samples = chance(random, 0.85) ? 1 : one_of(random, {2, 4, 8});
  o.index_bits = chance(random, 0.2) ? 32 : 0;
  o.portable = chance(random, 0.1);
  s.both_shapes = chance(random, 1.0 / 16);
  return s;
}

void vary(HuntSetting& s, Random& random) {
  s.spacing = chance(random, 0.7) ? SliceSpacing::exponential : SliceSpacing::linear;
  if (s.slices > 1) s.slices = one_of(random, {2, 4, 8, 16, 24, 64});
  if (s.z_bins > 1) s.z_bins = one_of(random, {16, 64, 256});
  s.options.pixel_centres = chance(random, 0.85);
}

std::string to_string(const HuntSetting& s) {
  const CullerOptions& o = s.options;
  std::string text = to_string(o);
  const auto add = [&](bool there, const std::string& words) { text += there ? " " + words : ""; };
  add(s.slices > 1, fmt::format("slices {}", s.slices));
  add(s.z_bins > 1, fmt::format("z-bins {}", s.z_bins));
  add((s.slices > 1 || s.z_bins > 1) && s.spacing == SliceSpacing::linear, "linear");
  add(o.lists == GridLists::masks, "masks");
  add(o.samples > 1, fmt::format("samples {}", o.samples));
  add(!o.pixel_centres, "whole pixels");
  add(o.index_bits == 32, "32-bit indices");
  add(o.portable, "portable");
  add(s.spots, "spots");
  add(o.blend, "blended");
  add(o.depth_format != DepthFormat::d32f, o.depth_format == DepthFormat::d16 ? "d16" : "d24");
  return text;
}

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

const char* name_of(HuntClass hunted) {
  static constexpr const char* names[] = {
      "ordinary",     "narrow",   "narrowest",  "wide",   "off_centre", "turned_far",
      "orthographic", "standard", "finite_far", "d16",    "d24",        "oblique",
      "blended",      "scaled",   "spread",     "parked", "mixed"};
  static_assert(std::size(names) == hunt_class_count);
  return names[int(hunted)];
}

HuntView random_view(HuntClass hunted, const HuntSetting& setting, uint64_t seed) {
  Random random(seed);
  HuntView h{.hunted = hunted};
  const Plan plan = plan_of(hunted, random);
  h.format = format_of(hunted, random);
  h.blended = plan.blended;
  choose_range(h, plan, random);
  h.view = lens_of(h, plan, one_of(random, sizes), random);
  if (plan.oblique) tilt_near_plane(h, plan, random);
  if (plan.placed) {
    const double turn = between(random, 0, 2 * pi), tilt = std::asin(between(random, -1, 1));
    const glm::dvec3 eye(std::cos(turn) * std::cos(tilt), std::sin(tilt), std::sin(turn) * std::cos(tilt));
    h.view = placed(h.view, eye * plan.eye_m, between(random, -pi, pi), between(random, -1.5, 1.5));
  }
  const bool edges = h.near < max_hunt_edge_m / 2 && !plan.oblique;
  const double last_edge = edges ? std::min(h.far, max_hunt_edge_m) : 0;
  if (last_edge > h.near && setting.slices > 1)
    h.view.slice_edges = slice_edges(setting.spacing, setting.slices, h.near, last_edge);
  if (last_edge > h.near && setting.z_bins > 1)
    h.view.z_bin_edges = slice_edges(setting.spacing, setting.z_bins, h.near, last_edge);
  choose_lights_elsewhere(h, random);
  h.depth = random_surfaces(h, setting.options.samples, random);
  return h;
}

}  // namespace lightgrid::lab::verify
