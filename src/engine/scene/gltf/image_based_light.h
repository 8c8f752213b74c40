// Light from surroundings in glTF files.
#pragma once

#include <memory>

#include "scene/gltf/document.h"

namespace lightgrid {
struct Environment;  // scene/environment_light.h
}

namespace lightgrid::gltf {

// The light of EXT_lights_image_based that this scene of the file names; null: none. Its moments follow from
// irradianceCoefficients, its tables from the six faces of the first specular image. Faces that are missing
// or cannot be decoded: the radiance of the coefficients takes their place, with a warning. Errors: a light
// out of range, coefficients other than nine of three finite numbers, a rotation of length 0, an intensity
// that is negative or not finite.
std::shared_ptr<const Environment> read_image_based_light(Document& doc, int scene);

}  // namespace lightgrid::gltf
