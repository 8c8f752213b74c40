// Skins of a file.
#pragma once

#include "scene/gltf/nodes.h"
#include "scene/rig.h"

namespace lightgrid::gltf {

// Joints as indices into `nodes`, which must contain them, and their inverse bind matrices (identities if the
// file has none).
RigSkin read_skin(Document& doc, int skin, const std::vector<PlacedNode>& nodes);

// Throws an error if a vertex has a weight for a joint that the skin does not have.
void check_joints(const Document& doc, const RigSkin& skin, const SkinWeights& weights,
                  const std::string& place);

}  // namespace lightgrid::gltf
