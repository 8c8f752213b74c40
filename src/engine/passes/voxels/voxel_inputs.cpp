#include "passes/voxels/voxel_inputs.h"

#include "passes/voxels/voxel_settings.h"
#include "plan/settings/model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace lightgrid {
namespace {

constexpr double ball_of_unit_radius = 4.18879020478639098;  // 4 pi / 3
constexpr double steps_an_octave = 4;

double rounded_up(double size) {
  return std::exp2(std::ceil(std::log2(size) * steps_an_octave) / steps_an_octave);
}
double rounded_down(double size) {
  return std::exp2(std::floor(std::log2(size) * steps_an_octave) / steps_an_octave);
}

// From the eye along the view's own axes, to the world's.
void add(VisibleBox& box, const glm::dmat3& world_from_view, glm::dvec3 from_eye) {
  const glm::dvec3 p = world_from_view * from_eye;
  box.low = glm::min(box.low, p);
  box.high = glm::max(box.high, p);
  box.nearest_m = std::min(box.nearest_m, -from_eye.z);
  box.farthest_m = std::max(box.farthest_m, -from_eye.z);
}

glm::dvec3 at_pixel(const ViewParams& p, double x, double y, double distance) {
  const double slope_x = x * p.slope_x_scale + p.slope_x_offset,
               slope_y = y * p.slope_y_scale + p.slope_y_offset;
  const double scale = p.orthographic ? 1 : distance;
  return {slope_x * scale, slope_y * scale, -distance};
}

// The part of the view between two distances, of pixels [x0, x1] and [y0, y1].
void add_part(VisibleBox& box, const glm::dmat3& world_from_view, const ViewParams& p, glm::dvec4 pixels,
              double near, double far) {
  for (int corner = 0; corner < 8; ++corner) {
    add(box, world_from_view,
        at_pixel(p, corner & 1 ? pixels.z : pixels.x, corner & 2 ? pixels.w : pixels.y,
                 corner & 4 ? far : near));
  }
}

void add_tiles(VisibleBox& box, const ViewState& seen, const glm::dmat3& world_from_view,
               const TileDistances& distances) {
  const ViewParams& p = seen.params;
  const double near = seen.view.near_m, far = seen.plan.lists.far_m;
  for (uint y = 0; y < p.tiles_y; ++y) {
    for (uint x = 0; x < p.tiles_x; ++x) {
      const DepthInterval i = distances.intervals[size_t(y) * p.tiles_x + x];
      if (!(i.near <= i.far)) continue;
      const glm::dvec4 pixels(x * p.tile_size, y * p.tile_size, std::min((x + 1) * p.tile_size, p.width),
                              std::min((y + 1) * p.tile_size, p.height));
      add_part(box, world_from_view, p, pixels, std::clamp<double>(i.near, near, far),
               std::clamp<double>(i.far, near, far));
    }
  }
}

// The boxes of instances, where they lie in the box of the whole view.
void add_instances(VisibleBox& box, const ViewState& seen, const glm::dmat3& world_from_view,
                   const std::vector<int>& instances) {
  if (instances.empty()) return;
  constexpr double none = std::numeric_limits<double>::infinity();
  VisibleBox all{glm::dvec3(none), glm::dvec3(-none), none, -none}, view = all;
  for (const int i : instances) {
    const Aabb& bounds = seen.scene.meshes[seen.scene.instances[i].mesh].bounds;
    const glm::dmat4 to_view = view_from_object(seen.view, seen.scene.instances[i].world_from_object);
    for (int corner = 0; corner < 8; ++corner) {
      add(all, world_from_view,
          glm::dvec3(to_view * glm::dvec4(corner & 1 ? bounds.max.x : bounds.min.x,
                                          corner & 2 ? bounds.max.y : bounds.min.y,
                                          corner & 4 ? bounds.max.z : bounds.min.z, 1)));
    }
  }
  const double near = std::max(seen.view.near_m, all.nearest_m),
               far = std::min(seen.plan.lists.far_m, all.farthest_m);
  if (!(near < far)) return;
  add_part(view, world_from_view, seen.params, {0, 0, seen.params.width, seen.params.height}, near, far);
  const glm::dvec3 low = glm::max(all.low, view.low), high = glm::min(all.high, view.high);
  if (glm::any(glm::greaterThan(low, high))) return;
  box.low = glm::min(box.low, low);
  box.high = glm::max(box.high, high);
  box.nearest_m = std::min(box.nearest_m, near);
  box.farthest_m = std::max(box.farthest_m, far);
}

// Cells between samples are boxes of this size, or at most.
VoxelSlice slice_of(double place, glm::dvec3 cell, double volume) {
  const double radius = std::cbrt(volume / ball_of_unit_radius);
  return {float(place), float(0.25 * glm::dot(cell, cell)), float(radius * radius / 3), 0};
}

void set_directions(VoxelLookup& lookup, const glm::dmat3& view_from_volume) {
  float* values[3][3] = {{&lookup.view_x_from_x, &lookup.view_x_from_y, &lookup.view_x_from_z},
                         {&lookup.view_y_from_x, &lookup.view_y_from_y, &lookup.view_y_from_z},
                         {&lookup.view_z_from_x, &lookup.view_z_from_y, &lookup.view_z_from_z}};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) *values[row][column] = float(view_from_volume[column][row]);
  }
}

