// Cookies: images that lights project (docs/profiles.md#cookies).
#pragma once

#include <span>

#include "scene/camera.h"
#include "scene/light_axes.h"

namespace lightgrid {

// The property "cookie" of point and spot lights: the path of a PNG or JPEG file, in sRGB. Its table is
// FileTable::shape: width, height, and the texels of all mip levels in linear light, each a word of three
// mantissas of 9 bits, red first, and a common exponent (RGB9E5); row 0 at the top. Before the texels, the
// place of each level counted from the first word after the size.
extern const Property<SharedTable> light_cookie;

// Throws Error(input) if it is no image, or larger than max_cookie_side.
FileTable parse_cookie(const std::vector<uint8_t>& bytes);
inline constexpr int max_cookie_side = 4096;

struct Cookie {
  uint32_t width = 0, height = 0;
  uint32_t levels = 0;              // down to one texel
  std::span<const uint32_t> words;  // places of the levels, then texels
};
Cookie cookie_of(const FileTable& table);

// Null: the light has none. Directional lights have none.
SharedTable cookie_of(const Light& light);

// How an image lies around a light. p: from the light, along right, up and direction.
//   spots below max_projector_rad: u = 1/2 + right.p / (direction.p tan(outer) 2), v downwards likewise: the
//     cone's circle touches the image's sides. Behind the light: nothing
//   other lights: v = angle from `up` / pi, u = 1/2 + azimuth / (2 pi) from `direction` towards `right`
inline constexpr double max_projector_rad = 1.5;
bool is_projector(const Light& light);

// The light that passes in direction p, averaged over footprint_m across it, in double: trilinear.
glm::dvec3 cookie_share(const Cookie& cookie, const Light& light, const glm::dvec3& p, double footprint_m);

// The width of a pixel at a point in view space, across the line to the eye: per metre of depth, or of an
// orthographic view everywhere (then negative).
double pixel_width(const View& view);

}  // namespace lightgrid
