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
    90, "depth-bounds", "the interval of distances that a cell spans",
    choices_of(depth_bounds_modes, &DepthBoundsRow::mode, DepthBoundsMode::minmax)};

inline const Setting<int> tile{100, "tile", "tile size in pixels", {"16", "8", "32", "64"}};

inline const Setting<int> slices{110,
                                 "slices",
                                 "depth slices per tile, of clustered; of visibility if it is given",
                                 {"24", "1", "2", "4", "8", "16", "32", "64"}};

inline const Setting<SliceSpacing> slice_spacing{
    120,
    "slice-spacing",
    "slices and z-bins that grow with distance, or of equal depth",
    {{"exponential", SliceSpacing::exponential}, {"linear", SliceSpacing::linear}}};

inline const Setting<int> z_bins{130,
                                 "z-bins",
                                 "ranges of distance by which shading skips lights of its tile's list",
                                 {{"off", 1}, {"16", 16}, {"64", 64}, {"256", 256}}};

inline const Setting<GridLists> grid_lists{
    140,
    "grid-lists",
    "contents of a cell of the light grid: light indices, or a bit for each light",
    {{"lists", GridLists::lists}, {"masks", GridLists::masks}}};

// 0: no limit.
inline const Setting<int> list_cap{150,
                                   "list-cap",
                                   "the most lights of a list, as engines have it: of a tile, of a cell of "
                                   "clustered, of an object in forward techniques. Further ones are left out",
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
    "the lights that a longer list keeps: the scene's first, the nearest to the eye or to the object's "
    "middle, those that add the most to the cell's or the object's middle; or lights drawn at random, from "
    "the list or a tree of all lights, which count so often that the expected picture is that of complete "
    "lists",
    {{"index", ListCapOrder::index},
     {"distance", ListCapOrder::distance},
     {"brightest", ListCapOrder::brightest},
     {"sampled", ListCapOrder::sampled},
     {"tree", ListCapOrder::tree}},
    {.shown = [](const Settings& s) { return s[list_cap] > 0; }}};

inline const Setting<uint32_t> list_seed{
    170,
    "list-seed",
    "of the lights drawn, with list-cap-order=sampled or tree",
    {"1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15", "16"},
    {.shown = samples_lists, .approximate = samples_lists, .random = samples_lists}};

// 0: no limit.
inline const Setting<int> view_cap{
    180,
    "view-cap",
    "the most lights of a view: those nearest to the eye of the lights whose range it sees",
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
    "point and spot lights that visibility adds up at a pixel: those of its tile's list, or every one",
    {{"grid", ShadedLights::grid}, {"all", ShadedLights::all}}};

}  // namespace lightgrid::setting

namespace lightgrid {

inline bool samples_lists(const Settings& s) {
  const ListCapOrder order = s[setting::list_cap_order];
  return s[setting::list_cap] > 0 && (order == ListCapOrder::sampled || order == ListCapOrder::tree);
}

}  // namespace lightgrid
