// Morph targets and skins on the CPU: float vertices, sums and matrices in double (glTF 2.0, 3.7.2.2
// and 3.7.3).
#pragma once

#include <optional>
#include <span>

#include "scene/rig.h"

namespace lightgrid {

// Adds each target's displacements times its weight to the attributes that `mesh` has: positions, normals,
// tangents (not their handedness), texture coordinates and colours. Normals and tangents come out as unit
// vectors, colours within 0 to 1. Targets of weight 0 do nothing. `weights`: one a target, or none.
void apply_morph_targets(std::span<const MorphTarget> targets, std::span<const double> weights, Mesh& mesh);

// Moves positions, normals and tangents by the joints, into world space: a skinned mesh's own node does not
// matter. Weights are divided by their sum; a vertex without weights stays where the file has it. All joints
// of `skin` must be in `joints`.
void apply_skin(std::span<const glm::dmat4> joints, const SkinWeights& skin, Mesh& mesh);

// Makes normals and tangents where they are missing and needed, drops tangents nobody uses, sets bounds.
void complete_mesh(TangentNeed tangents, Mesh& mesh);

// All three, from shape.base into `mesh`, whose name and material stay.
void deform(const DeformingMesh& shape, std::span<const double> weights, std::span<const glm::dmat4> joints,
            Mesh& mesh);

// The first vertex whose position is not finite.
std::optional<size_t> first_not_finite(const Mesh& mesh);

}  // namespace lightgrid
