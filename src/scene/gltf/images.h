// Images to RGBA8: PNG and JPEG through stb_image, WebP (EXT_texture_webp) through libwebp.
#pragma once

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace lightgrid::gltf {

// The images of the file at these indices, in that order. The format is detected from the content; WebP is
// read only if the file uses EXT_texture_webp. Sizes are checked before decoding: each side against
// limits.max_image_side, the sum against limits.max_image_bytes. 16 bits become 8, with a warning.
std::vector<Bitmap> decode_images(Document& doc, const std::vector<int>& images);

}  // namespace lightgrid::gltf
