// Images that lights project, made in memory.
#pragma once

#include <functional>
#include <vector>

#include "base/image.h"
#include "scene/light_cookies.h"

namespace lightgrid {

// texel(x, y): red, green and blue; row 0 at the top.
inline std::vector<uint8_t> cookie_png(int width, int height,
                                       const std::function<glm::u8vec3(int, int)>& texel) {
  std::vector<uint8_t> bytes;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::u8vec3 t = texel(x, y);
      bytes.insert(bytes.end(), {t.r, t.g, t.b});
    }
  }
  return encode_png(width, height, 3, bytes);
}

inline SharedTable cookie_image(int width, int height, const std::function<glm::u8vec3(int, int)>& texel) {
  return std::make_shared<const FileTable>(parse_cookie(cookie_png(width, height, texel)));
}

// No two texels are alike.
inline glm::u8vec3 speckle(int x, int y) {
  return {40 + (x * 97 + y * 31) % 216, 30 + (x * 53 + y * 71) % 226, (x * 29 + y * 113) % 256};
}
inline SharedTable speckled_cookie(int width, int height) { return cookie_image(width, height, speckle); }

}  // namespace lightgrid
