// The needs of a frame for its lights: parts of plan_frame, in its order.
#pragma once

#include <string>

#include "plan/frame_plan.h"

namespace lightgrid {

std::string light_witness(const Scene& scene, int light);  // for a decision's reason

// Throws Error(input) for caps that do not go with the technique's lists or with other settings.
void check_capped_lists(const TechniqueNeeds& needs, const Settings& settings);

// Lights by kind, those that view-cap leaves out, and the size of indices.
void plan_lights(const Scene& scene, const View& view, FramePlan& plan);
void plan_sampled_lists(FramePlan& plan);  // after the light grid

// After the light grid.
void plan_groups(const Scene& scene, const TechniqueNeeds& needs, FramePlan& plan);
void number_groups(const Scene& scene, FramePlan& plan);  // whether or not a light or instance lacks one
// OpenGL's surfaces have numbers of masks, of so many bits, and OpenCL's any mask.
void plan_group_tiles(const TechniqueNeeds& needs, FramePlan& plan);

}  // namespace lightgrid
