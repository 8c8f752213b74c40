// The lists of lights that a frame reads.
#pragma once

#include "plan/light_plan.h"
#include "plan/surface_plan.h"

namespace lightgrid {

struct ListNeeds {
  bool light_grid = false;
  bool slices = false;       // tiles are cut into depth slices
  bool z_bins = false;       // shading skips lights by z-bins, if the setting z-bins says so
  bool no_masks = false;     // light code reads only lists, not masks
  bool world_grid = false;   // light lists in cells of the world
  bool capped = false;       // its lists and its view may end at a number of lights
  bool light_block = false;  // shaders read lights from a uniform block, not from buffer textures
  bool sampled = false;      // of these lists, each light may count several times
  // Why the plan has none of them, if it is not the view.
  const char* no_light_grid = "the technique reads none";
  const char* no_slices = "the technique uses none";
};

struct ListPlan {
  bool light_grid = false;       // culling kernels and the grid's buffers
  bool light_tree = false;       // samples from a tree of all lights, in place of culling
  bool sampled = false;          // longer lists than list-cap become samples
  bool blend_grid = false;       // a light grid for blended surfaces
  bool world_grid = false;       // lists in cells of the world
  int z_bins = 1;                // 1: off
  int slices = 1;                // cells per tile, ...
  double near_m = 0, far_m = 0;  // ... between these distances
};

// Throws Error(input) for caps that do not go with these lists or with other settings.
void check_lists(const ListNeeds& needs, const Settings& settings);

ListPlan plan_lists(const Scene& scene, const View& view, const ListNeeds& needs, const Settings& settings,
                    const SurfacePlan& surfaces, const LightPlan& lights, Decisions& decisions);
void plan_every_list(const ListNeeds& needs, ListPlan& lists);

}  // namespace lightgrid
