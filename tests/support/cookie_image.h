// Images that lights project, made in memory.
#pragma once

#include <functional>
#include <vector>

#include "base/image.h"
#include "scene/light_cookies.h"

namespace lightgrid {

// texel(x, y): red, green and blue; row 0 at the top.
inline SharedTable cookie_image(int width, int height, const std::function<glm::u8vec3(int, int)>& texel) {
  std::vector<uint8_t> bytes;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::u8vec3 t = texel(x, y);
      bytes.insert(bytes.end(), {t.r, t.g, t.b});
    }
  }
  return std::make_shared<const FileTable>(parse_cookie(encode_png(width, height, 3, bytes)));
}

// No two texels are alike.
inline SharedTable speckled_cookie(int width, int height) {
  return cookie_image(width, height, [](int x, int y) {
    return glm::u8vec3(40 + (x * 97 + y * 31) % 216, 30 + (x * 53 + y * 71) % 226, (x * 29 + y * 113) % 256);
  });
}

}  // namespace lightgrid
