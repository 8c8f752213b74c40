// Animations of the nodes of one scene (glTF 2.0, section 3.11).
#pragma once

#include "scene/gltf/nodes.h"

namespace lightgrid::gltf {

// All animations of the file, each with the channels that move a node of `nodes`; AnimationChannel::node is a
// place in `nodes`, whose `moves` and `morphs` it sets. Channels without a node, and of nodes that are not in
// the scene, are left out, as are (with a warning) paths other than glTF 2.0's own and weights of a node
// without morph targets. Errors: two channels of one animation that have the same target, translation,
// rotation or scale of a node that has a matrix, a sampler that is absent, times that are not float scalars,
// negative or decreasing, values of another type or number than the target's, an unknown interpolation, a
// cubic spline of one key, a rotation of length 0, more values than limits.max_animation_values.
std::vector<Animation> read_animations(Document& doc, std::vector<PlacedNode>& nodes);

}  // namespace lightgrid::gltf
