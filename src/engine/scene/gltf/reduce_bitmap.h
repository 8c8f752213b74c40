// Images averaged down to a largest side.
#pragma once

#include "scene/scene.h"

namespace lightgrid::gltf {

struct BitmapSize {
  int width = 0, height = 0;
};

// Unchanged if no side is larger than `side`; else the larger one becomes `side`, and the other keeps the
// shape.
BitmapSize reduced_size(int width, int height, int side);

// The box filter: each pixel is the average of the area that it covers, colours (not alpha) in linear light.
Bitmap reduced(Bitmap bitmap, int side, bool colors);

}  // namespace lightgrid::gltf
