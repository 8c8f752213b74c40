// Skins of a file.
#pragma once

#include "scene/gltf/nodes.h"
#include "scene/rig.h"

namespace lightgrid::gltf {

// Joints as places in `nodes`, among which they must be, and their inverse bind matrices (identities where
// the file has none).
RigSkin read_skin(Document& doc, int skin, const std::vector<PlacedNode>& nodes);

// An error where a vertex is weighted by a joint that the skin does not have.
void check_joints(const Document& doc, const RigSkin& skin, const SkinWeights& weights,
                  const std::string& place);

}  // namespace lightgrid::gltf
