// Pictures of the conformance models, addressed by positions in the world rather than by pixels.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "base/log.h"
#include "measures/metrics.h"
#include "scene/light_rigs.h"
#include "scene/load_gltf.h"
#include "support/render.h"
#include "support/shared_files.h"

namespace lightgrid {

inline Scene load_model(const std::string& path, int scene = -1) {
  set_log_level(LogLevel::quiet);
  return load_gltf(shared_folder() / "scenes/conformance" / path, scene);
}

// The dominant colour: by a factor of two over the others.
enum class Hue { dark, red, green, blue, cyan, magenta, yellow, mixed };

inline Hue hue_of(const glm::vec3& c) {
  const float largest = std::max({c.r, c.g, c.b});
  if (largest < 0.02f) return Hue::dark;
  const int high = (c.r > largest / 2) | (c.g > largest / 2) << 1 | (c.b > largest / 2) << 2;
  constexpr Hue hues[8] = {Hue::dark, Hue::red,     Hue::green, Hue::yellow,
                           Hue::blue, Hue::magenta, Hue::cyan,  Hue::mixed};
  return hues[high];
}

// The file's first camera; without one, one in front of the corner of the scene's box that keeps its eight
// corners in a square image. The program's own default fills the image better; positions in these pictures
// assume this one.
inline Camera camera_at_the_corner(const Scene& scene) {
  if (!scene.cameras.empty()) return scene.cameras.front();
  const WorldBox box = world_box(scene);
  const glm::dvec3 center = (box.min + box.max) / 2.0;
  Camera camera = look_at(center + glm::dvec3(0.62, 0.45, 0.78), center);
  const glm::dmat3 view_from_world = glm::transpose(glm::dmat3(camera.world_from_view));
  const double size = glm::length(box.max - box.min);
  double distance = size / 2;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 world(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                           corner & 4 ? box.max.z : box.min.z);
    const glm::dvec3 p = view_from_world * (world - center);
    distance =
        std::max(distance, p.z + std::max(std::abs(p.x), std::abs(p.y)) / std::tan(camera.fov_y_rad / 2));
  }
  camera.near_m = 1e-3 * size;
  camera.world_from_view[3] =
      glm::dvec4(center + glm::dvec3(camera.world_from_view[2]) * (1.05 * distance), 1);
  return camera;
}

struct Picture {
  View view;
  Image image;

  glm::ivec2 pixel(const glm::dvec3& world) const {
    const glm::dvec4 clip = view.clip_from_view * (view.view_from_world * glm::dvec4(world, 1));
    return {int(std::floor((clip.x / clip.w * 0.5 + 0.5) * view.width)),
            int(std::floor((clip.y / clip.w * 0.5 + 0.5) * view.height))};
  }
  glm::vec3 at(const glm::dvec3& world) const {
    const glm::ivec2 p = pixel(world);
    return image.at(p.x, p.y);
  }
  bool is_background(const glm::dvec3& world) const { return at(world) == glm::vec3(0); }

  // The fraction of the pixels between two opposite corners with a hue.
  double share(Hue hue, const glm::dvec3& corner_a, const glm::dvec3& corner_b) const {
    const glm::ivec2 a = pixel(corner_a), b = pixel(corner_b), low = glm::min(a, b), high = glm::max(a, b);
    int count = 0;
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) count += hue_of(image.at(x, y)) == hue;
    }
    return double(count) / ((high.x - low.x + 1) * (high.y - low.y + 1));
  }
  // The share of the whole picture.
  double share(Hue hue) const {
    int count = 0;
    for (const glm::vec4& p : image.pixels) count += hue_of(p) == hue;
    return double(count) / double(image.pixels.size());
  }
};

// As the program shows it: with the default lights if the scene has none.
inline Picture picture_of(Scene scene, const Camera& camera, int width = 320, int height = 240) {
  Picture picture{make_view(camera, width, height), {}};
  if (scene.lights.empty()) {
    DefaultLights rig = default_lights(picture.view);
    scene.lights = rig.lights;
    scene.ambient = rig.ambient;
  }
  picture.image = render_image(scene, picture.view);
  EXPECT_EQ(count_nan_pixels(picture.image), 0u);
  return picture;
}

inline Picture picture_of(const Scene& scene, const std::string& camera = "") {
  return picture_of(scene, camera.empty() ? camera_at_the_corner(scene) : choose_camera(scene, camera));
}

// Along -z at the plane z = 0; the picture is `height_m` high.
inline Camera facing(const glm::dvec2& center, double height_m) {
  const double distance = height_m / 2 / std::tan(Camera().fov_y_rad / 2);
  return look_at({center.x, center.y, distance}, {center.x, center.y, 0});
}

}  // namespace lightgrid
