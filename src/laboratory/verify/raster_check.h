// Shared by hard cases of rasterising: scenes of few triangles, and the comparison with the coverage oracle.
#pragma once

#include <optional>
#include <vector>

#include "scene/random.h"
#include "verify/check.h"

namespace lightgrid::lab::verify {

// The places of a pixel's samples, pixels from its centre, y up.
std::vector<glm::dvec2> sample_places(int samples);

// A view from the origin whose clip space is (x, y, 0.1, -z): x = y = -z is the image's upper right corner.
inline RasterInput raster_scene(int width, int height, bool two_sided = false, int samples = 1) {
  RasterInput input;
  input.camera = {.grid = {width, height}, .clip_from_view = glm::dmat4(0)};
  input.camera.grid.samples = samples;
  glm::dmat4& m = input.camera.clip_from_view;
  m[0][0] = m[1][1] = 1;
  m[2][3] = -1;
  m[3][2] = 0.1;
  input.meshes.resize(1);
  input.instances = {{.two_sided = two_sided}};
  return input;
}

// The place that the view shows at pixel (x, y) and distance d.
inline glm::vec3 raster_position(const RasterInput& input, double x, double y, double d) {
  return {float((2 * x / input.camera.grid.width - 1) * d), float((2 * y / input.camera.grid.height - 1) * d),
          float(-d)};
}

inline void add_raster_triangle(RasterInput& input, const glm::vec3& a, const glm::vec3& b,
                                const glm::vec3& c) {
  RasterInputMesh& mesh = input.meshes[0];
  for (const glm::vec3& p : {a, b, c}) {
    mesh.indices.push_back(uint32_t(mesh.positions.size()));
    mesh.positions.push_back(p);
  }
}

// Three corners, one after the other.
template <typename Corner>
void add_raster_triangle(RasterInput& input, const Corner& corner) {
  const glm::vec3 a = corner(), b = corner(), c = corner();
  add_raster_triangle(input, a, b, c);
}

// Compares each sample of each pixel with the oracle, and the bytes of every shape with each other. Returns
// the first image, or nothing where the engine culls only.
std::optional<RasterImage> raster(Check& c, const RasterInput& input);

// Cases of one and of several samples. `input` is a scene without triangles.

// A sheet of triangles over the complete image: each sample is covered, and of 11 parts of the sheet, in which
// no two triangles touch, one covers it. Corners are anywhere, or each on a sample's place.
void covers_once(Check& c, RasterInput input, int cells, bool on_places, Random random);
// A thousand slivers around (x, y), their other corners `radius` pixels away.
void fan(Check& c, RasterInput input, double x, double y, double radius);
// Triangles within `reach` metres of the eye, on all sides.
void around_the_eye(Check& c, RasterInput input, int count, float reach, bool whole_numbers, Random random);
void huge_and_tiny_triangles(Check& c, RasterInput input, int count, Random random);
// One mesh three times in one place: of its copies the last is shown.
void equal_depths_of_copies(Check& c, RasterInput input, Random random);
// Triangles in and around the image.
void triangles_of_a_size(Check& c, RasterInput input, int count, Random random);

}  // namespace lightgrid::lab::verify
