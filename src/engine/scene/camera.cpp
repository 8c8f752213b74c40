#include "scene/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "base/error.h"
#include "base/text.h"

namespace lightgrid {
namespace {

// Beyond any scene, and small enough that squares of differences stay finite.
constexpr double max_coordinate_m = 1e12;

// GLM's normalize squares first, which loses lengths below 1e-154.
glm::dvec3 normalize_any(const glm::dvec3& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return glm::normalize(v / largest);
}

bool is_direction(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && v != glm::dvec3(0);
}

// The rigid part of the matrix: keeps its direction, then its up; mirrored cameras are unmirrored.
glm::dmat3 rigid_rotation(const Camera& camera) {
  const glm::dmat3 axes(camera.world_from_view);
  if (!is_direction(axes[1]) || !is_direction(axes[2])) {
    throw input_error("camera \"{}\": its matrix has no direction", camera.name);
  }
  const glm::dvec3 back = normalize_any(axes[2]);
  const glm::dvec3 up = normalize_any(axes[1]);
  const glm::dvec3 across = up - back * glm::dot(up, back);
  if (glm::dot(across, across) < 1e-24) throw input_error("camera \"{}\": its matrix is flat", camera.name);
  const glm::dvec3 y = glm::normalize(across);
  return {glm::cross(y, back), y, back};
}

glm::dmat4 perspective(const Camera& camera, double aspect) {
  if (!(camera.fov_y_rad > 0 && camera.fov_y_rad < std::numbers::pi)) {
    throw input_error("camera \"{}\": field of view {} rad is not between 0 and pi", camera.name,
                      camera.fov_y_rad);
  }
  if (!(camera.near_m > 0 && camera.near_m < camera.far_m && std::isfinite(camera.near_m))) {
    throw input_error("camera \"{}\": near {} and far {} are not 0 < near < far", camera.name, camera.near_m,
                      camera.far_m);
  }
  const double f = 1 / std::tan(camera.fov_y_rad / 2);
  const bool endless = std::isinf(camera.far_m);
  const double near_m = camera.near_m, far_m = camera.far_m;
  glm::dmat4 clip_from_view(0);
  clip_from_view[0][0] = f / aspect;
  clip_from_view[1][1] = f;
  clip_from_view[2][2] = endless ? 0 : near_m / (far_m - near_m);
  clip_from_view[2][3] = -1;
  clip_from_view[3][2] = endless ? near_m : far_m * near_m / (far_m - near_m);
  return clip_from_view;
}

glm::dmat4 orthographic(const Camera& camera, double aspect) {
  if (!(camera.half_height_m > 0 && std::isfinite(camera.half_height_m))) {
    throw input_error("camera \"{}\": half height {} is not above 0", camera.name, camera.half_height_m);
  }
  if (!(std::isfinite(camera.near_m) && std::isfinite(camera.far_m) && camera.near_m < camera.far_m)) {
    throw input_error("camera \"{}\": orthographic needs finite near < far, has {} and {}", camera.name,
                      camera.near_m, camera.far_m);
  }
  const double depth = camera.far_m - camera.near_m;
  glm::dmat4 clip_from_view(1);
  clip_from_view[0][0] = 1 / (camera.half_height_m * aspect);
  clip_from_view[1][1] = 1 / camera.half_height_m;
  clip_from_view[2][2] = 1 / depth;
  clip_from_view[3][2] = camera.far_m / depth;
  return clip_from_view;
}

// The scene's size in metres, 1 if it has none.
double size_of(const WorldBox& box) {
  const double size = box.empty() ? 0 : glm::length(box.max - box.min);
  return size > 0 && std::isfinite(size) ? size : 1;
}

double camera_number(std::string_view text, const std::string& wish) {
  const double value = parse_number<double>(text).value_or(std::numeric_limits<double>::quiet_NaN());
  if (!std::isfinite(value)) throw input_error("camera {}: \"{}\" is not a number", wish, text);
  if (std::abs(value) > max_coordinate_m) {
    throw input_error("camera {}: {} is beyond {:g}", wish, text, max_coordinate_m);
  }
  return value;
}

// The near plane where none is given: the ground is seen from eye height in a scene of any size. Reversed
// depth loses no precision by it (docs/conventions.md#near).
double default_near_m(double size_m) { return std::min(size_m / 1000, 0.1); }

struct LookAtWish {
  glm::dvec3 eye{0}, target{0};
  double fov_deg = 60;
  double near_m = 0;  // 0: not given
};

LookAtWish parse_look_at(const std::string& wish) {
  LookAtWish parsed;
  struct Key {
    std::string_view name;
    double* values;
    int count;
    bool seen;
  };
  std::array<Key, 4> keys{{{"eye:", &parsed.eye.x, 3, false},
                           {"target:", &parsed.target.x, 3, false},
                           {"fov:", &parsed.fov_deg, 1, false},
                           {"near:", &parsed.near_m, 1, false}}};
  std::string_view rest = wish;
  const auto next_item = [&rest] {
    const std::string_view item = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), item.size() + 1));
    return item;
  };
  while (!rest.empty()) {
    std::string_view item = next_item();
    const auto key =
        std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return item.starts_with(k.name); });
    if (key == keys.end() || key->seen) {
      throw input_error("camera {}: \"{}\" is {}; the form is eye:x,y,z,target:x,y,z,fov:deg,near:m", wish,
                        item, key == keys.end() ? "not eye:, target:, fov: or near:" : "there twice");
    }
    key->seen = true;
    item.remove_prefix(key->name.size());
    key->values[0] = camera_number(item, wish);
    for (int i = 1; i < key->count; ++i) key->values[i] = camera_number(next_item(), wish);
  }
  for (const Key& key : keys) {
    if (!key.seen && key.count == 3) throw input_error("camera {}: {} is missing", wish, key.name);
  }
  if (!(parsed.fov_deg > 0 && parsed.fov_deg < 180)) {
    throw input_error("camera {}: fov {} is not between 0 and 180 degrees", wish, parsed.fov_deg);
  }
  if (keys[3].seen && !(parsed.near_m > 0)) {
    throw input_error("camera {}: near {} is not above 0", wish, parsed.near_m);
  }
  if (parsed.eye == parsed.target) throw input_error("camera {}: the target is the eye", wish);
  return parsed;
}

