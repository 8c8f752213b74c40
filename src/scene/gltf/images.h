// Images to RGBA8: PNG and JPEG through stb_image, WebP (EXT_texture_webp) through libwebp.
#pragma once

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace lightgrid::gltf {

// The named images of the file, in that order. What they are is seen by their content; WebP is read only where the file uses
// EXT_texture_webp. Sizes are checked before anything is decoded: a side against
// limits.max_image_side, all of them together against limits.max_image_bytes. 16 bits become 8, with a
// warning.
std::vector<Bitmap> decode_images(Document& doc, const std::vector<int>& images);

}  // namespace lightgrid::gltf
