// The images of a file, decoded.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace lightgrid::gltf {

struct ImageUse {
  int image = 0;        // image number in the file
  bool colors = false;  // stored with the sRGB curve
};

struct DecodedImage {
  Bitmap bitmap;  // without a name
  std::string name;
  std::optional<Error> fault;  // the bitmap is empty then
};

struct ImageSet {
  std::vector<DecodedImage> images;
  std::vector<size_t> bitmap_of_use;  // into `images`
};

// The images that are used, each once; those with the same bytes share one. The format is detected from the
// content; WebP is read only if the file uses EXT_texture_webp. Images larger than limits.texture_side are
// averaged down. Before anything is decoded, sizes are checked: each side against limits.max_image_side,
// which is a fault of the image, the sum against limits.max_image_bytes, which is an error. 16 bits become 8,
// with a warning.
ImageSet fetch_images(Document& doc, const std::vector<ImageUse>& uses);

// A PNG or JPEG file that no glTF file names. Throws Error(input) that says what is wrong.
Bitmap decoded_image(std::span<const uint8_t> bytes, int max_side);

}  // namespace lightgrid::gltf
