// The world grid (docs/techniques/world_grid.md).
#pragma once

#include "plan/settings.h"
#include "shared/cull_settings.h"

namespace lightgrid::setting {

inline const Setting<WorldGridShape> world_grid{
    530,
    "world-grid",
    "cells of world_grid: cubes of one size, columns over the ground, or cubes of sizes that suit each "
    "light, found by a hash",
    {{"3d", WorldGridShape::cubes}, {"2d", WorldGridShape::columns}, {"hashed", WorldGridShape::hashed}}};

inline const Setting<std::optional<double>> world_cell{
    540,
    "world-cell",
    "edge of world_grid's cells, relative to the lights' median radius (hashed: to each light's own radius); "
    "auto: chosen by the lights' number and radii",
    {{"auto", std::nullopt}, {"1", 1.0}, {"2", 2.0}, {"0.5", 0.5}, {"0.25", 0.25}}};

}  // namespace lightgrid::setting
