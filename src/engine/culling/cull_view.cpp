#include "culling/cull_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "base/error.h"
#include "culling/view_depth.h"
#include "shared/light_grid.h"

namespace lightgrid {
namespace {

constexpr int max_tiles = 32000;  // a side; tile coordinates are stored in 15 bits

template <size_t most>
std::array<float, most> keys_of(const CullView& view, const std::vector<float>& edges) {
  const glm::dmat4& clip = view.clip_from_view;
  std::array<float, most> keys;
  keys.fill(std::numeric_limits<float>::infinity());
  for (size_t i = 0; i < edges.size(); ++i) {
    const double d = edges[i];
    const double depth = clip[3][2] - clip[2][2] * d;
    keys[i] = depth_key(view, float(is_orthographic(view) ? depth : depth / d));
  }
  return keys;
}

void check_edges(const CullView& view, const std::vector<float>& edges, const char* name, size_t most) {
  if (edges.size() >= most) throw input_error("view: {} {} are more than {}", edges.size(), name, most - 1);
  for (size_t i = 0; i < edges.size(); ++i) {
    const float edge = edges[i], before = i ? edges[i - 1] : -INFINITY;
    if (!std::isfinite(edge) || !(edge >= before))
      throw input_error("view: {}[{}] is {} after {}", name, i, edge, before);
    if (!(edge > 0) && !is_orthographic(view))
      throw input_error("view: {}[{}] is {}, not in front of the eye", name, i, edge);
  }
}

}  // namespace

std::vector<float> slice_edges(SliceSpacing spacing, int slices, double near_m, double far_m) {
  if (spacing == SliceSpacing::exponential && !(near_m > 0)) {
    if (far_m > 0)
      near_m = far_m / 1000;
    else
      spacing = SliceSpacing::linear;
  }
  std::vector<float> edges;
  for (int k = 1; k < slices; ++k) {
    const double part = double(k) / slices;
    edges.push_back(float(spacing == SliceSpacing::exponential ? near_m * std::pow(far_m / near_m, part)
                                                               : near_m + (far_m - near_m) * part));
  }
  return edges;
}

std::array<float, MOST_SLICES> slice_keys(const CullView& view) {
  return keys_of<MOST_SLICES>(view, view.slice_edges);
}
std::array<float, MOST_Z_BINS> z_bin_keys(const CullView& view) {
  return keys_of<MOST_Z_BINS>(view, view.z_bin_edges);
}

float depth_key(const CullView& view, float depth) { return has_standard_depth(view) ? depth : -depth; }

bool is_orthographic(const CullView& view) { return view.clip_from_view[2][3] == 0; }

// With reversed depth, clip z / w decreases with distance.
bool has_standard_depth(const CullView& view) {
  return is_orthographic(view) ? view.clip_from_view[2][2] < 0 : view.clip_from_view[3][2] < 0;
}

double near_distance(const CullView& view) {
  const glm::dmat4& clip = view.clip_from_view;
  const double depth = has_standard_depth(view) ? 0 : 1;
  return is_orthographic(view) ? (clip[3][2] - depth) / clip[2][2] : clip[3][2] / (depth + clip[2][2]);
}

double distance_of_key(const CullView& view, double key) {
  const glm::dmat4& clip = view.clip_from_view;
  const double depth = has_standard_depth(view) ? key : -key;
  if (is_orthographic(view)) return (clip[3][2] - depth) / clip[2][2];
  const double distance = clip[3][2] / (depth + clip[2][2]);
  return distance >= 0 ? distance : std::numeric_limits<double>::infinity();
}

namespace {

// Lights past farthest_light (1e16 m) are scaled towards the eye, together with the surfaces that they light.
// Scaled surfaces stay at least `most` away along the axis; a slice that begins farther away could miss them.
void check_edge_distance(const CullView& view, const std::vector<float>& edges, const char* name) {
  if (edges.empty() || is_orthographic(view)) return;
  const glm::dmat4& clip = view.clip_from_view;
  const double x = (1 + std::abs(clip[2][0])) / clip[0][0], y = (1 + std::abs(clip[2][1])) / clip[1][1];
  const double most = 2e15 / std::sqrt(1 + x * x + y * y);
  if (!(edges.back() <= most)) {
    throw input_error("view: {}[{}] is {} m, past {} m, the farthest that this field of view can have", name,
                      edges.size() - 1, edges.back(), most);
  }
}

void check_finite(const CullView& view) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      const double clip = view.clip_from_view[c][r], world = view.view_from_world[c][r];
      if (!std::isfinite(clip)) throw input_error("view: clip_from_view[{}][{}] is {}", r, c, clip);
      if (!std::isfinite(world)) throw input_error("view: view_from_world[{}][{}] is {}", r, c, world);
    }
  }
  for (int a = 0; a < 3; ++a) {
    if (!std::isfinite(view.eye[a])) throw input_error("view: eye[{}] is {}", a, view.eye[a]);
  }
}

