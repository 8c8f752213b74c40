// Primitives to meshes.
#pragma once

#include "scene/gltf/nodes.h"
#include "scene/rig.h"

namespace lightgrid::gltf {

// Adds to `scene` the meshes that the nodes use, at rest, each once for each skin and set of morph weights (a
// node whose weights are animated has its own), and an instance for each use. To `rig` it adds the skins, and
// the shapes of those meshes that animated joints or weights deform; no other mesh is kept twice. Materials
// must have been read: a mesh refers to the file's material index (the default one at the end).
void add_meshes(Document& doc, const std::vector<PlacedNode>& nodes, Scene& scene, Rig& rig);

}  // namespace lightgrid::gltf