// place = from * q + offset.
void set_places(VoxelLookup& lookup, const glm::dmat3& from, glm::dvec3 offset) {
  float* values[3][4] = {{&lookup.x_from_x, &lookup.x_from_y, &lookup.x_from_z, &lookup.x_from_1},
                         {&lookup.y_from_x, &lookup.y_from_y, &lookup.y_from_z, &lookup.y_from_1},
                         {&lookup.z_from_x, &lookup.z_from_y, &lookup.z_from_z, &lookup.z_from_1}};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) *values[row][column] = float(from[column][row]);
    *values[row][3] = float(offset[row]);
  }
}

glm::dmat3 scaled_rows(const glm::dvec3& scale, const glm::dmat3& m) {
  return glm::dmat3(m[0] * scale, m[1] * scale, m[2] * scale);
}

// Samples along three axes: from `first`, metres along them from their origin.
void place_boxes(PlacedVoxels& placed, const VoxelAxes& axes, const View& view, glm::dvec3 first,
                 glm::dvec3 spacing) {
  VoxelGrid& g = placed.grid;
  g.origin_x = float(first.x);
  g.origin_y = float(first.y);
  g.spacing_x = float(spacing.x);
  g.spacing_y = float(spacing.y);
  for (uint k = 0; k < g.size_z; ++k) {
    placed.slices.push_back(slice_of(first.z + k * spacing.z, spacing, spacing.x * spacing.y * spacing.z));
  }
  const glm::dmat3 view_from_world(view.view_from_world),
      volume_from_view = axes.from_world * glm::transpose(view_from_world);
  const glm::dvec3 eye = axes.from_world * (view.eye - axes.origin);
  set_places(placed.lookup, scaled_rows(1.0 / spacing, volume_from_view), (eye - first) / spacing);
  VoxelLookup& l = placed.lookup;
  l.spacing_x = float(spacing.x);
  l.spacing_y = float(spacing.y);
  l.spacing_z = float(spacing.z);
  l.half_diagonal_squared = placed.slices[0].half_diagonal_squared;
  l.core_squared = placed.slices[0].core_squared;
  set_directions(placed.lookup, glm::transpose(volume_from_view));
}

