// Lights as the kernels read them: kernels/common/light_arrays.h.
#pragma once

#include <span>
#include <vector>

#include "culling/light_culler.h"

namespace lightgrid {

constexpr int world_arrays = 8;
constexpr float far_away = 1e18f;  // as kernels/common/project.h
constexpr double half_ulp = 0x1p-24;

// A place from which float keeps the lights' own as well as it can.
glm::dvec3 middle_of(std::span<const CullLight> lights);

// world_arrays arrays of `stride` floats, relative to `origin`; those past the last light are listed nowhere.
std::vector<float> light_arrays(std::span<const CullLight> lights, const glm::dvec3& origin, size_t stride);

}  // namespace lightgrid
