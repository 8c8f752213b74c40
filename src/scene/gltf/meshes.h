// Converts primitives to meshes.
#pragma once

#include "scene/gltf/nodes.h"
#include "scene/rig.h"

namespace lightgrid::gltf {

// Adds to `scene` the meshes that the nodes use, at rest, one for each combination of skin and morph weights
// (a node with animated weights has its own), and an instance for each use. Adds to `rig` the skins, and the
// shapes of those meshes that animated joints or weights deform; no other mesh is stored twice. Materials
// must be read already: a mesh refers to the file's material index (the default one at the end).
void add_meshes(Document& doc, const std::vector<PlacedNode>& nodes, Scene& scene, Rig& rig);

}  // namespace lightgrid::gltf