std::string known_cameras(const Scene& scene) {
  if (scene.cameras.empty()) return "the scene has none";
  std::string names;
  for (size_t i = 0; i < std::min<size_t>(scene.cameras.size(), 20); ++i) {
    names += fmt::format("{}{} \"{}\"", i ? ", " : "", i, scene.cameras[i].name);
  }
  return fmt::format("the scene has {}{}", names, scene.cameras.size() > 20 ? ", ..." : "");
}

Camera find_camera(const Scene& scene, const std::string& wish) {
  for (const Camera& camera : scene.cameras) {
    if (camera.name == wish) return camera;
  }
  const auto index = parse_number<size_t>(wish);
  if (index && *index < scene.cameras.size()) return scene.cameras[*index];
  throw input_error("camera {}: no camera of that name or index; {}", wish, known_cameras(scene));
}

}  // namespace

Camera look_at(const glm::dvec3& eye, const glm::dvec3& target) {
  const glm::dvec3 back = normalize_any(eye - target);
  const bool vertical = std::abs(back.x) < 1e-8 && std::abs(back.z) < 1e-8;
  const glm::dvec3 up = vertical ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0);
  const glm::dvec3 right = normalize_any(glm::cross(up, back));
  Camera camera;
  camera.world_from_view = glm::dmat4(glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0),
                                      glm::dvec4(back, 0), glm::dvec4(eye, 1));
  return camera;
}

View make_view(const Camera& camera, int width, int height) {
  const glm::dmat3 world_from_view = rigid_rotation(camera);
  const glm::dmat3 rotation = glm::transpose(world_from_view);
  View view;
  view.width = width;
  view.height = height;
  view.eye = glm::dvec3(camera.world_from_view[3]);
  if (!std::isfinite(view.eye.x) || !std::isfinite(view.eye.y) || !std::isfinite(view.eye.z)) {
    throw input_error("camera \"{}\": its position is not finite", camera.name);
  }
  view.view_from_world = glm::dmat4(rotation);
  view.view_from_world[3] = glm::dvec4(-(rotation * view.eye), 1);
  view.near_m = camera.near_m;
  view.far_m = camera.far_m;
  view.orthographic = camera.orthographic;
  const double aspect = double(width) / height;
  view.clip_from_view = camera.orthographic ? orthographic(camera, aspect) : perspective(camera, aspect);
  return view;
}

glm::dmat4 view_from_object(const View& view, const glm::dmat4& world_from_object) {
  const glm::dmat3 rotation(view.view_from_world);
  glm::dmat4 result(rotation * glm::dmat3(world_from_object));
  result[3] = glm::dvec4(rotation * (glm::dvec3(world_from_object[3]) - view.eye), 1);
  return result;
}

Camera choose_camera(const Scene& scene, const std::string& wish, double aspect) {
  if (wish.empty() && !scene.cameras.empty()) return scene.cameras.front();
  if (!wish.empty() && !wish.starts_with("eye:") && !wish.starts_with("target:"))
    return find_camera(scene, wish);

  if (wish.empty()) {
    std::optional<Camera> inside = room_camera(scene);
    if (!inside) return overview_camera(scene, aspect);
    inside->near_m = default_near_m(size_of(world_box(scene)));
    return *inside;
  }
  const LookAtWish parsed = parse_look_at(wish);
  Camera camera = look_at(parsed.eye, parsed.target);
  camera.fov_y_rad = parsed.fov_deg * (std::numbers::pi / 180);
  camera.near_m = parsed.near_m > 0 ? parsed.near_m : default_near_m(size_of(world_box(scene)));
  return camera;
}

}  // namespace lightgrid
