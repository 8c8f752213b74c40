// Attributes that a mesh lacks and that can be computed from the others.
#pragma once

#include <span>

#include "scene/scene.h"

namespace lightgrid::gltf {

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

}  // namespace lightgrid::gltf
