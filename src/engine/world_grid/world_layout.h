// A world grid before its lists: where its cells lie, and the lights as the kernels read them. Host code
// alone, in double.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/world_box.h"
#include "culling/light_culler.h"
#include "shared/cull_settings.h"
#include "shared/world_grid.h"

namespace lightgrid {

// The views that lists are right for: how far rounding may move a position that shading computes
// (docs/details/world_grid.md#slack). Larger values make longer lists.
struct WorldReach {
  double distance_m =
      0;  // from the grid's middle to the eye and, in orthographic views, from the eye to the scene
  double spread = 1;  // at least 1: steep slopes at the image's sides
  bool holds(const WorldReach& other) const {
    return other.distance_m <= distance_m && other.spread <= spread;
  }
};

// A view's part in the lists.
struct WorldEye {
  glm::dvec3 position{0};  // world, metres
  double seen_m =
      0;  // how far what is seen may be from it, in orthographic views; 0: in proportion to its depth
  double spread = 1;  // as in WorldReach
};

WorldReach reach_of(const WorldEye& eye, const glm::dvec3& middle);
WorldReach larger(const WorldReach& a, const WorldReach& b);  // holds both

// The blocks of a 2d or 3d grid around a light's ball.
struct WorldBlocks {
  uint32_t first = 0;            // the number of the first one
  uint16_t x = 0, y = 0, z = 0;  // how many along each axis; 0: none
};

struct WorldLayout {
  WorldGridParams params{};  // but everywhere_first, which depends on the lists
  glm::dvec3 middle{0};      // world, metres
  double cell = 1;           // the setting world-cell, or what choose_world_cell chose
  double cell_m = 1;         // edge of the smallest cells
  WorldReach reach;
  int bucket_bits = 0;  // a sort key's, whether hashed or not
  bool columns = false;

  // Position and radius with slack, in cells from the middle; radius -1: in no cell. The radius is an odd
  // float if the light has a cone that is tested, else an even one.
  std::vector<glm::vec4> lights;
  // For lights whose cone is tested: axis, and a cosine no larger than the outer half-angle's. Empty: no
  // light has a cone.
  std::vector<glm::vec4> cones;
  std::vector<WorldBlocks> light_blocks;  // one per light; empty: hashed
  std::vector<uint32_t> levels;           // one per light; empty: 0
  std::vector<uint32_t> first_pairs;      // one per light, among all pairs of a block and a light
  uint64_t pairs = 0;                     // may exceed 32 bits: first_pairs is then of no use
  std::vector<uint32_t> everywhere;       // lights of every list, ascending
};

// Replaces `layout`, whose arrays keep their memory. world_cell: the setting; none: auto
// (choose_world_cell). bounds: of the surfaces; cells cover where these and the lights are. eye: of the view
// that is drawn; the layout's reach is larger, so that a moving camera rarely leaves it. at_least: a reach
// that other views need.
void lay_out_world(std::span<const CullLight> lights, const WorldBox& bounds, WorldGridShape shape,
                   std::optional<double> world_cell, const WorldEye& eye, WorldLayout& layout,
                   const WorldReach& at_least = {});

// The rows of a view, whose axes in the world are the columns of world_from_view.
WorldViewParams world_view_params(const WorldLayout& layout, const glm::dvec3& eye,
                                  const glm::dmat3& world_from_view);

// One light of a layout.
struct WorldLight {
  glm::vec4 ball{0};            // as WorldLayout::lights
  glm::vec4 cone{0, 0, 0, -1};  // as WorldLayout::cones
  uint32_t level = 0;
  bool everywhere = false;  // it belongs to every list, and to no block
  uint64_t blocks = 0;      // number of those that it meets
  WorldBlocks of_cells;     // these, unless hashed
};

// cones: whether the layout has any. Depends on nothing else than the light, and on what lay_out_world has
// laid out.
WorldLight world_light(const CullLight& light, const WorldLayout& layout, bool cones);

// Replaces the layout's arrays. All else of it is there.
void add_world_lights(std::span<const CullLight> lights, WorldLayout& layout);

}  // namespace lightgrid
