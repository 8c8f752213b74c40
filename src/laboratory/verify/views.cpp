#include "verify/views.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "base/parallel.h"
#include "oracle/position.h"

namespace lightgrid::lab::verify {
namespace {

// Depth is (a z + b) / w, where a and b make it 1 at near and 0 at far, or vice versa.
void set_depth_row(glm::dmat4& clip, const Lens& lens) {
  const bool endless = std::isinf(lens.far);
  const double n = lens.near, f = lens.far;
  double a, b;
  if (lens.orthographic) {
    a = 1 / (f - n);
    b = f / (f - n);
    if (lens.order == DepthOrder::standard) {
      a = -a;
      b = -n / (f - n);
    }
  } else if (lens.order == DepthOrder::reversed) {
    a = endless ? 0 : n / (f - n);
    b = endless ? n : f * n / (f - n);
  } else {
    a = endless ? -1 : -f / (f - n);
    b = endless ? -n : -f * n / (f - n);
  }
  clip[2][2] = a;
  clip[3][2] = b;
}

}  // namespace

CullView view_through(const Lens& lens, int width, int height) {
  CullView view{.width = width, .height = height};
  glm::dmat4& clip = view.clip_from_view = glm::dmat4(lens.orthographic ? 1 : 0);
  clip[0][0] = 1 / lens.half_x;
  clip[1][1] = 1 / lens.half_y;
  if (lens.orthographic) {
    clip[3][0] = -lens.shift_x / lens.half_x;
    clip[3][1] = -lens.shift_y / lens.half_y;
  } else {
    clip[2][0] = lens.shift_x / lens.half_x;
    clip[2][1] = lens.shift_y / lens.half_y;
    clip[2][3] = -1;
  }
  set_depth_row(clip, lens);
  return view;
}

CullView field_of_view(double fov_y_deg, int width, int height) {
  const double half_y = std::tan(glm::radians(fov_y_deg) / 2);
  return view_through({.half_x = half_y * width / height, .half_y = half_y}, width, height);
}

const CullView& sixty() {
  static const CullView view = field_of_view(60, 127, 73);
  return view;
}

const CullView& small_sixty() {
  static const CullView view = field_of_view(60, 64, 48);
  return view;
}

View oracle_view(const CullView& view) {
  View v{
      .width = view.width, .height = view.height, .view_from_world = view.view_from_world, .eye = view.eye};
  v.clip_from_view = view.clip_from_view;
  v.orthographic = is_orthographic(view);
  return v;
}

float depth_of_nothing(const CullView& view) { return has_standard_depth(view) ? 1.0f : 0.0f; }

double depth_at(const CullView& view, double distance) {
  const glm::dmat4& clip = view.clip_from_view;
  return is_orthographic(view) ? clip[3][2] - clip[2][2] * distance : clip[3][2] / distance - clip[2][2];
}

double distance_at(const CullView& view, double depth) {
  const glm::dmat4& clip = view.clip_from_view;
  return is_orthographic(view) ? (clip[3][2] - depth) / clip[2][2] : clip[3][2] / (depth + clip[2][2]);
}

glm::dvec3 position_at(const View& view, int px, int py, double distance) {
  const double x = view_x_of_pixel(view, px + 0.5), y = view_y_of_pixel(view, py + 0.5);
  const double scale = view.orthographic ? 1 : distance;
  return {x * scale, y * scale, -distance};
}

int tiles_x(const CullView& view, int tile) { return (view.width + tile - 1) / tile; }

size_t tile_count(const CullView& view, int tile) {
  return size_t(tiles_x(view, tile)) * ((view.height + tile - 1) / tile);
}

CullView placed(CullView view, const glm::dvec3& eye, double yaw_rad, double pitch_rad) {
  glm::dmat4 turn = glm::rotate(glm::dmat4(1), pitch_rad, glm::dvec3(1, 0, 0));
  turn = glm::rotate(turn, yaw_rad, glm::dvec3(0, 1, 0));
  view.view_from_world = glm::translate(turn, -eye);
  view.eye = eye;
  return view;
}

glm::dvec3 to_view(const CullView& view, const glm::dvec3& world) {
  return glm::dmat3(view.view_from_world) * (world - view.eye);
}

glm::dvec3 to_world(const CullView& view, const glm::dvec3& in_view) {
  return glm::transpose(glm::dmat3(view.view_from_world)) * in_view + view.eye;
}

void move_to_world(const CullView& view, std::vector<CullLight>& lights) {
  for (CullLight& light : lights) {
    light.position = to_world(view, light.position);
    light.direction = glm::transpose(glm::dmat3(view.view_from_world)) * light.direction;
  }
}

glm::dvec3 median_light(std::span<const CullLight> lights) {
  glm::dvec3 middle(0);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> coordinates;
    for (const CullLight& light : lights)
      if (std::isfinite(light.position[axis])) coordinates.push_back(light.position[axis]);
    if (coordinates.empty()) continue;
    std::nth_element(coordinates.begin(), coordinates.begin() + coordinates.size() / 2, coordinates.end());
    middle[axis] = coordinates[coordinates.size() / 2];
  }
  return middle;
}

