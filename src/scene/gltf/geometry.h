// What a mesh lacks and can be made from the rest of it.
#pragma once

#include <span>

#include "scene/scene.h"

namespace lightgrid::gltf {

// Gives each corner of each triangle a vertex of its own and the triangle's normal, as glTF asks where there
// are no normals; tangents are dropped. A triangle without area gets +z.
void make_flat_normals(Mesh& mesh);

// Replaces normals of no length by those of the triangles around, and brings the others to unit length.
void repair_normals(Mesh& mesh);

// Tangents along u of `uv` (empty: any direction across the normal), handedness in w. Per vertex, each
// triangle weighted by its area (Lengyel, "Computing Tangent Space Basis Vectors for an Arbitrary Mesh",
// 2001). Unlike MikkTSpace no vertex is split, so the two sides of a mirrored seam that share vertices share
// a tangent.
void make_tangents(Mesh& mesh, std::span<const glm::vec2> uv);

}  // namespace lightgrid::gltf