void place_in_world(PlacedVoxels& placed, const VoxelAxes& axes, const View& view, const VisibleBox& box,
                    glm::dvec3 size) {
  const glm::dvec3 a = axes.from_world * (view.eye + box.low), b = axes.from_world * (view.eye + box.high);
  const glm::dvec3 low = glm::min(a, b), high = glm::max(a, b);
  // The first sample may lie up to a spacing before the box.
  glm::dvec3 spacing = (high - low) / (size - 2.0);
  const double least = std::max({spacing.x, spacing.y, spacing.z, 1e-3}) / 64;
  for (int axis = 0; axis < 3; ++axis) spacing[axis] = rounded_up(std::max(spacing[axis], least));
  const glm::dvec3 first = glm::floor(low / spacing) * spacing;
  place_boxes(placed, axes, view, first - axes.from_world * axes.origin, spacing);
}

// Parallel views: the image across and up, distance away.
void place_in_parallel_view(PlacedVoxels& placed, const VoxelAxes& axes, const ViewState& seen,
                            const VisibleBox& box, glm::dvec3 size) {
  const glm::dvec3 a = at_pixel(seen.params, 0, 0, 0),
                   b = at_pixel(seen.params, seen.params.width, seen.params.height, 0);
  const glm::dvec3 low(glm::min(glm::dvec2(a), glm::dvec2(b)), box.nearest_m),
      high(glm::max(glm::dvec2(a), glm::dvec2(b)), box.farthest_m);
  place_boxes(placed, axes, seen.view, low, glm::max((high - low) / (size - 1.0), 1e-6));
}

void place_in_projection(PlacedVoxels& placed, const ViewState& seen, const VisibleBox& box,
                         glm::dvec3 size) {
  const glm::dvec3 a = at_pixel(seen.params, 0, 0, 1),
                   b = at_pixel(seen.params, seen.params.width, seen.params.height, 1);
  const glm::dvec3 low = glm::min(a, b), spacing = (glm::max(a, b) - low) / (size - 1.0);
  const glm::dvec3 slope = glm::max(glm::abs(a), glm::abs(b));
  const double near = rounded_down(std::max(box.nearest_m, 1e-6)),
               far = std::max(rounded_up(box.farthest_m), near * 1.01);
  const double step = std::log2(far / near) / (size.z - 1);
  VoxelGrid& g = placed.grid;
  g.origin_x = float(low.x);
  g.origin_y = float(low.y);
  g.spacing_x = float(spacing.x);
  g.spacing_y = float(spacing.y);
  for (uint k = 0; k < g.size_z; ++k) {
    const double place = near * std::exp2(k * step), next = near * std::exp2((k + 1) * step);
    // The box around the cell behind it, which is the larger one. Cells are sheared, most at the image's
    // corners.
    const glm::dvec3 cell(spacing.x * next + slope.x * (next - place),
                          spacing.y * next + slope.y * (next - place), next - place);
    placed.slices.push_back(
        slice_of(place, cell, spacing.x * spacing.y * place * place * (step * std::numbers::ln2 * place)));
  }
  set_places(placed.lookup, scaled_rows({1 / spacing.x, 1 / spacing.y, 1 / step}, glm::dmat3(1)),
             {-low.x / spacing.x, -low.y / spacing.y, -std::log2(near) / step});
  placed.lookup.half_diagonal_squared = float(placed.slices[0].half_diagonal_squared / (near * near));
  placed.lookup.core_squared = float(placed.slices[0].core_squared / (near * near));
  set_directions(placed.lookup, glm::dmat3(1));
}

}  // namespace

VisibleBox visible_box(const ViewState& seen, const TileDistances& distances) {
  constexpr double none = std::numeric_limits<double>::infinity();
  VisibleBox box{glm::dvec3(none), glm::dvec3(-none), none, -none};
  const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(seen.view.view_from_world));
  if (distances.intervals.empty()) {
    add_instances(box, seen, world_from_view, seen.plan.surfaces.opaque);
  } else {
    add_tiles(box, seen, world_from_view, distances);
  }
  add_instances(box, seen, world_from_view, seen.plan.surfaces.blended);
  if (!(box.low.x <= box.high.x))
    add_part(box, world_from_view, seen.params, glm::dvec4(0), seen.view.near_m, seen.view.near_m);
  return box;
}