std::vector<OracleLight> oracle_lights(const CullView& view, std::span<const CullLight> lights) {
  const glm::dvec3 middle = median_light(lights);
  std::vector<OracleLight> all;
  for (const CullLight& light : lights) {
    OracleLight t{to_view(view, light.position),
                  glm::dmat3(view.view_from_world) * light.direction,
                  light.radius_m,
                  light.cos_outer,
                  0,
                  0,
                  false};
    const glm::dvec3 offset = glm::abs(light.position - middle);
    t.position_error = 2 * 0x1p-24 * (offset.x + offset.y + offset.z);
    const double length = glm::length(t.axis);
    if (length > 0 && std::isfinite(length))
      t.axis /= length;
    else
      t.cos_outer = -1;
    const double sum = light.position.x + light.position.y + light.position.z;
    t.lists_nothing = !(light.radius_m >= 0) || !std::isfinite(sum);
    all.push_back(t);
  }
  double cone_error = 0;
  for (const OracleLight& t : all) {
    if (t.cos_outer >= 0 && !t.lists_nothing) cone_error = std::max(cone_error, t.position_error);
  }
  for (OracleLight& t : all) t.cone_error = cone_error;
  return all;
}

Cell cell_of(const CullView& view, int tile, size_t index, const DepthInterval& bounds, bool pixel_centres) {
  return cell_of_grid(oracle_view(view), tile, view.slice_edges, index, bounds.near, bounds.far,
                      pixel_centres);
}

Touching touching_lights(const CullView& view, std::span<const OracleLight> lights,
                         std::span<const DepthInterval> bounds, int tile, bool pixel_centres) {
  const size_t tiles = bounds.size();
  Touching touching(tiles * (view.slice_edges.size() + 1));
  parallel_for(int(touching.size()), [&](int i) {
    const Cell cell = cell_of(view, tile, size_t(i), bounds[size_t(i) % tiles], pixel_centres);
    for (uint32_t light = 0; light < lights.size(); ++light) {
      if (certainly_touches(cell, lights[light])) touching[i].push_back(light);
    }
  });
  return touching;
}

std::vector<NamedView> hard_views(int width, int height) {
  const CullView sixty = field_of_view(60, width, height);
  return {
      {"60 degrees", sixty},
      {"0.1 degrees", field_of_view(0.1, width, height)},
      {"170 degrees", field_of_view(170, width, height)},
      {"179 degrees", field_of_view(179, width, height)},
      {"off centre", view_through({.half_x = 0.5, .half_y = 0.3, .far = 200, .shift_x = 0.9, .shift_y = -0.7},
                                  width, height)},
      {"orthographic", view_through({.half_x = 5.0 * width / height,
                                     .half_y = 5,
                                     .near = 0,
                                     .far = 100,
                                     .shift_x = 3,
                                     .orthographic = true},
                                    width, height)},
      {"standard depth",
       view_through({.half_x = 1, .half_y = 0.6, .far = 1000, .order = DepthOrder::standard}, width, height)},
      {"turned, 10^7 m out", placed(sixty, {1e7, -3e6, 2e7}, 0.7, -0.4)}};
}

}  // namespace lightgrid::lab::verify
