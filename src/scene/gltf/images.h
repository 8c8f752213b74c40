// PNG and JPEG images to RGBA8, through stb_image.
#pragma once

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace lightgrid::gltf {

// The named images of the file, in that order. Sizes are checked before anything is decoded: a side against
// limits.max_image_side, all of them together against limits.max_image_bytes. 16 bits become 8, with a
// warning.
std::vector<Bitmap> decode_images(Document& doc, const std::vector<int>& images);

}  // namespace lightgrid::gltf
