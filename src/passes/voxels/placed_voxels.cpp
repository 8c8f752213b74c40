#include "passes/voxels/placed_voxels.h"

#include <algorithm>
#include <cmath>

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
  box.low = glm::min(box.low, p), box.high = glm::max(box.high, p);
  box.nearest_m = std::min(box.nearest_m, -from_eye.z),
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

void add_tiles(VisibleBox& box, const Seen& seen, const glm::dmat3& world_from_view,
               const TileDistances& distances) {
  const ViewParams& p = seen.params;
  const double near = seen.view.near_m, far = seen.plan.slice_far_m;
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
void add_instances(VisibleBox& box, const Seen& seen, const glm::dmat3& world_from_view,
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
               far = std::min(seen.plan.slice_far_m, all.farthest_m);
  if (!(near < far)) return;
  add_part(view, world_from_view, seen.params, {0, 0, seen.params.width, seen.params.height}, near, far);
  const glm::dvec3 low = glm::max(all.low, view.low), high = glm::min(all.high, view.high);
  if (glm::any(glm::greaterThan(low, high))) return;
  box.low = glm::min(box.low, low), box.high = glm::max(box.high, high);
  box.nearest_m = std::min(box.nearest_m, near), box.farthest_m = std::max(box.farthest_m, far);
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
  g.origin_x = float(first.x), g.origin_y = float(first.y), g.spacing_x = float(spacing.x),
  g.spacing_y = float(spacing.y);
  for (uint k = 0; k < g.size_z; ++k) {
    placed.slices.push_back(slice_of(first.z + k * spacing.z, spacing, spacing.x * spacing.y * spacing.z));
  }
  const glm::dmat3 view_from_world(view.view_from_world),
      volume_from_view = axes.from_world * glm::transpose(view_from_world);
  const glm::dvec3 eye = axes.from_world * (view.eye - axes.origin);
  set_places(placed.lookup, scaled_rows(1.0 / spacing, volume_from_view), (eye - first) / spacing);
  VoxelLookup& l = placed.lookup;
  l.spacing_x = float(spacing.x), l.spacing_y = float(spacing.y), l.spacing_z = float(spacing.z);
  l.half_diagonal_squared = placed.slices[0].half_diagonal_squared,
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
void place_in_parallel_view(PlacedVoxels& placed, const VoxelAxes& axes, const Seen& seen,
                            const VisibleBox& box, glm::dvec3 size) {
  const glm::dvec3 a = at_pixel(seen.params, 0, 0, 0),
                   b = at_pixel(seen.params, seen.params.width, seen.params.height, 0);
  const glm::dvec3 low(glm::min(glm::dvec2(a), glm::dvec2(b)), box.nearest_m),
      high(glm::max(glm::dvec2(a), glm::dvec2(b)), box.farthest_m);
  place_boxes(placed, axes, seen.view, low, glm::max((high - low) / (size - 1.0), 1e-6));
}

void place_in_projection(PlacedVoxels& placed, const Seen& seen, const VisibleBox& box, glm::dvec3 size) {
  const glm::dvec3 a = at_pixel(seen.params, 0, 0, 1),
                   b = at_pixel(seen.params, seen.params.width, seen.params.height, 1);
  const glm::dvec3 low = glm::min(a, b), spacing = (glm::max(a, b) - low) / (size - 1.0);
  const glm::dvec3 slope = glm::max(glm::abs(a), glm::abs(b));
  const double near = rounded_down(std::max(box.nearest_m, 1e-6)),
               far = std::max(rounded_up(box.farthest_m), near * 1.01);
  const double step = std::log(far / near) / (size.z - 1);
  VoxelGrid& g = placed.grid;
  g.origin_x = float(low.x), g.origin_y = float(low.y), g.spacing_x = float(spacing.x),
  g.spacing_y = float(spacing.y);
  for (uint k = 0; k < g.size_z; ++k) {
    const double place = near * std::exp(k * step), next = near * std::exp((k + 1) * step);
    // The box around the cell behind it, which is the larger one. Cells are sheared, most at the image's
    // corners.
    const glm::dvec3 cell(spacing.x * next + slope.x * (next - place),
                          spacing.y * next + slope.y * (next - place), next - place);
    placed.slices.push_back(slice_of(place, cell, spacing.x * spacing.y * place * place * (step * place)));
  }
  set_places(placed.lookup, scaled_rows({1 / spacing.x, 1 / spacing.y, 1 / step}, glm::dmat3(1)),
             {-low.x / spacing.x, -low.y / spacing.y, -std::log(near) / step});
  placed.lookup.half_diagonal_squared = float(placed.slices[0].half_diagonal_squared / (near * near));
  placed.lookup.core_squared = float(placed.slices[0].core_squared / (near * near));
  set_directions(placed.lookup, glm::dmat3(1));
}

}  // namespace

VisibleBox visible_box(const Seen& seen, const TileDistances& distances) {
  constexpr double none = std::numeric_limits<double>::infinity();
  VisibleBox box{glm::dvec3(none), glm::dvec3(-none), none, -none};
  const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(seen.view.view_from_world));
  if (distances.intervals.empty()) {
    add_instances(box, seen, world_from_view, seen.plan.opaque);
  } else {
    add_tiles(box, seen, world_from_view, distances);
  }
  add_instances(box, seen, world_from_view, seen.plan.blended);
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

PlacedVoxels place_voxels(const Seen& seen, const VoxelAxes& axes, const VisibleBox& box) {
  PlacedVoxels placed{};
  const glm::uvec3 size = voxel_size(seen.plan.settings.voxel_size);
  placed.grid.size_x = size.x, placed.grid.size_y = size.y, placed.grid.size_z = size.z;
  placed.lookup.last_x = float(size.x - 1), placed.lookup.last_y = float(size.y - 1),
  placed.lookup.last_z = float(size.z - 1);
  if (seen.plan.settings.voxel_space == VoxelSpace::world) {
    place_in_world(placed, axes, seen.view, box, size);
  } else if (axes.log_depth) {
    place_in_projection(placed, seen, box, size);
  } else {
    place_in_parallel_view(placed, axes, seen, box, size);
  }
  return placed;
}

glm::uvec3 voxel_size(VoxelSize size) {
  switch (size) {
    case VoxelSize::s16x16x4:
      return {16, 16, 4};
    case VoxelSize::s32x32x8:
      return {32, 32, 8};
    case VoxelSize::s64x64x16:
      return {64, 64, 16};
    case VoxelSize::s128x128x16:
      return {128, 128, 16};
    case VoxelSize::s128x128x32:
      return {128, 128, 32};
    case VoxelSize::s128x128x64:
      return {128, 128, 64};
    case VoxelSize::s256x256x64:
      return {256, 256, 64};
  }
  return {};
}

}  // namespace lightgrid
