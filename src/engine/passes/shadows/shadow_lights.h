// The lights and the view of a frame as the kernels of shadows read them (shared/shadow_records.h).
#pragma once

#include <utility>
#include <vector>

#include "culling/light_culler.h"
#include "renderer/pass_context.h"
#include "shared/shadow_records.h"

namespace lightgrid {

// In the order of ShadowPlan::shadowed: point and spot lights, then directional ones.
size_t shadow_light_count(const FramePlan& plan);
size_t shadow_table_words(const FramePlan& plan);  // pairs of words a tile (shared/shadow_bits.h)
size_t shadow_entry_bytes(const FramePlan& plan);  // bytes per pair of a tile and a light

// In this order, as shining: directional ones everywhere.
std::vector<CullLight> shining_lights(const ViewState& seen);
// Lights without shadows are listed nowhere, directional ones in every tile that shows a surface.
std::vector<CullLight> shadowed_lights(const ViewState& seen, std::vector<CullLight> shining);

// origin: of the rays. Without stamps. Lights without shadows reach nothing.
std::vector<ShadowLight> shadow_light_records(const ViewState& seen, const std::vector<CullLight>& shadowed,
                                              const glm::dvec3& origin);
// Returns whether the same geometry hides both from the same points. Only shadow-pick reads more of a record.
bool have_same_shadows(const ShadowLight& a, const ShadowLight& b);
ShadowView shadow_view(const ViewState& seen, const glm::dvec3& origin);

// All that shadows follow from and that may change: of a scene's other parts nothing does.
struct ShadowInputs {
  View view;
  std::vector<Light> lights;
  std::vector<CullLight> shining;  // with their ranges
  std::vector<uint8_t> shadowed;
  std::vector<std::pair<glm::dmat4, int>> instances;  // and the versions of their meshes
  int builds;                                         // number of builds of the tree
  bool operator==(const ShadowInputs&) const = default;
};
ShadowInputs shadow_inputs(PassContext& work, const RayScene& rays);

}  // namespace lightgrid
