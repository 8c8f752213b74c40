// Animations of the nodes of one scene (glTF 2.0, section 3.11).
#pragma once

#include "scene/gltf/nodes.h"

namespace lightgrid::gltf {

// All animations of the file, each with the channels that move a node of `nodes`. AnimationChannel::node is
// an index into `nodes`; the function sets their `moves` and `morphs`. Channels without a node, and of nodes
// outside the scene, are omitted; so are (with a warning) paths not in glTF 2.0 and weights of a node without
// morph targets. An animation with a fault has no channels: one warning names the first, its fault and the
// number of others. Faults: broken JSON or indices; two channels of one animation with the same target;
// translation, rotation or scale of a node with a matrix; a missing sampler; times that are not float
// scalars, negative or decreasing; values of another type or number than the target's; an unknown
// interpolation; a cubic spline of one key; a rotation of length 0; more values than
// limits.max_animation_values.
std::vector<Animation> read_animations(Document& doc, std::vector<PlacedNode>& nodes);

}  // namespace lightgrid::gltf
