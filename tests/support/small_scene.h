// A wall, a ball in front of it and six point lights, for tests that add one effect at a time. The camera is
// at the origin and looks along -z.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "scene/area_lights.h"
#include "scene/camera.h"
#include "scene/light_groups.h"
#include "scenes/compose.h"
#include "scenes/cookie_image.h"
#include "scenes/profile_text.h"
#include "scenes/shapes.h"

namespace lightgrid {

struct SmallScene {
  Scene scene;
  int wall_material = 0, ball_material = 0, wall = 0, ball = 0;  // wall, ball: meshes
};

inline Mesh wall_mesh(glm::vec3 center, float half, int material, const std::string& name) {
  Mesh mesh;
  shapes::add_quad(mesh, center - glm::vec3(half, half, 0), {2 * half, 0, 0}, {0, 2 * half, 0}, 2, 2);
  return shapes::finished(std::move(mesh), name, material);
}

inline SmallScene small_scene(bool lights = true) {
  SmallScene s;
  s.scene.name = "small";
  s.scene.background = {0.1f, 0.2f, 0.3f};
  s.wall_material = add_material(s.scene, "plaster", {0.7f, 0.6f, 0.5f}, 0, 0.8f);
  s.ball_material = add_material(s.scene, "steel", {0.6f, 0.6f, 0.7f}, 1, 0.3f);
  s.wall = add_mesh(s.scene, wall_mesh({0.2f, 0, -4}, 2, s.wall_material, "wall"));
  Mesh ball;
  shapes::add_sphere(ball, {0, 0, 0}, 0.7f, 6);
  s.ball = add_mesh(s.scene, shapes::finished(std::move(ball), "ball", s.ball_material));
  add_instance(s.scene, "wall", s.wall);
  add_instance(s.scene, "ball", s.ball, placed({0.3, -0.2, -3}));
  if (lights) {
    for (int i = 0; i < 6; ++i) {
      add_point(s.scene, "lamp", {-1.5f + 0.6f * i, i % 2 ? 0.8f : -0.7f, -2.5f - 0.2f * i}, {1, 0.9f, 0.8f},
                2, 1.2f);
    }
  }
  return s;
}

// All lamps cast shadows. The ball stands between most of them and a part of the wall.
inline SmallScene small_scene_of_casters() {
  SmallScene s = small_scene();
  for (Light& light : s.scene.lights) {
    light.casts_shadow = true;
    light.radius_m = 4;
  }
  return s;
}

// Glass between the lamps and a part of the wall, which casts a shadow with the setting shadow-blended.
inline void add_pane_before_wall(SmallScene& s, float alpha) {
  const int glass = add_material(s.scene, "glass", {0.5f, 0.8f, 0.9f}, 0, 0.4f);
  Material& m = s.scene.materials[size_t(glass)];
  m.base_color.a = alpha;
  m.alpha_mode = AlphaMode::blend;
  m.double_sided = true;
  add_instance(s.scene, "pane", add_mesh(s.scene, wall_mesh({-0.5f, 0.3f, -3.8f}, 0.6f, glass, "pane")));
}

inline View small_view(int width, int height) {
  return make_view(look_at({0, 0, 0}, {0, 0, -1}), width, height);
}

// Eight by eight pixels, no two alike; alpha on both sides of a half.
inline int add_speckles(Scene& scene, bool srgb) {
  Bitmap bitmap;
  bitmap.name = "speckles";
  bitmap.width = bitmap.height = 8;
  for (int i = 0; i < 64; ++i) {
    for (const int byte : {100 + i, 130 + i / 2, 255 - i, i % 3 ? 255 : 0})
      bitmap.rgba.push_back(uint8_t(byte));
  }
  return add_texture(scene, std::move(bitmap), srgb);
}

// Lamps light the wall alone, the ball alone, both by the last group, or nothing; some have every group. What
// comes after the ball and the lamps takes its turn. The wall has another mask in each bit than the ball.
inline void add_groups(Scene& scene) {
  constexpr uint32_t last = 1u << 31, of_lights[] = {1, 2, last, all_groups, 0, 3};
  constexpr uint32_t of_instances[] = {1 | last, 2 | last, 1 << 8 | 2};
  for (size_t i = 0; i < scene.lights.size(); ++i) set_groups(scene.lights[i], of_lights[i % 6]);
  for (size_t i = 0; i < scene.instances.size(); ++i) set_groups(scene.instances[i], of_instances[i % 3]);
}

struct SceneEffect {
  std::string name;
  std::string decision;  // as in FramePlan::decisions; empty if the effect is the absence of all
  std::string define;    // define of shaders; empty if no material sets it
  std::string witness;   // the start of its reason
  std::function<void(SmallScene&)> add;
};

// One effect each on the small scene. Only the first two bring another with them, except for textures.
inline const std::vector<SceneEffect>& effects() {
  const auto map = [](TextureSlot Material::*slot, bool srgb) {
    return [=](SmallScene& s) {
      TextureSlot& used = s.scene.materials[s.wall_material].*slot;
      used.texture = add_speckles(s.scene, srgb);
    };
  };
  const std::string on_wall = "material 0 \"plaster\" on node 0 \"wall\"",
                    on_ball = "material 1 \"steel\" on node 1 \"ball\"";
  static const std::vector<SceneEffect> all = {
      {"blend", "blend", "", "material 2 \"glass\" on node 2 \"pane\"",
       [](SmallScene& s) {
         const int glass = add_material(s.scene, "glass", {0.5f, 0.8f, 0.9f}, 0, 0.1f);
         s.scene.materials[glass].base_color.a = 0.4f;
         s.scene.materials[glass].alpha_mode = AlphaMode::blend;
         add_instance(s.scene, "pane", add_mesh(s.scene, wall_mesh({-0.5f, 0, -2}, 0.6f, glass, "pane")));
       }},
      {"mask", "alpha masks", "MASK", on_wall,
       [=](SmallScene& s) {
         map(&Material::base_color_map, true)(s);
         s.scene.materials[s.wall_material].alpha_mode = AlphaMode::mask;
       }},
      {"base_color_map", "base colour maps", "BASE_COLOR_MAP", on_wall, map(&Material::base_color_map, true)},
      {"metallic_roughness_map", "metallic-roughness maps", "METALLIC_ROUGHNESS_MAP", on_wall,
       map(&Material::metallic_roughness_map, false)},
      {"normal_map", "normal maps", "NORMAL_MAP", on_wall, map(&Material::normal_map, false)},
      {"occlusion_map", "occlusion maps", "OCCLUSION_MAP", on_wall, map(&Material::occlusion_map, false)},
      {"emissive_map", "emissive maps", "EMISSIVE_MAP", on_wall,
       [=](SmallScene& s) {
         map(&Material::emissive_map, true)(s);
         s.scene.materials[s.wall_material].emissive = {0.5f, 0.1f, 0.2f};
       }},
      {"vertex_color", "vertex colours", "VERTEX_COLOR", on_ball,
       [](SmallScene& s) {
         Mesh& ball = s.scene.meshes[s.ball];
         for (const glm::vec3& p : ball.positions) ball.colors.emplace_back(glm::abs(p), 1);
       }},
      {"uv1", "second UV set", "UV1", on_wall,
       [=](SmallScene& s) {
         map(&Material::base_color_map, true)(s);
         s.scene.materials[s.wall_material].base_color_map.uv_set = 1;
         for (const glm::vec2& uv : s.scene.meshes[s.wall].uv0)
           s.scene.meshes[s.wall].uv1.push_back(uv * 0.3f);
       }},
      {"uv_transform", "texture transforms", "UV_TRANSFORM", on_wall,
       [=](SmallScene& s) {
         map(&Material::base_color_map, true)(s);
         s.scene.materials[s.wall_material].base_color_map.uv_from_vertex = {0.6f, 0.8f, -0.8f,
                                                                             0.6f, 0.1f, 0.2f};
       }},
      {"clearcoat", "clearcoat", "CLEARCOAT", on_ball,
       [](SmallScene& s) {
         Material& m = s.scene.materials[s.ball_material];
         m.clearcoat = 0.8f;
         m.clearcoat_roughness = 0.15f;
       }},
      {"clearcoat_maps", "clearcoat normal maps", "CLEARCOAT_NORMAL_MAP", on_wall,
       [=](SmallScene& s) {
         for (TextureSlot Material::*slot :
              {&Material::clearcoat_map, &Material::clearcoat_roughness_map, &Material::clearcoat_normal_map})
           map(slot, false)(s);
         Material& m = s.scene.materials[s.wall_material];
         m.clearcoat = 1;
         m.clearcoat_roughness = 0.7f;
         m.clearcoat_normal_scale = 0.4f;
       }},
      {"skin", "skin", "SKIN", on_wall,
       [](SmallScene& s) {
         MaterialModel& model = s.scene.materials[s.wall_material].model;
         model.subsurface_color = {0.9f, 0.3f, 0.2f};
         model.roll_off = 0.4f;
       }},
      {"minnaert", "Minnaert", "MINNAERT", on_wall,  // with skin: a material may have both
       [](SmallScene& s) {
         MaterialModel& model = s.scene.materials[s.wall_material].model;
         model = {.subsurface_color = {0.9f, 0.3f, 0.2f}, .roll_off = 0.4f, .minnaert_k = 0.6f};
       }},
      {"specular", "specular reflectance", "SPECULAR", on_wall,
       [](SmallScene& s) {
         Material& m = s.scene.materials[s.wall_material];
         m.ior = 2.42f;
         m.specular = 0.75f;
         m.specular_color = {1, 0.8f, 0.2f};
         m.metallic = 0.2f;
       }},
      {"specular_maps", "specular colour maps", "SPECULAR_COLOR_MAP", on_wall,
       [=](SmallScene& s) {
         map(&Material::specular_map, false)(s);
         map(&Material::specular_color_map, true)(s);
         Material& m = s.scene.materials[s.wall_material];
         m.ior = 1.9f;
         m.specular_color = {3, 1, 1};
       }},
      {"unlit", "unlit materials", "UNLIT", on_ball,
       [](SmallScene& s) { s.scene.materials[s.ball_material].unlit = true; }},
      {"spot", "spot cones", "", "light 6 \"torch\"",
       [](SmallScene& s) {
         add_spot(s.scene, "torch", {0, 0, -1}, {-0.5f, 0, -4}, {1, 1, 1}, 9, 5, 10, 25);
       }},
      {"directional", "directional lights", "", "light 6 \"sun\"",
       [](SmallScene& s) {
         Light& sun = s.scene.lights.emplace_back();
         sun.name = "sun";
         sun.type = LightType::directional;
         sun.direction = glm::normalize(glm::vec3(0.3f, -0.5f, -1));
       }},
      {"area", "area lights", "", "light 6 \"panel\" is a rectangle of 1.2 m x 0.6 m",
       [](SmallScene& s) {
         add_spot(s.scene, "panel", {-0.8f, 0.9f, -2.6f}, {0.3f, -0.2f, -4}, {1, 0.8f, 0.6f}, 3, 4, 10, 25);
         set_rectangle(s.scene.lights.back(), 1.2, 0.6);
       }},
      {"groups", "light groups", "", "light 0 \"lamp\" has 0", [](SmallScene& s) { add_groups(s.scene); }},
      {"cookies", "light cookies", "", "light 0 \"lamp\" has one",
       [](SmallScene& s) {
         const SharedTable table = speckled_cookie(24, 12);
         for (Light& light : s.scene.lights) light_cookie.set(light, table);
       }},
      {"profiles", "light profiles", "", "light 0 \"lamp\" has one",
       [](SmallScene& s) {
         const ProfileText of_both_angles{.vertical = equal_angles(0, 180, 12),
                                          .horizontal = equal_angles(0, 180, 6),
                                          .candela = [](double v, double h) { return 200 - v + h / 2; }},
             to_the_wall{.vertical = {0, 40, 90}, .candela = [](double v, double) { return 90 - v; }};
         for (size_t i = 0; i < 6; ++i)
           light_profile.set(s.scene.lights[i], (i % 2 ? of_both_angles : to_the_wall).table());
       }},
  };
  return all;
}

inline const SceneEffect& effect(const std::string& name) {
  for (const SceneEffect& candidate : effects()) {
    if (candidate.name == name) return candidate;
  }
  throw std::runtime_error("no effect " + name);
}

inline std::vector<std::string> effect_names() {
  std::vector<std::string> names;
  for (const SceneEffect& each : effects()) names.push_back(each.name);
  return names;
}

}  // namespace lightgrid
