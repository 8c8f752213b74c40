#include "raster/raster_arrays.h"

#include <cmath>

#include "base/error.h"

namespace lightgrid {
namespace {

constexpr int most_pixels = 16384;
constexpr float guard_units =
    16368 * 256;  // from the view's centre: coordinates then differ by less than 2^23

bool is_perspective(const glm::dmat4& clip_from_view) { return clip_from_view[2][3] != 0; }

void require_finite(const glm::dmat4& m, const char* name) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!std::isfinite(m[column][row])) throw input_error("rasterizer: {} holds {}", name, m[column][row]);
    }
  }
}

}  // namespace

void check_raster_camera(const RasterCamera& camera) {
  for (const int size : {camera.grid.width, camera.grid.height}) {
    if (size < 1 || size > most_pixels)
      throw input_error("rasterizer: a view of {} pixels; 1 to {} will do", size, most_pixels);
  }
  if (camera.grid.samples != 1 && camera.grid.samples != 4)
    throw input_error("rasterizer: {} samples a pixel; 1 and 4 are possible", camera.grid.samples);
  require_finite(camera.clip_from_view, "clip_from_view");
  require_finite(camera.view_from_world, "view_from_world");
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(camera.eye[i])) throw input_error("rasterizer: the eye is at {}", camera.eye[i]);
  }
  const glm::dmat3 turn(camera.view_from_world);
  const glm::dmat3 unit = turn * glm::transpose(turn);
  double error = 0;
  for (int i = 0; i < 9; ++i)
    error = std::max(error, std::abs(unit[i / 3][i % 3] - (i / 3 == i % 3 ? 1 : 0)));
  if (error > 1e-6 || glm::determinant(turn) < 0)
    throw input_error("rasterizer: view_from_world is not rigid");

  const glm::dmat4& m = camera.clip_from_view;
  if (m[0][3] != 0 || m[1][3] != 0 || m[0][2] != 0 || m[1][2] != 0) {
    throw input_error("rasterizer: clip_from_view does not project along -z");
  }
  if (!(m[0][0] * m[1][1] - m[1][0] * m[0][1] > 0))
    throw input_error("rasterizer: clip_from_view mirrors or flattens the image");
  // depth = z / w: 1 at the near plane, falling with the distance d = -z.
  const bool perspective = is_perspective(m);
  const double w = perspective ? -m[2][3] : m[3][3];
  const bool reversed = perspective ? m[3][3] == 0 && m[3][2] > 0 && m[2][2] >= 0 : m[2][2] > 0;
  if (!(w > 0) || !reversed) {
    throw input_error(
        "rasterizer: clip_from_view is neither perspective nor orthographic, or its depth is not reversed");
  }
}

RasterParams raster_params(const RasterCamera& camera) {
  RasterParams p{};
  p.half_x = float(128 * camera.grid.width), p.half_y = float(128 * camera.grid.height);
  p.guard_x = guard_units / p.half_x, p.guard_y = guard_units / p.half_y;
  p.width = uint32_t(camera.grid.width), p.height = uint32_t(camera.grid.height);
  p.tiles_x = (p.width + RASTER_TILE - 1) / RASTER_TILE,
  p.tiles_y = (p.height + RASTER_TILE - 1) / RASTER_TILE;
  return p;
}

RasterFrameInstance raster_frame_instance(const RasterCamera& camera, const glm::dmat4& world_from_object,
                                          bool two_sided) {
  // Relative to the eye before anything is rounded: see docs/conventions.md, "Camera-relative".
  glm::dmat4 eye_from_object = world_from_object;
  eye_from_object[3] -= glm::dvec4(camera.eye, 0);
  const glm::dmat3 turn(camera.view_from_world);
  const glm::dmat4 clip_from_object = camera.clip_from_view * (glm::dmat4(turn) * eye_from_object);
  RasterFrameInstance instance{};
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column)
      instance.clip_from_object[4 * row + column] = float(clip_from_object[column][row]);
  }
  const glm::dmat3 linear(world_from_object);
  const glm::dmat3 object_from_eye = glm::inverse(linear);
  const bool perspective = is_perspective(camera.clip_from_view);
  const glm::dvec3 forward = -glm::dvec3(turn[0][2], turn[1][2], turn[2][2]);
  const glm::vec3 eye(perspective ? -(object_from_eye * glm::dvec3(eye_from_object[3]))
                                  : glm::normalize(object_from_eye * forward));
  const bool usable = std::isfinite(eye.x) && std::isfinite(eye.y) && std::isfinite(eye.z);
  instance.eye_x = eye.x, instance.eye_y = eye.y, instance.eye_z = eye.z;
  instance.eye_is_point = two_sided || !usable ? RASTER_NONE : perspective ? 1 : 0;
  return instance;
}

}  // namespace lightgrid
