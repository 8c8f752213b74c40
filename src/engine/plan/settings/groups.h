// Light groups (docs/light_groups.md).
#pragma once

#include "plan/settings.h"

namespace lightgrid::setting {

inline const Setting<int> group_bits{
    210, "group-ids", "bits per pixel for the light-group number in the geometry buffer", {"8", "16"}};

inline const Setting<int> group_stencil{
    220,
    "group-stencil",
    "bits of the stencil that have the light groups of a pixel in place of that number",
    {{"off", 0}, {"4", 4}, {"6", 6}, {"8", 8}}};

inline const Setting<bool> group_tiles{230,
                                       "group-tiles",
                                       "tiles list only lights of groups that a surface in them has",
                                       {{"on", true}, {"off", false}}};

}  // namespace lightgrid::setting
