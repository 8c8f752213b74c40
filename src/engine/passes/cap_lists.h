// Light grids whose lists end at a number of lights, as engines have them (docs/capped_lists.md).
#pragma once

#include <vector>

#include "passes/common/frame.h"
#include "scene/view_lights.h"

namespace lightgrid {

// Shortens the lists of a grid of these bounds to the plan's list-cap, in place; nothing without one. Its
// memory stays as it is, but that sampled lists get factors.
void cap_lists(PassContext& work, Cached<class ListCaps>& cache, const CullParams& tiles,
               const TileBounds& bounds, ViewGrid& grid);

// The plan's light tree in place of culling: a grid of these bounds, whose lists are drawn from all lights.
ViewGrid lists_of_tree(PassContext& work, Cached<class ListCaps>& cache, const CullParams& tiles,
                       const TileBounds& bounds, SharedGridStorage& storage);

// cap_lists for a list of indices into `lights`, ascending before and after, of what has its middle here:
// view space, metres. brightest: by the intensity, all channels together, over the squared distance to there.
void cap_list(const Settings& settings, const std::vector<ViewLight>& lights, const glm::dvec3& middle,
              std::vector<uint32_t>& list);

}  // namespace lightgrid