VoxelAxes voxel_axes(const View& view, VoxelSpace space) {
  const glm::dmat3 view_from_world(view.view_from_world);
  if (space == VoxelSpace::view && view.orthographic)
    return {scaled_rows({1, 1, -1}, view_from_world), view.eye, false};
  if (space == VoxelSpace::view) return {view_from_world, view.eye, true};
  // Near enough that floats are precise: to 6e-5 m.
  constexpr double step_m = 1024;
  return {glm::dmat3(1, 0, 0, 0, 0, 1, 0, 1, 0), glm::round(view.eye / step_m) * step_m, false};
}

PlacedVoxels place_voxels(const ViewState& seen, const VoxelAxes& axes, const VisibleBox& box) {
  PlacedVoxels placed{};
  const glm::uvec3 size = voxel_size(seen.plan.settings[setting::voxel_size]);
  placed.grid.size_x = size.x;
  placed.grid.size_y = size.y;
  placed.grid.size_z = size.z;
  placed.lookup.last_x = float(size.x - 1);
  placed.lookup.last_y = float(size.y - 1);
  placed.lookup.last_z = float(size.z - 1);
  if (seen.plan.settings[setting::voxel_space] == VoxelSpace::world) {
    place_in_world(placed, axes, seen.view, box, size);
  } else if (axes.log_depth) {
    place_in_projection(placed, seen, box, size);
  } else {
    place_in_parallel_view(placed, axes, seen, box, size);
  }
  return placed;
}

glm::uvec3 voxel_size(VoxelSize size) {
  static constexpr glm::uvec3 sizes[] = {{16, 16, 4},    {32, 32, 8},    {64, 64, 16},  {128, 128, 16},
                                         {128, 128, 32}, {128, 128, 64}, {256, 256, 64}};
  return sizes[size_t(size)];
}

namespace {

constexpr size_t group = VOXEL_LIGHT_GROUP;
constexpr float far_off = 3e18f;           // its square is still a float
constexpr double longest_radius_m = 7e18;  // likewise
constexpr double wide = 1e30;  // 1 - cosine of the cone of a light without one: any widening is nothing

uint64_t spread_bits(uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  x = (x | x << 2) & 0x1249249249249249;
  return x;
}

// Along a Morton curve through the box of all lights; those that are large compared with it last, so that
// they enlarge no box of small ones.
std::vector<uint32_t> neighbours_first(const std::vector<glm::dvec4>& lights) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const glm::dvec4& l : lights) {
    low = glm::min(low, glm::dvec3(l));
    high = glm::max(high, glm::dvec3(l));
  }
  // Half of it: all of it may be more than a double holds.
  const glm::dvec3 size = glm::max(0.5 * high - 0.5 * low, 0.5e-9);
  const double large = 0.25 * glm::length(size);
  std::vector<std::pair<uint64_t, uint32_t>> keys;
  keys.reserve(lights.size());
  for (uint32_t i = 0; i < lights.size(); ++i) {
    const glm::dvec3 at = glm::clamp((0.5 * glm::dvec3(lights[i]) - 0.5 * low) / size, 0.0, 1.0) * 1048575.0;
    const uint64_t code =
        spread_bits(uint64_t(at.x)) | spread_bits(uint64_t(at.y)) << 1 | spread_bits(uint64_t(at.z)) << 2;
    keys.emplace_back(code | (lights[i].w > large ? uint64_t(1) << 62 : 0), i);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<uint32_t> order;
  order.reserve(keys.size());
  for (const auto& [key, i] : keys) order.push_back(i);
  return order;
}

}  // namespace

