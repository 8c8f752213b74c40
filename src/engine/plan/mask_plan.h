// Masks of lights and surfaces (SurfaceMasks in scene/effect_terms.h): the surfaces' numbers, and where masks
// are tested besides light loops.
#pragma once

#include "plan/effect.h"
#include "plan/list_plan.h"

namespace lightgrid {

struct MaskNeeds {
  bool tiles = false;    // its tiles may store the masks of their surfaces
  bool stencil = false;  // light volumes may test masks in the stencil
  const char* of = "";   // in words: the lights whose masks are tested, if not all
};

struct MaskPlan {
  bool needed = false;           // an effect has masks. The same for every view
  std::vector<uint32_t> values;  // with it: all different masks of instances, by the number of a surface, and
  std::vector<uint32_t> of_instance;  // of each of the scene's instances its number
  bool tiles = false;                 // tiles of the light grid have the masks of their surfaces
  int stencil_bits = 0;               // that have masks; 0: shaders test them
};

// effects: of the frame. opengl: its surfaces' numbers have so many bits, and OpenCL's any.
MaskPlan plan_masks(const Scene& scene, std::span<const Effect* const> effects, const MaskNeeds& needs,
                    const Settings& settings, bool opengl, const ListPlan& lists);
// With all masks of the scene, needed or not.
void plan_every_mask(const Scene& scene, const MaskNeeds& needs, const Settings& settings, bool opengl,
                     const ListPlan& lists, MaskPlan& masks);

}  // namespace lightgrid
