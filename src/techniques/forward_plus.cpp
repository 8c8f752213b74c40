// Forward shading from per-tile light lists, culled in OpenCL against the depth bounds of each tile.
#include "techniques/technique.h"

namespace lightgrid {

extern const Technique forward_plus{"forward_plus", "per-tile light lists",
                                    "Harada, McKee, Yang: Forward+, Eurographics 2012", {.light_grid = true},
                                    shade_from_light_grid};

}  // namespace lightgrid