// An entry that must be 0 in a projection along -z, and its name in an error message.
struct ZeroEntry {
  int row, column;
  const char* otherwise;
};
constexpr ZeroEntry zero_in_both[] = {
    {0, 1, "a shear: clip x depends on y"},
    {1, 0, "a shear: clip y depends on x"},
    {3, 0, "a tilted w row: w depends on x"},
    {3, 1, "a tilted w row: w depends on y"},
};
constexpr ZeroEntry zero_in_perspective[] = {
    {0, 3, "a translation; an off-centre perspective has its offset in clip_from_view[0][2]"},
    {1, 3, "a translation; an off-centre perspective has its offset in clip_from_view[1][2]"},
};
constexpr ZeroEntry zero_in_orthographic[] = {
    {2, 0, "an oblique near plane"},
    {2, 1, "an oblique near plane"},
    {0, 2, "a shear: clip x depends on z"},
    {1, 2, "a shear: clip y depends on z"},
};

void check_zeros(const CullView& view, std::span<const ZeroEntry> entries) {
  for (const ZeroEntry& entry : entries) {
    const double value = view.clip_from_view[entry.column][entry.row];
    if (value != 0) {
      throw input_error("view: clip_from_view[{}][{}] is {}, not 0: {}, which culling cannot do", entry.row,
                        entry.column, value, entry.otherwise);
    }
  }
}

void check_projection(const CullView& view) {
  const glm::dmat4& clip = view.clip_from_view;
  check_zeros(view, zero_in_both);
  const bool perspective = clip[2][3] == -1 && clip[3][3] == 0,
             orthographic = clip[2][3] == 0 && clip[3][3] == 1;
  if (!perspective && !orthographic) {
    throw input_error(
        "view: clip_from_view's last row is [{} {} {} {}], neither [0 0 -1 0], a perspective view along "
        "-z, nor [0 0 0 1], an orthographic one",
        clip[0][3], clip[1][3], clip[2][3], clip[3][3]);
  }
  check_zeros(view, perspective ? std::span<const ZeroEntry>(zero_in_perspective)
                                : std::span<const ZeroEntry>(zero_in_orthographic));
  for (const int axis : {0, 1}) {
    if (!(clip[axis][axis] > 0))
      throw input_error("view: clip_from_view[{0}][{0}] is {1}, not above 0", axis, clip[axis][axis]);
  }
  if ((perspective ? clip[3][2] : clip[2][2]) == 0) {
    throw input_error("view: clip_from_view[2][{}] is 0: depth does not depend on distance",
                      perspective ? 3 : 2);
  }
}

// Kernels read these numbers as float; the slack assumes finite, normal products.
void check_range(const CullView& view) {
  const glm::dmat4& clip = view.clip_from_view;
  for (const double value : {2 / clip[0][0], 2 / clip[1][1], clip[2][0], clip[2][1], clip[3][0], clip[3][1],
                             clip[2][2], clip[3][2], clip[0][0], clip[1][1]}) {
    if (!(std::abs(value) < 1e18))
      throw input_error("view: clip_from_view has a number past 10^18 in it, or in its inverse");
  }
  // The nearest surface in the image.
  const double near =
      is_oblique(view) ? near_distance(straightened(view, DepthFormat::d32f, 1).view) : near_distance(view);
  if (!is_orthographic(view)) {
    if (!(near > 0)) throw input_error("view: the near plane is at {} m, not in front of the eye", near);
    if (!(near >= 1e-37 && near <= 1e15))
      throw input_error("view: the near plane is at {} m, not between 10^-37 and 10^15 m", near);
    return;
  }
  const double far = near + 1 / std::abs(clip[2][2]);
  for (const double edge : {near, far, (1 - clip[3][0]) / clip[0][0], (-1 - clip[3][0]) / clip[0][0],
                            (1 - clip[3][1]) / clip[1][1], (-1 - clip[3][1]) / clip[1][1]}) {
    if (!(std::abs(edge) <= 1e15))
      throw input_error("view: a side of the orthographic view is at {} m, past 10^15 m", edge);
  }
}

// MAX_STRETCH follows from this bound.
void check_rigid(const CullView& view) {
  const glm::dmat3 rotation(view.view_from_world);
  const glm::dmat3 error = rotation * glm::transpose(rotation) - glm::dmat3(1);
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      if (!(std::abs(error[c][r]) < 1e-5)) throw input_error("view: view_from_world is not rigid");
    }
  }
}

}  // namespace

void check_view(const CullView& view, int tile) {
  if (view.width < 1 || view.height < 1 || (view.width - 1) / tile >= max_tiles ||
      (view.height - 1) / tile >= max_tiles) {
    throw input_error("view: {} x {} pixels is not a size that {}-pixel tiles can cover", view.width,
                      view.height, tile);
  }
  check_finite(view);
  check_projection(view);
  check_range(view);
  if (is_oblique(view)) {
    if (!view.slice_edges.empty())
      throw input_error("view: {} slice_edges with an oblique near plane", view.slice_edges.size());
    if (!view.z_bin_edges.empty())
      throw input_error("view: {} z_bin_edges with an oblique near plane", view.z_bin_edges.size());
  }
  check_edges(view, view.slice_edges, "slice_edges", MOST_SLICES);
  check_edges(view, view.z_bin_edges, "z_bin_edges", MOST_Z_BINS);
  check_edge_distance(view, view.slice_edges, "slice_edges");
  check_edge_distance(view, view.z_bin_edges, "z_bin_edges");
  check_rigid(view);
}

