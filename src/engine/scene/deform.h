// Morph targets and skins on the CPU (float vertices, sums and matrices in double: glTF 2.0, 3.7.2.2
// and 3.7.3), and attributes that a mesh lacks and that can be computed from the others.
#pragma once

#include <optional>
#include <span>

#include "scene/rig.h"
#include "scene/scene.h"

namespace lightgrid {

// Adds each target's displacements times its weight to the attributes that `mesh` has: positions, normals,
// tangents (not their handedness), texture coordinates and colours. Normals and tangents are normalised,
// colours clamped to 0 to 1. Targets of weight 0 are ignored. `weights`: one a target, or none.
void apply_morph_targets(std::span<const MorphTarget> targets, std::span<const double> weights, Mesh& mesh);

// Moves positions, normals and tangents by the joints, into world space or, `mirrored`, into that of
// winding_matrix. Weights are divided by their sum; a vertex without weights is in world space as in the
// file. Joints that mirror keep normals on their side of the surface, and turn the tangents' handedness.
// `joints` contains all joints of `skin`.
void apply_skin(std::span<const glm::dmat4> joints, const SkinWeights& skin, bool mirrored, Mesh& mesh);

// The tangents that a mesh of this material needs.
TangentNeed tangent_need(const Material& material);

// Sets bounds, longest_edge and longest_sliver.
void measure(Mesh& mesh);

// Computes normals and tangents that are missing and needed, drops unused tangents, measures the mesh.
void complete_mesh(TangentNeed tangents, Mesh& mesh);

// Runs all three, from shape.base into `mesh`, whose name and material stay.
void deform(const DeformingMesh& shape, std::span<const double> weights, std::span<const glm::dmat4> joints,
            bool mirrored, Mesh& mesh);

// The first vertex whose position is not finite.
std::optional<size_t> first_not_finite(const Mesh& mesh);

// Gives each corner of each triangle its own vertex with the triangle's normal, as glTF requires for meshes
// without normals; drops tangents. A triangle without area gets +z.
void make_flat_normals(Mesh& mesh);

// Replaces normals of length 0 by those of the surrounding triangles, and normalises the others.
void repair_normals(Mesh& mesh);

// Tangents along u of `uv` (empty: any direction perpendicular to the normal), handedness in w. Per vertex,
// each triangle weighted by its area (Lengyel, "Computing Tangent Space Basis Vectors for an Arbitrary Mesh",
// 2001). Unlike MikkTSpace no vertex is split, so both sides of a mirrored seam with shared vertices share a
// tangent.
void make_tangents(Mesh& mesh, std::span<const glm::vec2> uv);

}  // namespace lightgrid
