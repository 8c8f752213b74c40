// The light table of a view (shared/light_table.h), as both APIs upload it.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "gl/bindings.h"
#include "plan/frame_plan.h"
#include "shared/light_table.h"

namespace lightgrid {

#define LIGHT_COLUMN_COUNT(...) +1
inline constexpr size_t light_column_count = 0 LIGHT_TABLE(LIGHT_COLUMN_COUNT);
#undef LIGHT_COLUMN_COUNT

// A column's values, one a light of plan.local.
struct LightColumn {
  bool needed = false;  // by the plan; no values if not
  Sampler sampler{};    // of its buffer texture
  GLenum format = 0;    // of a texel
  std::vector<std::byte> values;
};

struct LightTable {
  std::array<LightColumn, light_column_count> columns;  // in the order of LIGHT_TABLE
  // Beside the table, two a directional light: direction to the light in view space, and illuminance.
  std::vector<glm::vec4> directional;
};

LightTable light_table(const Scene& scene, const View& view, const FramePlan& plan);

// What light loops are compiled with so that they read the plan's columns and no others, and as its ranges
// have it (shared/punctual_light.h).
std::vector<const char*> light_table_defines(const FramePlan& plan);

}  // namespace lightgrid
