// Every place that computes with a light's brightness, and the factors of a light that it takes into account.
// A factor is a column of LIGHT_TABLE, or what light_reaches answers besides: masks of lights and surfaces,
// shadows, and the effects that answer NAME_reach. Code outside of light loops reads the effects'
// largest_intensity (scene/view_lights.h). A new column is a new member here, without which this does not
// compile; Adding.EveryReaderOfLights… finds a reader that is not listed, and one that does not name a factor
// that it claims to read.
#pragma once

#include <algorithm>

#include "shared/light_table.h"

namespace lightgrid {

// The value of a factor that is read; other factors have a line that gives the reason.
inline constexpr const char* reads = "";

struct LightReader {
  const char* name;
  const char* files;  // split at spaces
#define LIGHT_FACTOR(condition, type, member, array, texels) const char* member = nullptr;
  LIGHT_TABLE(LIGHT_FACTOR)
#undef LIGHT_FACTOR
  const char* masks = nullptr;
  const char* shadows = nullptr;
  const char* effects = nullptr;
};

inline constexpr const char* only_order =
    "it changes which lights come first or are drawn, not what they add";
inline constexpr const char* upper_bound = "without it the bound is larger, and still a bound";

// Effects list their readers themselves (plan/effect.h).
inline constexpr LightReader light_readers[] = {
    {.name = "light loops",
     .files = "src/engine/shared/punctual_light.h shaders/deferred_light.frag shaders/light_buffer.frag "
              "kernels/resolve/shade_pixels.h kernels/resolve/outputs/reflected.h",
     .position = reads,
     .color = reads,
     .cone = reads,
     .max_falloff = reads,
     .masks = reads,
     .shadows = reads,
     .effects = reads},
    {.name = "oracle",
     .files = "src/laboratory/oracle/shading.cpp",
     .position = reads,
     .color = reads,
     .cone = reads,
     .max_falloff = reads,
     .masks = reads,
     .shadows = "SeenPairs decides them for each pair, and ShadeSettings::hidden leaves lights out",
     .effects = reads},
    {.name = "voxel volumes",
     .files = "src/engine/passes/voxels/voxel_inputs.cpp kernels/voxels/voxel_light.h "
              "kernels/voxels/gpu/build_voxels.cl "
              "src/engine/shared/voxel_exact.h",
     .position = reads,
     .color = reads,
     .cone = reads,
     .max_falloff = reads,
     .masks = "a sample belongs to no surface; MaskNeeds::of says so",
     .shadows = "a sample belongs to no surface; exact lights have them",
     .effects = reads},
    {.name = "choice of voxel_lights' exact lights",
     .files = "kernels/resolve/resolve_light.h shaders/lights/voxels.glsl",
     .position = reads,
     .color = reads,
     .cone = reads,
     .max_falloff = reads,
     .masks = only_order,
     .shadows = only_order,
     .effects = only_order},
    {.name = "list orders",
     .files = "src/engine/passes/cap_lists.cpp",
     .position = reads,
     .color = reads,
     .cone = only_order,
     .max_falloff = only_order,
     .masks = only_order,
     .shadows = only_order,
     .effects = reads},
    {.name = "sampled lists",
     .files = "kernels/culling/sampled_list.h",
     .position = reads,
     .color = reads,
     .cone = reads,
     .max_falloff = reads,
     .masks = "weights may be any that are above 0: the sum's mean is right",
     .shadows = "weights may be any that are above 0: the sum's mean is right",
     .effects = "weights may be any that are above 0: the sum's mean is right"},
    {.name = "light tree",
     .files = "src/engine/scene/light_tree.cpp kernels/culling/sampled_tree.h",
     .position = reads,
     .color = reads,
     .cone = "weights may be any that are above 0: the sum's mean is right",
     .max_falloff = "weights may be any that are above 0: the sum's mean is right",
     .masks = "weights may be any that are above 0: the sum's mean is right",
     .shadows = "weights may be any that are above 0: the sum's mean is right",
     .effects = reads},
    {.name = "shadow-pick",
     .files = "src/engine/passes/shadows/shadow_lights.cpp kernels/shadows/picked_shadows.h",
     .position = reads,
     .color = reads,
     .cone = reads,
     .max_falloff = "an estimate of shares: virtual lights weigh as spots",
     .masks = reads,
     .shadows = "it finds them",
     .effects = reads},
    {.name = "orders of lidr",
     .files = "src/engine/passes/light_index/draw_order.cpp src/engine/plan/shadow_plan.cpp",
     .position = reads,
     .color = reads,
     .cone = only_order,
     .max_falloff = only_order,
     .masks = only_order,
     .shadows = only_order,
     .effects = reads},
    {.name = "plan of shadows",
     .files = "src/engine/plan/dim_lights.cpp",
     .position = reads,
     .color = reads,
     .cone = reads,
     .max_falloff = upper_bound,
     .masks = upper_bound,
     .shadows = "it plans them",
     .effects = upper_bound},
    {.name = "scale of light_prepass",
     .files = "src/engine/passes/common/light_buffer.cpp",
     .position = reads,
     .color = reads,
     .cone = upper_bound,
     .max_falloff = upper_bound,
     .masks = upper_bound,
     .shadows = upper_bound,
     .effects = upper_bound},
    {.name = "importance (--shadows N, virtual lights)",
     .files = "src/engine/scene/shadow_casters.cpp src/engine/scene/virtual_lights.cpp",
     .position = reads,
     .color = reads,
     .cone = reads,
     .max_falloff = only_order,
     .masks = only_order,
     .shadows = only_order,
     .effects = only_order},
    {.name = "ranges from intensities",
     .files = "src/engine/scene/light_ranges.cpp",
     .position = reads,
     .color = reads,
     .cone = upper_bound,
     .max_falloff = reads,
     .masks = upper_bound,
     .shadows = upper_bound,
     .effects = upper_bound},
    {.name = "check",
     .files = "src/laboratory/check/light_limits.cpp",
     .position = reads,
     .color = reads,
     .cone = reads,
     .max_falloff = "glTF and engines have no virtual lights",
     .masks = reads,
     .shadows = "engines limit lights before they find shadows",
     .effects = "engines limit lights, whatever each lets through"},
};

constexpr bool says_all(const LightReader& reader) {
  bool all = reader.masks && reader.shadows && reader.effects;
#define LIGHT_FACTOR(condition, type, member, array, texels) all = all && reader.member;
  LIGHT_TABLE(LIGHT_FACTOR)
#undef LIGHT_FACTOR
  return all;
}
static_assert(std::ranges::all_of(light_readers, says_all));

}  // namespace lightgrid
