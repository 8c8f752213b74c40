// Forward shading from light lists of clusters: tiles cut into depth slices. One grid serves opaque and blended surfaces
// where there are no depth bounds (docs/techniques/clustered.md).
#include "techniques/technique.h"

namespace lightgrid {

extern const Technique clustered{"clustered", "light lists of tiles cut into depth slices",
                                 "Olsson, Billeter, Assarsson: Clustered Shading, HPG 2012",
                                 {.light_grid = true, .slices = true}, shade_from_light_grid};

}  // namespace lightgrid
