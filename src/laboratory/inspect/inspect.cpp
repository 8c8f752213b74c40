#include "inspect/inspect.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "frames/frame_lists.h"
#include "oracle/attenuation.h"
#include "oracle/cell.h"
#include "oracle/lit_set.h"
#include "oracle/pixel_tiles.h"
#include "oracle/position.h"
#include "plan/settings/cull_test.h"
#include "plan/settings/grid.h"
#include "shared/cull_tests.h"

namespace lightgrid::lab {
namespace {

// Replaces infinity where a product with 0 must be 0, as in the kernels.
constexpr double far_away = 1e18;
constexpr double endless = std::numeric_limits<double>::infinity();

// Distance from the cone's surface, outside it, to the sphere around the box.
double cone_margin(const CellBox& box, const LightBounds& light) {
  const glm::dvec3 to_centre = box.centre() - light.position;
  const double along = glm::dot(to_centre, light.direction);
  const double across = glm::length(to_centre - along * light.direction);
  const double sine = std::sqrt(std::max(0.0, 1 - light.cos_outer * light.cos_outer));
  return box.radius() - std::max(across * light.cos_outer - along * sine, -along);
}

TestMargins margins_of(const Cell& cell, const LightBounds& light) {
  const glm::dvec3& p = light.position;
  const double r = light.radius_m;
  const CellBox box = box_around(cell);
  TestMargins m;
  m.interval = r + std::min(-p.z - cell.near, cell.far + p.z);
  m.planes = r - outside_of_sides(cell, p);
  m.aabb = r - box.distance(p);
  const bool bounded = std::isfinite(cell.near) && std::isfinite(cell.far);
  m.sphere = bounded ? r + box.radius() - glm::length(p - box.centre()) : endless;
  m.exact = r - distance_to_cell(cell, p);
  if (light.cos_outer >= 0) m.cone = bounded ? cone_margin(box, light) : endless;
  return m;
}

struct NamedMargin {
  const char* test;
  double margin_m;
};

// Margins of the tests that these settings use, in their order.
std::vector<NamedMargin> margins_in_use(const TestMargins& m, CullTest test) {
  std::vector<NamedMargin> used = {{"interval", m.interval}};
  const CullTestRow& parts = row_of(test);
  if (parts.planes) used.push_back({"planes", m.planes});
  if (parts.box) used.push_back({"aabb", m.aabb});
  if (parts.sphere) used.push_back({"sphere", m.sphere});
  if (parts.distance) used.push_back({"exact", m.exact});
  if (m.cone) used.push_back({"cone", *m.cone});
  if (m.pieces) used.push_back({"pieces", *m.pieces});
  return used;
}

NamedMargin least(const std::vector<NamedMargin>& used) {
  return *std::min_element(used.begin(), used.end(),
                           [](auto& a, auto& b) { return a.margin_m < b.margin_m; });
}

// The deciding test: the first that drops the light or, for a listed light, the one with the least margin.
NamedMargin deciding(const std::vector<NamedMargin>& used, bool listed) {
  if (listed) return least(used);
  for (const NamedMargin& m : used) {
    if (m.margin_m < 0) return m;
  }
  return {"other", least(used).margin_m};
}

// The intervals of distances within the cell that these depth bounds distinguish; empty if they distinguish
// none.
std::vector<DepthInterval> pieces_of(const Cell& cell, const std::vector<glm::dvec3>& surfaces,
                                     DepthBoundsMode mode) {
  const float near = float(cell.near), far = float(cell.far), middle = near + 0.5f * (far - near);
  const bool one = mode == DepthBoundsMode::none || mode == DepthBoundsMode::minmax;
  if (one || !(near <= far) || !std::isfinite(far - near)) return {};
  if (mode == DepthBoundsMode::halfz) return {{near, middle}, {middle, far}};
  const bool mask = mode == DepthBoundsMode::mask32;
  const int count = mask ? 32 : 2;
  const float length = (far - near) / count;
  std::vector<DepthInterval> pieces(count, {far, near});
  for (const glm::dvec3& p : surfaces) {
    const float distance = float(-p.z);
    const int i = length > 0 ? std::clamp(int((distance - near) / length), 0, count - 1) : 0;
    DepthInterval& piece = pieces[i];
    // A slot's bit has no finer depth
    piece = mask ? DepthInterval{near + i * length, near + (i + 1) * length}
                 : DepthInterval{std::min(piece.near, distance), std::max(piece.far, distance)};
  }
  std::erase_if(pieces, [](const DepthInterval& piece) { return !(piece.near <= piece.far); });
  return pieces;
}

// A mask's slots bound distances only; a half is a cell of its own and tested as one.
double pieces_margin(const Cell& cell, const std::vector<DepthInterval>& pieces, const LightBounds& light,
                     const Settings& settings) {
  double best = -endless;
  for (const DepthInterval& piece : pieces) {
    Cell part = cell;
    part.near = piece.near;
    part.far = piece.far;
    const TestMargins m = margins_of(part, light);
    const bool mask = settings[setting::depth_bounds] == DepthBoundsMode::mask32;
    best =
        std::max(best, mask ? m.interval : least(margins_in_use(m, settings[setting::cull_test])).margin_m);
  }
  return best;
}

double nearness(const TestMargins& m) {
  return std::min({m.exact, m.cone.value_or(m.exact), m.pieces.value_or(m.exact)});
}

bool touches_cell(const Cell& cell, const LightBounds& light) {
  if (!light.has_cone()) return sphere_touches_cell(cell, light.position, light.radius_m);
  return cone_touches_cell(cell, light.position, light.direction, light.cos_outer, light.radius_m) !=
         Touch::no;
}

// Surfaces of the cell's pixels, in view space.
std::vector<glm::dvec3> surfaces_of(const CapturedFrame& frame, const FrameGrid& grid,
                                    const PixelInspection& pixel) {
  const PixelCells cells = cells_of(frame, grid);
  std::vector<glm::dvec3> surfaces;
  for (int y = pixel.y0; y < pixel.y1; ++y) {
    for (int x = pixel.x0; x < pixel.x1; ++x) {
      if (!is_covered(frame, x, y) || cells.slice(x, y) != pixel.slice) continue;
      surfaces.push_back(position_from_depth(frame.view, x, y, frame.depth[frame.view.grid().index(x, y)]));
    }
  }
  return surfaces;
}

PixelInspection place_of(const CapturedFrame& frame, const FrameGrid& grid,
                         const std::vector<DepthInterval>& intervals, int x, int y) {
  const View& view = frame.view;
  PixelInspection pixel;
  pixel.x = x;
  pixel.y = y;
  pixel.depth = frame.depth[view.grid().index(x, y)];
  pixel.covered = is_covered(frame, x, y);
  pixel.distance_m = pixel.covered ? -position_from_depth(view, x, y, pixel.depth).z : endless;
  pixel.cell_x = x / grid.tile;
  pixel.cell_y = y / grid.tile;
  if (pixel.covered) pixel.slice = cells_of(frame, grid).slice(x, y);
  pixel.x0 = pixel.cell_x * grid.tile;
  pixel.x1 = std::min(pixel.x0 + grid.tile, view.width);
  pixel.y0 = pixel.cell_y * grid.tile;
  pixel.y1 = std::min(pixel.y0 + grid.tile, view.height);
  const DepthInterval interval = intervals[size_t(pixel.cell_y) * grid.lists.cells_x + pixel.cell_x];
  pixel.near_m = interval.near > -0.1 * far_away ? interval.near : -endless;
  pixel.far_m = interval.far < 0.1 * far_away ? interval.far : endless;
  if (pixel.slice > 0) pixel.near_m = std::max(pixel.near_m, double(grid.slice_edges[pixel.slice - 1]));
  if (pixel.slice < grid.lists.slices - 1)
    pixel.far_m = std::min(pixel.far_m, double(grid.slice_edges[pixel.slice]));
  for (const Light& light : frame.lights) pixel.directional += is_directional(light);
  return pixel;
}

// Indices into the frame's lights, by the index in lists.
std::vector<int> local_numbers(const CapturedFrame& frame) {
  std::vector<int> numbers;
  for (size_t i = 0; i < frame.lights.size(); ++i) {
    if (!is_directional(frame.lights[i])) numbers.push_back(int(i));
  }
  return numbers;
}

bool stands_in_cell(const HostGrid& lists, size_t cell, uint32_t light) {
  const size_t words = lists.masks.size() / lists.cells.size();
  if (words > 0) return lists.masks[cell * words + light / 32] >> light % 32 & 1;
  const uint32_t* first = lists.indices.data() + lists.cells[cell].x;
  return std::binary_search(first, first + lists.cells[cell].y, light);
}

// How far the light reaches into the z-bin's range of distances.
double z_bin_margin(const FrameGrid& grid, uint32_t bin, const LightBounds& light) {
  const auto& edges = grid.z_bin_edges;
  const double near = bin > 0 ? edges[bin - 1] : -endless, far = bin < edges.size() ? edges[bin] : endless;
  return light.radius_m + std::min(-light.position.z - near, far + light.position.z);
}

int count_lit(const ViewLight& light, const std::vector<glm::dvec3>& surfaces) {
  return int(
      std::count_if(surfaces.begin(), surfaces.end(), [&](const glm::dvec3& p) { return is_lit(light, p); }));
}

}  // namespace

int PixelInspection::listed() const {
  return int(std::count_if(lights.begin(), lights.end(), [](const LightVerdict& v) { return v.listed; }));
}

int PixelInspection::lit() const {
  return int(std::count_if(lights.begin(), lights.end(), [](const LightVerdict& v) { return v.lit; }));
}

int PixelInspection::lost() const {
  return int(
      std::count_if(lights.begin(), lights.end(), [](const LightVerdict& v) { return v.lit && !v.listed; }));
}

PixelInspection inspect_pixel(const CapturedFrame& frame, const FrameGrid& grid,
                              const std::vector<DepthInterval>& intervals, const Settings& settings,
                              PicturePixel place) {
  const int x = place.x, y = flipped_row(place.y, frame.view.height);
  PixelInspection pixel = place_of(frame, grid, intervals, x, y);
  const std::vector<glm::dvec3> surfaces = surfaces_of(frame, grid, pixel);
  pixel.covered_pixels = int(surfaces.size());
  const std::vector<ViewLight> lights = local_lights(frame);
  const std::vector<int> number = local_numbers(frame);
  const std::vector<uint32_t> near = lights_within_reach(lights, surfaces);
  const PixelCells cells = cells_of(frame, grid);
  const uint32_t at = cells.cell(x, y, pixel.slice), bin = cells.z_bin(x, y);
  const bool empty = !(pixel.near_m <= pixel.far_m);
  const Cell cell = cell_of_pixels(frame.view, pixel.x0 + cell_inset, pixel.y0 + cell_inset,
                                   pixel.x1 - cell_inset, pixel.y1 - cell_inset, pixel.near_m, pixel.far_m);
  const std::vector<DepthInterval> pieces = pieces_of(cell, surfaces, settings[setting::depth_bounds]);
  const glm::dvec3 here = pixel.covered ? position_from_depth(frame.view, x, y, pixel.depth) : glm::dvec3(0);
  for (uint32_t i = 0; i < lights.size(); ++i) {
    LightVerdict& v = pixel.lights.emplace_back();
    const LightBounds bounds = bounds_of(lights[i]);
    v.index = i;
    v.light = number[i];
    v.radius_m = lights[i].radius_m;
    v.listed = stands_in_cell(grid.lists, at, i);
    v.distance_m = pixel.covered ? glm::length(lights[i].position - here) : endless;
    v.lit = pixel.covered && is_lit(lights[i], here);
    if (v.lit && lights[i].reach) v.share = light_reaches(lights[i], here, full_mask);
    if (std::binary_search(near.begin(), near.end(), i)) v.lit_pixels = count_lit(lights[i], surfaces);
    if (empty) {
      v.test = "empty";
      v.margin_m = -endless;
      continue;
    }
    v.margins = margins_of(cell, bounds);
    if (!pieces.empty()) v.margins.pieces = pieces_margin(cell, pieces, bounds, settings);
    const NamedMargin decided = deciding(margins_in_use(v.margins, settings[setting::cull_test]), v.listed);
    v.test = decided.test;
    v.margin_m = decided.margin_m;
    v.touches = touches_cell(cell, bounds);
    if (v.listed && !grid.z_bin_edges.empty() && !bins_hold(grid.lists.z_bins[i], bin)) {
      v.listed = false;
      v.test = "z-bins";
      v.margin_m = z_bin_margin(grid, bin, bounds);
    }
  }
  std::stable_sort(pixel.lights.begin(), pixel.lights.end(),
                   [](const LightVerdict& a, const LightVerdict& b) {
                     if (a.listed != b.listed) return a.listed;
                     return !a.listed && nearness(a.margins) > nearness(b.margins);
                   });
  return pixel;
}

bool add_shadows(PixelInspection& pixel, const Scene& scene, const PixelShadows& shadows) {
  if (!shadows.receiver) return false;
  bool wrong = false;
  const auto verdict_of = [&](int light, uint32_t in_lists) {
    ShadowVerdict verdict;
    verdict.truth = shadows.occlusion.sight(scene.lights[size_t(light)], *shadows.receiver);
    if (verdict.truth.by.instance >= 0) verdict.by = scene.instances[size_t(verdict.truth.by.instance)].name;
    verdict.shaded_as_hidden = shadows.shaded && hidden_at(*shadows.shaded, pixel.x, pixel.y, in_lists);
    wrong |= verdict.leaked() || verdict.acned();
    return verdict;
  };
  for (LightVerdict& v : pixel.lights) {
    if (v.lit && scene.lights[size_t(v.light)].casts_shadow) v.shadow = verdict_of(v.light, v.index);
  }
  // In shadows, directional lights have the numbers after all others.
  auto number =
      uint32_t(std::ranges::count_if(scene.lights, [](const Light& l) { return !is_directional(l); }));
  for (int i = 0; i < int(scene.lights.size()); ++i) {
    const Light& light = scene.lights[size_t(i)];
    if (!is_directional(light)) continue;
    if (light.casts_shadow) pixel.directional_shadows.push_back({i, verdict_of(i, number)});
    ++number;
  }
  return wrong;
}

}  // namespace lightgrid::lab
