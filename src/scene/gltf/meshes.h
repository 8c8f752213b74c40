// Primitives to meshes.
#pragma once

#include "scene/gltf/nodes.h"
#include "scene/scene.h"

namespace lightgrid::gltf {

// Adds to `scene` the meshes that the nodes use, each once for each skin and set of morph weights, and an instance for
// each use. Materials must have been read: a mesh refers to the file's material index (the default one at the end).
void add_meshes(Document& doc, const std::vector<PlacedNode>& nodes, Scene& scene);

}  // namespace lightgrid::gltf
