// Blended surfaces, over the image of opaque ones.
#pragma once

#include "passes/common/light_source.h"

namespace lightgrid {

class ObjectLights;

// Blends blended surfaces over the image, back to front.
void shade_blended(Work& work, const Seen& seen, const ShadedImage& image, const LightSource& lights);

// The same with lights by object, each object in one draw with all of its lights: a second draw would blend
// the surface over itself.
void shade_blended(Work& work, const Seen& seen, const ShadedImage& image, const ObjectLights& objects);

}  // namespace lightgrid
