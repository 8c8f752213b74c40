// Masks of lights and surfaces (plan/mask_plan.h). The keys are those of light groups (docs/light_groups.md),
// which first had masks.
#pragma once

#include "plan/settings.h"

namespace lightgrid::setting {

inline constexpr const char number_bits_key[] = "group-ids", stencil_masks_key[] = "group-stencil",
                            tile_masks_key[] = "group-tiles";

inline const Setting<int> number_bits{
    210, number_bits_key, "bits per pixel for the light-group number in the geometry buffer", {"8", "16"}};

inline const Setting<int> stencil_masks{220,
                                        stencil_masks_key,
                                        "stencil bits for a pixel's light groups instead of that number",
                                        {{"off", 0}, {"4", 4}, {"6", 6}, {"8", 8}}};

inline const Setting<bool> tile_masks{230,
                                      tile_masks_key,
                                      "tiles list only lights that share a group with one of their surfaces",
                                      {{"on", true}, {"off", false}}};

}  // namespace lightgrid::setting
