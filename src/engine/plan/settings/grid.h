// Light grids, and the lists that a limit shortens.
#pragma once

#include "plan/settings.h"
#include "shared/cull_settings.h"

namespace lightgrid {

// Which lights a list keeps that is longer than list-cap (docs/capped_lists.md).
// sampled: at random, and each light counts so often that the expected sum is the longer list's
// (docs/sampled_lists.md). tree: the same of all lights, from a tree.
enum class ListCapOrder { index, distance, brightest, sampled, tree };

// Which lights the resolve passes add up.
enum class ShadedLights { grid, all };

inline bool samples_lists(const Settings& s);

}  // namespace lightgrid

namespace lightgrid::setting {

inline const Setting<DepthBoundsMode> depth_bounds{
    90,
    "depth-bounds",
    "the distances that a tile spans: one interval, everything, two halves, two fitted halves, or 32 slots",
    choices_of(depth_bounds_modes, &DepthBoundsRow::mode, DepthBoundsMode::minmax),
    {.of_tiles = true}};

inline const Setting<int> tile{
    100, "tile", "tile size in pixels", {"16", "8", "32", "64"}, {.of_tiles = true}};

inline const Setting<int> slices{110,
                                 "slices",
                                 "depth slices per tile, in clustered, and in visibility if given",
                                 {"24", "1", "2", "4", "8", "16", "32", "64"}};

inline const Setting<SliceSpacing> slice_spacing{
    120,
    "slice-spacing",
    "slices and z-bins that grow with distance, or have equal depth",
    {{"exponential", SliceSpacing::exponential}, {"linear", SliceSpacing::linear}}};

inline const Setting<int> z_bins{
    130,
    "z-bins",
    "ranges of distance; shading skips lights of a pixel's list that do not reach its range",
    {{"off", 1}, {"16", 16}, {"64", 64}, {"256", 256}}};

inline const Setting<GridLists> grid_lists{
    140,
    "grid-lists",
    "a cell of the light grid has a list of light indices, or one bit per light",
    {{"lists", GridLists::lists}, {"masks", GridLists::masks}}};

// 0: no limit.
inline const Setting<int> list_cap{
    150,
    "list-cap",
    "maximum number of lights in the list of a tile, of a cell (clustered) or of an object (forward "
    "techniques), as in engines; further lights are left out",
    {{"off", 0},
     {"1", 1},
     {"2", 2},
     {"4", 4},
     {"8", 8},
     {"16", 16},
     {"32", 32},
     {"64", 64},
     {"128", 128},
     {"256", 256}}};

inline const Setting<ListCapOrder> list_cap_order{
    160,
    "list-cap-order",
    "the lights that a longer list keeps: the scene's first; the nearest to the eye or to the object's "
    "centre; those that add the most at the centre of the cell or object; or lights drawn at random from the "
    "list or from a tree of all lights, weighted so that the expected picture is that of complete lists",
    {{"index", ListCapOrder::index},
     {"distance", ListCapOrder::distance},
     {"brightest", ListCapOrder::brightest},
     {"sampled", ListCapOrder::sampled},
     {"tree", ListCapOrder::tree}},
    {.shown = [](const Settings& s) { return s[list_cap] > 0; }}};

inline const Setting<uint32_t> list_seed{
    170,
    "list-seed",
    "with list-cap-order=sampled or tree: seed of the drawn lights",
    {"1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15", "16"},
    {.shown = samples_lists, .approximate = samples_lists, .random = samples_lists}};

// 0: no limit.
inline const Setting<int> view_cap{
    180,
    "view-cap",
    "maximum number of lights in a view: the nearest to the eye whose range is in view",
    {{"off", 0},
     {"1", 1},
     {"8", 8},
     {"16", 16},
     {"32", 32},
     {"64", 64},
     {"128", 128},
     {"256", 256},
     {"512", 512},
     {"1024", 1024}}};

inline const Setting<ShadedLights> lights{
    470,
    "lights",
    "the point and spot lights that visibility evaluates at a pixel: those in its tile's list, or all",
    {{"grid", ShadedLights::grid}, {"all", ShadedLights::all}}};

}  // namespace lightgrid::setting

namespace lightgrid {

inline bool samples_lists(const Settings& s) {
  const ListCapOrder order = s[setting::list_cap_order];
  return s[setting::list_cap] > 0 && (order == ListCapOrder::sampled || order == ListCapOrder::tree);
}

}  // namespace lightgrid
