// KHR_lights_punctual (Khronos, 2018) and cameras, placed by their nodes.
#pragma once

#include "scene/gltf/nodes.h"
#include "scene/scene.h"

namespace lightgrid::gltf {

// One light for each node with one. A light points along its node's -z; the node's scale changes neither
// range nor cone. Lights without a node are not read. Errors name light and field: colour, intensity or range
// that is negative or not finite, their product past the largest float, a violation of 0 <= inner < outer <=
// pi/2.
std::vector<Light> read_lights(Document& doc, const std::vector<PlacedNode>& nodes);

// One camera for each node with one; the node's scale is dropped. A camera with a fault is left out: one
// warning names the first, its fault and the number of others.
std::vector<Camera> read_cameras(Document& doc, const std::vector<PlacedNode>& nodes);

}  // namespace lightgrid::gltf