ViewParams view_params(const CullView& view, int tile) {
  const glm::dmat4& clip = view.clip_from_view;  // column, row
  ViewParams p{};
  p.orthographic = is_orthographic(view);
  // NDC x = 2 px / width - 1. Perspective: NDC x = clip[0][0] * (x / d) - clip[2][0], since w = d = -z.
  const double ndc_x_offset = p.orthographic ? clip[3][0] : -clip[2][0];
  const double ndc_y_offset = p.orthographic ? clip[3][1] : -clip[2][1];
  p.slope_x_scale = float(2.0 / (view.width * clip[0][0]));
  p.slope_x_offset = float((-1.0 - ndc_x_offset) / clip[0][0]);
  p.slope_y_scale = float(2.0 / (view.height * clip[1][1]));
  p.slope_y_offset = float((-1.0 - ndc_y_offset) / clip[1][1]);
  // Perspective: depth = (clip[2][2] * z + clip[3][2]) / d; orthographic: depth = clip[2][2] * z +
  // clip[3][2]; z = -d.
  p.depth_a = float(p.orthographic ? 1.0 / clip[2][2] : clip[2][2]);
  p.depth_b = float(clip[3][2]);
  p.near_distance = float(near_distance(view));
  p.width = view.width;
  p.height = view.height;
  p.tile_size = tile;
  p.tiles_x = (view.width + tile - 1) / tile;
  p.tiles_y = (view.height + tile - 1) / tile;
  p.bins_x = (p.tiles_x + BIN_TILES - 1) / BIN_TILES;
  p.bins_y = (p.tiles_y + BIN_TILES - 1) / BIN_TILES;
  return p;
}

CullParams cull_params(const CullView& view, int tile) {
  const ViewParams v = view_params(view, tile);
  const glm::dmat4& clip = view.clip_from_view;
  const glm::dmat4& m = view.view_from_world;  // column, row
  CullParams p{};
  p.x_axis_x = float(m[0][0]);
  p.x_axis_y = float(m[1][0]);
  p.x_axis_z = float(m[2][0]);
  p.y_axis_x = float(m[0][1]);
  p.y_axis_y = float(m[1][1]);
  p.y_axis_z = float(m[2][1]);
  p.d_axis_x = float(-m[0][2]);
  p.d_axis_y = float(-m[1][2]);
  p.d_axis_z = float(-m[2][2]);
  p.slope_x_scale = v.slope_x_scale;
  p.slope_x_offset = v.slope_x_offset;
  p.slope_y_scale = v.slope_y_scale;
  p.slope_y_offset = v.slope_y_offset;
  const double ndc_x_offset = v.orthographic ? clip[3][0] : -clip[2][0];
  const double ndc_y_offset = v.orthographic ? clip[3][1] : -clip[2][1];
  p.tile_x_scale = float(clip[0][0] * view.width / 2 / tile);
  p.tile_x_offset = float((1 + ndc_x_offset) * view.width / 2 / tile);
  p.tile_y_scale = float(clip[1][1] * view.height / 2 / tile);
  p.tile_y_offset = float((1 + ndc_y_offset) * view.height / 2 / tile);
  p.depth_a = v.depth_a;
  p.depth_b = v.depth_b;
  p.depth_a_rest = v.orthographic ? 0 : two_floats(clip[2][2]).rest;
  // Blended surfaces may lie past the farthest surface, where lights are scaled towards the eye; 1e12 m is
  // nearer than any scaled light.
  p.near_distance = v.orthographic ? v.near_distance : std::min(v.near_distance, 1e12f);
  // A tile's side p * scale + offset rounds by 3u |side| + 5u |offset|, in the kernels and again in shading,
  // which may fuse the product and the sum. SLACK covers the first term. docs/details/hard_cases.md#slack
  const float side_slack = 12 * 0x1p-24f * (std::abs(p.slope_x_offset) + std::abs(p.slope_y_offset));
  (v.orthographic ? p.side_slack_m : p.side_slack) = side_slack;
  p.orthographic = v.orthographic;
  p.standard_depth = has_standard_depth(view);
  p.width = v.width;
  p.height = v.height;
  p.tile_size = v.tile_size;
  p.tiles_x = v.tiles_x;
  p.tiles_y = v.tiles_y;
  p.bins_x = v.bins_x;
  p.bins_y = v.bins_y;
  p.slices = uint(view.slice_edges.size() + 1);
  return p;
}

}  // namespace lightgrid
