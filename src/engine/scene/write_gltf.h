// A Scene as glTF 2.0 (Khronos, 2021), for other renderers.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace lightgrid {

// A binary glTF file that load_gltf reads back to a scene with the same pictures: meshes and instances as
// they stand now (nothing of the rig), every light as KHR_lights_punctual, cameras, materials with their
// extensions and textures as PNG. What glTF has no place for is in `extras`, as load_gltf reads it
// (docs/gltf.md): ambient, background and samples of the scene, shadows and groups of lights and instances.
// One node for each instance, light and camera, in this order, with its matrix in double. Throws Error(input)
// for a scene with virtual lights, which glTF cannot hold, and where the buffer would take 4 GiB or more.
// Deterministic.
std::vector<uint8_t> glb_of(const Scene& scene);

}  // namespace lightgrid
