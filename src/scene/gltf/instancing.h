// EXT_mesh_gpu_instancing: copies of a node's mesh, each with a place of its own.
#pragma once

#include <optional>

#include "scene/gltf/document.h"
#include "scene/rig.h"

namespace lightgrid::gltf {

// Each copy's place relative to the node, by the node's index in the file; empty if the node is not
// instanced. Errors: no attributes, attributes of unequal count or of a type that the extension does not
// have, more than limits.max_instances, a rotation of length 0, a skin.
std::optional<std::vector<NodeTransform>> read_instances(Document& doc, int node);

}  // namespace lightgrid::gltf