void GroupedLights::sort(const ViewState& seen) {
  std::vector<glm::dvec4> by;
  by.reserve(seen.plan.lights.local.size());
  for (const int i : seen.plan.lights.local) {
    const Light& light = seen.scene.lights[i];
    by.emplace_back(light.position,
                    std::min(range_of(light, size_t(i), ranges_of(seen.plan.settings)), longest_radius_m));
  }
  if (by == sorted_by_) return;
  sorted_by_ = std::move(by);
  order_ = neighbours_first(sorted_by_);
}

void GroupedLights::update(PassContext& work, const VoxelAxes& axes) {
  sort(work);
  View along;
  along.view_from_world = glm::dmat4(axes.from_world);
  along.eye = axes.origin;
  const std::vector<ViewLight> lights = lights_in_view(work.scene, along, ranges_of(work.plan.settings));
  groups_ = uint32_t((order_.size() + group - 1) / group);
  const size_t padded = (groups_ + group - 1) / group * group;  // boxes are read by as many at once
  std::vector<float> places(4 * group * groups_, far_off), boxes(6 * padded, far_off);
  std::vector<glm::vec4> colors(group * groups_, glm::vec4(0)), cones;
  if (work.plan.lights.spots) cones.assign(2 * group * groups_, glm::vec4(0));
  for (size_t i = 0; i < places.size(); ++i) {
    if (i / group % 4 == 3) places[i] = 0;
  }
  brightest_ = 0;
  for (size_t n = 0; n < order_.size(); ++n) {
    const ViewLight& light = lights[size_t(work.plan.lights.local[order_[n]])];
    const size_t g = n / group, lane = n % group;
    const double radius = std::min(light.radius_m, longest_radius_m);
    const glm::vec3 at(glm::clamp(light.position, -double(far_off), double(far_off)));
    for (int axis = 0; axis < 3; ++axis) {
      places[(4 * g + axis) * group + lane] = at[axis];
      float& low = boxes[(g / 16 * 6 + axis) * 16 + g % 16];
      float& high = boxes[(g / 16 * 6 + 3 + axis) * 16 + g % 16];
      // Rounded outward.
      const float from = std::nextafter(float(at[axis] - radius), -far_off * 10),
                  to = std::nextafter(float(at[axis] + radius), far_off * 10);
      low = lane == 0 ? from : std::min(low, from);
      high = lane == 0 ? to : std::max(high, to);
    }
    places[(4 * g + 3) * group + lane] = float(radius);
    const glm::dvec3 color = light.radius_m > 0 ? largest_intensity(light) : glm::dvec3(0);
    colors[n] = glm::vec4(glm::vec3(color),
                          float(std::min(light.min_falloff, double(std::numeric_limits<float>::max()))));
    brightest_ = std::max({brightest_, colors[n].x, colors[n].y, colors[n].z});
    if (cones.empty()) continue;
    const bool spot = has_cone(light);
    const double scale = spot ? 1 / (light.cos_inner - light.cos_outer) : 0;
    // Directions are those to the light: the axis is turned around.
    cones[2 * n] = glm::vec4(glm::vec3(-light.direction * scale), spot ? float(-light.cos_outer * scale) : 1);
    cones[2 * n + 1] = glm::vec4(float(scale), spot ? float(1 - light.cos_outer) : float(wide),
                                 float(1 - light.cos_outer * light.cos_outer), float(light.max_falloff));
  }
  const bool same =
      version_ > 0 && places == places_ && boxes == boxes_ && colors == colors_ && cones == cones_;
  if (same) return;
  ++version_;
  places_ = std::move(places);
  boxes_ = std::move(boxes);
  colors_ = std::move(colors);
  cones_ = std::move(cones);
  ClDevice& device = *work.renderer.cl;
  constexpr const char* what = "uploading lights of voxels";
  this->places.put(device, what, places_);
  this->boxes.put(device, what, boxes_);
  this->colors.put(device, what, colors_);
  this->cones.put(device, what, cones_);
}

size_t GroupedLights::memory_bytes() const {
  return boxes.bytes() + places.bytes() + colors.bytes() + cones.bytes();
}

}  // namespace lightgrid
