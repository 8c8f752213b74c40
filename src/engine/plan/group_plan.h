// The light groups of a frame (scene/light_groups.h).
#pragma once

#include "plan/list_plan.h"

namespace lightgrid {

struct GroupNeeds {
  bool tiles = false;    // its tiles may have the light groups of their surfaces
  bool stencil = false;  // that of light volumes may test them in the stencil
  const char* of = "";   // which lights' groups light loops ask for, if not all lights'
};

struct GroupPlan {
  // Some light or instance of the scene lacks a group: light loops ask whether groups meet. The same for
  // every view.
  bool needed = false;
  std::vector<uint32_t> masks;        // with them: all different masks of instances, and
  std::vector<uint32_t> of_instance;  // of each of the scene's instances the index of its own
  bool tiles = false;                 // tiles of the light grid have the groups of their surfaces
  int stencil_bits = 0;               // that have groups; 0: shaders test them
};

// opengl: its surfaces have numbers of masks, of so many bits, and OpenCL's any mask.
GroupPlan plan_groups(const Scene& scene, const GroupNeeds& needs, const Settings& settings, bool opengl,
                      const ListPlan& lists, Decisions& decisions);
// Whether or not a light or instance lacks one.
void plan_every_group(const Scene& scene, const GroupNeeds& needs, const Settings& settings, bool opengl,
                      const ListPlan& lists, GroupPlan& groups);

}  // namespace lightgrid
