// The hard cases of effects: a row each.
#include <filesystem>
#include <limits>
#include <numbers>

#include "base/image.h"
#include "base/text.h"
#include "scene/environment_light.h"
#include "scene/light_groups.h"
#include "scenes/cookie_image.h"
#include "scenes/profile_text.h"
#include "verify/effect_cases.h"

namespace lightgrid::lab::verify {
namespace {

using glm::dvec3;

constexpr const char *soft_cone = R"("type": "spot", "inner_cone": 0.45, "outer_cone": 0.9)",
                     *hard_cone = R"("type": "spot", "inner_cone": 0.9, "outer_cone": 0.9)";

// Joins the fields of a light.
template <typename... More>
std::vector<std::string> light(std::string fields, const More&... more) {
  ((fields += std::string(", ") + more), ...);
  return {fields};
}

std::string table(const char* key, const std::vector<uint8_t>& bytes) {
  return fmt::format(R"("{}": "data:application/octet-stream;base64,{}")", key, base64(bytes));
}

double ripple(double v, double h) {
  const double rad = std::numbers::pi / 180;
  return 75 + 40 * std::cos(3 * h * rad) * std::sin(v * rad) + 30 * std::cos(5 * v * rad);
}

std::string profile(std::vector<double> vertical, std::vector<double> horizontal, int type = 1,
                    double (*candela)(double, double) = ripple) {
  return table("profile", ProfileText{.vertical = std::move(vertical),
                                      .horizontal = std::move(horizontal),
                                      .candela = candela,
                                      .type = type}
                              .bytes());
}
std::string rotational(std::vector<double> vertical, double (*candela)(double, double) = ripple) {
  return profile(std::move(vertical), {0}, 1, candela);
}

EffectRows profiles() {
  const auto down = equal_angles(0, 180, 36), turn = equal_angles(0, 360, 24),
             half = equal_angles(-90, 90, 36);
  const auto nan = [](double v, double) { return v > 80 ? std::nan("") : 1; };
  return {
      "light_profiles",
      "brdf=lambert",
      5e-5,
      2e-5,
      {{"one_angle", light(rotational({0}))},
       {"all_candela_0", light(rotational({0, 90}, [](double, double) { return 0.0; }))},
       {"bright_at_the_last_angle",
        light(rotational(equal_angles(0, 90, 18)), R"("direction": [1, 0.3, -0.2])")},
       {"upper_half", light(rotational(equal_angles(90, 180, 18)), R"("direction": [0, 0, 1])")},
       {"quadrants", light(profile(down, equal_angles(0, 90, 6)))},
       {"mirrored_halves", light(profile(down, equal_angles(0, 180, 12)))},
       {"from_90_to_270", light(profile(down, equal_angles(90, 270, 12)))},
       {"seam_of_the_turn",
        light(profile(down, turn, 1, [](double v, double h) { return h == 0 || h == 360 ? 5 : 10 + h + v; }),
              R"("up_axis": [1, 0.2, 0])")},
       {"type_b", light(profile(half, equal_angles(0, 90, 18), 2))},
       {"type_b_sideways", light(profile(half, half, 2), R"("direction": [1, 0.5, -0.3])")},
       {"type_a", light(profile(equal_angles(0, 90, 18), half, 3))},
       {"pole_on_the_wall", light(profile(down, equal_angles(0, 360, 8), 1,
                                          [](double v, double h) {
                                            return v == 0 || v == 180 ? 50 : 50 + std::fmod(h, 360) / 9;
                                          }))},
       {"beam_of_half_a_degree",
        light(rotational({0, 4, 4.5, 90}, [](double v, double) { return double(v < 4.2); }),
              R"("position": [-0.2, 0.3, -0.3])")},
       {"irregular_angles", light(profile({0, 13.37, 61.03, 90, 120, 180}, {0, 10, 77, 90}))},
       {"profile_of_a_sheared_node",
        light(profile(down, turn), R"("direction": [0.4, 0.7, -0.6], "up_axis": [0.3, 0.7, -0.6])")},
       {"up_along_the_direction", light(profile(down, turn), R"("direction": [0, -1, 0])")},
       {"profile_in_the_wall", light(profile(down, turn), R"("position": [-0.2, 0.3, -4])")},
       {"profile_that_ends_on_the_wall", light(profile(down, turn), R"("radius": 0.9)")},
       {"profile_and_cone", light(profile(down, turn), soft_cone)},
       {.name = "candela_nan",
        .lights = light(rotational({0, 90}, nan)),
        .refused = "candela value 1 of horizontal angle 0"},
       {.name = "angles_descend", .lights = light(rotational({0, 90, 45})), .refused = "vertical angle"}}};
}

std::string cookie(int width, int height, glm::u8vec3 (*texel)(int, int) = speckle) {
  return table("cookie", cookie_png(width, height, texel));
}
glm::u8vec3 checker(int x, int y) {
  return (x + y) % 2 ? glm::u8vec3(255, 240, 200) : glm::u8vec3(20, 0, 40);
}
glm::u8vec3 black(int, int) { return glm::u8vec3(0); }

EffectRows cookies() {
  return {
      "light_cookies",
      "brdf=lambert",
      5e-5,
      2e-5,
      {{"projected", light(cookie(16, 16), soft_cone)},
       {"projected_obliquely",
        light(cookie(16, 12), soft_cone, R"("direction": [0.7, -0.4, -0.6], "up_axis": [0.2, 1, 0.4])")},
       {"cookie_to_the_edge_of_a_hard_cone", light(cookie(8, 8), hard_cone)},
       {"widest_projector",
        light(cookie(32, 32), R"("type": "spot", "inner_cone": 0.7, "outer_cone": 1.49)")},
       {"wider_than_a_projector",
        light(cookie(32, 32), R"("type": "spot", "inner_cone": 1.2, "outer_cone": 2.4)")},
       {"cone_of_6_degrees",
        light(cookie(8, 8),
              R"("type": "spot", "inner_cone": 0.05, "outer_cone": 0.1, "position": [-0.2, 0.3, -0.1])")},
       {"seam_and_poles", light(cookie(32, 16), R"("direction": [0, 0, 1], "up_axis": [0, 1, -1.5])")},
       {"cookies_pole_on_the_wall",
        light(cookie(64, 32), R"("direction": [0, 1, 0], "up_axis": [0, 0, -1])")},
       {"one_texel", light(cookie(1, 1), soft_cone)},
       {"odd_sizes", light(cookie(37, 11))},
       {"minified_checker", light(cookie(256, 256, checker), soft_cone)},
       {"minified_checker_around", light(cookie(512, 512, checker))},
       {"black_cookie", light(cookie(4, 4, black), soft_cone)},
       {"cookie_in_the_wall", light(cookie(4, 4), R"("position": [-0.22, 0.28, -4])")},
       {"cookie_of_a_sheared_node",
        light(cookie(16, 16), soft_cone, R"("direction": [0.4, 0.3, -0.6], "up_axis": [0.4, 0.4, -0.6])")},
       {"cookie_that_ends_on_the_wall", light(cookie(16, 16), soft_cone, R"("radius": 0.9)")},
       {"cookie_and_profile",
        light(cookie(16, 16), soft_cone, rotational({0, 20, 90}, [](double v, double) { return 100 - v; }))},
       {.name = "cookie_of_no_picture", .lights = light(table("cookie", {1, 2, 3})), .refused = "cookie"}}};
}

std::string hull(const std::string& planes) { return fmt::format(R"("hull": "{}")", planes); }

EffectRows hulls() {
  const std::string box = "1 0 0 0.9, -1 0 0 0.8, 0 2 0 1.4, 0 -1 0 0.6, 0 0 1 2, 0 0 -1 2";
  return {"light_hulls",
          "brdf=lambert",
          1e-4,
          2e-5,
          {{"in_a_box", light(hull(box))},
           {"half_space_through_the_lamp", light(hull("0 1 0 0"))},
           {"lamp_outside_of_its_hull", light(hull("0.3 1 0 -0.4"))},
           {"no_point_inside", light(hull("1 0 0 -0.5, -1 0 0 -0.5"))},
           {"thinner_than_its_edge", light(hull("0 0 -1 0.9005, 0 0 1 -0.8995"))},
           {"planes_10_km_away", light(hull("1 0 0 1e4, -1 0 0 1e4, 0 1 0 1e4"))},
           {"plane_of_the_wall", light(hull("0 0 -1 0.9"))},
           {"wall_in_the_fading_edge", light(hull("0 0 -1 0.905"))},
           {"eight_planes", light(hull(box + ", 1 1 0 0.9, -1 -1 0.2 1"))},
           {"twice_the_same_plane", light(hull("1 0.5 0 0.4, 1 0.5 0 0.4, 2 1 0 0.8"))},
           {"normals_of_any_length", light(hull("1e-20 0 0 4e-21, 0 1e20 0 3e19"))},
           {"hull_in_a_cone", light(hull(box), hard_cone)},
           {"range_that_ends_in_the_hull", light(hull("0 0 -1 2"), R"("radius": 0.9)")},
           {.name = "plane_of_nan", .lights = light(hull("nan 0 0 1")), .refused = "hull"},
           {.name = "nine_planes", .lights = light(hull(box + box + box)), .refused = "8 planes"},
           {.name = "hull_without_planes", .lights = light(hull("")), .is_planned = false}}};
}

auto surrounded_by(RadianceMap map) {
  return [map = std::move(map)](Scene& scene) {
    scene.environment = make_environment(map);
    scene.ambient = glm::vec3(0);
  };
}

RadianceMap sky_with(int column, int row, glm::vec3 texel) {
  RadianceMap map{"patched", 32, 16, std::vector<glm::vec3>(512, {0.2f, 0.3f, 0.5f})};
  map.texels[size_t(row * 32 + column)] = texel;
  return map;
}

// Changes a material, under a sky with a bright texel that the ball mirrors.
auto under_a_patched_sky(void (*change)(Scene&)) {
  return [=](Scene& scene) {
    surrounded_by(sky_with(20, 5, {40, 36, 30}))(scene);
    change(scene);
  };
}

void from_exr(Scene& scene, float texel) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "lightgrid_verify.exr";
  Image image(2, 1);
  image.pixels[1] = {1, texel, 1, 1};
  save_exr(path, image);
  try {
    scene.environment = parse_environment(path.string());
  } catch (...) {
    std::filesystem::remove(path);
    throw;
  }
}

EffectRows environments() {
  const auto row = [](const char* name, auto change) {
    return EffectRow{.name = name, .lights = {}, .change = change};
  };
  const auto with = [&](const char* name, void (*change)(Scene&)) {
    return row(name, under_a_patched_sky(change));
  };
  const auto refused = [](const char* name, auto change, const char* words) {
    return EffectRow{.name = name, .lights = {}, .change = change, .refused = words};
  };
  EffectRow grazing = with("surroundings_seen_at_grazing_angles", [](Scene&) {}),
            black_sky = row("black_sky", surrounded_by({"black", 1, 1, {glm::vec3(0)}})),
            unlit = with("surroundings_of_unlit_surfaces", [](Scene&s) {
              for (Material& m : s.materials) m.unlit = true;
            });
  grazing.camera = "eye:1.9,0.1,-3.95,target:-2,-0.1,-4.02";
  black_sky.is_planned = unlit.is_planned = false;
  return {"environment_light",
          "",
          2e-4,
          2e-4,
          {row("one_radiance", surrounded_by({"constant", 1, 1, {glm::vec3(0.5f)}})),
           row("radiance_of_1e30", surrounded_by({"huge", 1, 1, {glm::vec3(1e30f)}})),
           row("bright_pole", surrounded_by(sky_with(7, 0, {900, 700, 500}))),
           row("bright_seam", surrounded_by(sky_with(31, 8, {900, 700, 500}))),
           row("two_texels", surrounded_by({"halves", 2, 1, {{9, 0, 0}, {0, 0, 1e-6f}}})),
           with("smooth_mirror", [](Scene& s) { s.materials[ball].roughness = 0; }),
           with("roughest_metal", [](Scene& s) { s.materials[ball].roughness = 1; }),
           with("between_two_tables", [](Scene& s) { s.materials[ball].roughness = 0.125f; }),
           with("coat_over_a_rough_wall",
                [](Scene& s) {
                  s.materials[wall].clearcoat = 1;
                  s.materials[wall].clearcoat_roughness = 0.02f;
                }),
           with("ball_turned_inside_out",
                [](Scene& s) {
                  s.instances[ball].world_from_object *= glm::scale(glm::dmat4(1), dvec3(-1, 1.3, 0.8));
                }),
           with("skin_and_minnaert",
                [](Scene& s) {
                  s.materials[wall].model = {
                      .subsurface_color = {0.9f, 0.3f, 0.2f}, .roll_off = 0.4f, .minnaert_k = 0.6f};
                }),
           grazing, black_sky, unlit,
           refused(
               "radiance_nan", [](Scene& s) { from_exr(s, std::numeric_limits<float>::quiet_NaN()); },
               "pixel 1,0 has green nan"),
           refused(
               "radiance_above_1e30", [](Scene& s) { from_exr(s, 3e38f); }, "pixel 1,0 has green")}};
}

std::string panel(double width, double height) {
  return fmt::format(R"("type": "rectangle", "area_width": {}, "area_height": {})", width, height);
}

void make_mirror(Scene& scene) { scene.materials[ball].roughness = 0.05f; }

EffectRows areas() {
  return {"area_lights",
          "",
          5e-3,
          5e-3,
          {{"tiny_panel", light(panel(1e-4, 1e-4))},
           // At two grazing pixels of 1500; 0.13 with 9 points, 0.16 with 4.
           {.name = "panel_of_10_km",
            .lights = light(panel(1e4, 1e4), R"("radius": 10, "intensity": 3e7)"),
            .error = 0.11},
           {"micrometre_before_the_wall", light(panel(1, 1), R"("position": [-0.9, 0.8, -3.999999])")},
           {.name = "panel_in_the_walls_plane",
            .lights = light(panel(1, 1), R"("position": [-0.9, 0.8, -4], "direction": [0, 0, 1])"),
            .error = 0.06},
           {.name = "surface_behind_the_panel",
            .lights = light(panel(2, 2), R"("direction": [0, 0, 1])"),
            .error = 0.15},
           {"panel_behind_the_wall", light(panel(1, 1), R"("position": [0, 0, -5])")},
           {.name = "panel_across_the_horizon",
            .lights = light(panel(1, 1), R"("position": [-0.6, 0.3, -3.8], "direction": [1, 0, 0])"),
            .error = 0.045},
           {.name = "panel_along_the_horizon",
            .lights = light(panel(1, 1), R"("position": [-0.9, 0.3, -3.5], "direction": [1, 0, 0])"),
            .error = 0.03},
           {.name = "panel_seen_edge_on",
            .lights = light(panel(1, 1), R"("direction": [1, 0, -0.001])"),
            .error = 0.03},
           {.name = "sides_of_1_to_1000", .lights = light(panel(2, 2e-3)), .error = 0.014},
           {"panel_in_a_mirror",
            light(panel(0.6, 0.4), R"("position": [-0.6, 0.9, -1.5], "direction": [0.5, -0.5, -0.7])"),
            "eye:0,0,0,target:0,0,-4", "", make_mirror},
           {"up_along_the_panels_direction", light(panel(1, 0.5), R"("up_axis": [0, 0, -2])")},
           {"range_that_ends_on_the_panel",
            light(panel(2, 2), R"("position": [-0.5, 0.3, -3.6], "radius": 0.5)")},
           {"panel_with_a_narrow_cone", light(panel(0.5, 0.5), R"("inner_cone": 0.2, "outer_cone": 0.4)")},
           {"panel_inside_the_ball", light(panel(1, 1), R"("position": [0.3, -0.2, -3])")},
           {.name = "panel_without_width", .lights = light(panel(0, 1)), .is_planned = false},
           {.name = "panel_of_negative_width", .lights = light(panel(-1, 1)), .refused = "area_width"}}};
}

void keep_the_wall(Scene& scene) { scene.instances.resize(1); }

EffectRows far_lights() {
  const std::vector<std::string> lamps = {
      R"("intensity": 4)", R"("position": [1, -0.6, -2], "color": [0.2, 0.4, 1])",
      R"("type": "spot", "inner_cone": 0.2, "outer_cone": 0.7, "position": [0.4, 1.4, -1], "direction": [0.3, -0.4, -1])"};
  constexpr const char* from = "eye:0,0,0,target:0,0,-4";
  const auto moved = [](dvec3 by, double scale) {
    return [=](Scene& s) {
      for (Instance& i : s.instances) {
        i.world_from_object =
            glm::translate(glm::dmat4(1), by) * glm::scale(glm::dmat4(1), dvec3(scale)) * i.world_from_object;
      }
      for (Light& l : s.lights) l.position = l.position * scale + by;
    };
  };
  return {
      "far_light",
      "far-light=512 range=cutoff cutoff=0.5",
      0,
      0,
      {{"window_of_khr", lamps},
       {"smooth_window", lamps, from, "window=smooth"},
       {"no_window", lamps, from, "window=none"},
       {"lamp_on_a_sample", light(R"("position": [-1.8, -2, -4])")},
       {"lamp_in_the_wall", light(R"("position": [-0.2, 0.3, -4])")},
       {"box_without_depth", lamps, from, "", keep_the_wall},
       {"scene_of_10_km", light(R"("intensity": 3)"), "eye:0,0,0,target:0,0,-40000", "",
        moved(dvec3(0), 1e4)},
       {"scene_1e6_m_away", lamps, "eye:1000000,0,0,target:1000000,0,-4", "", moved({1e6, 0, 0}, 1)},
       {"cone_of_half_a_degree",
        light(R"("type": "spot", "inner_cone": 0.004, "outer_cone": 0.008, "intensity": 99)")},
       {"cone_of_180_degrees", light(R"("type": "spot", "inner_cone": 3, "outer_cone": 3.14159)")},
       {"intensities_of_1e4_and_1e_minus_4", {R"("intensity": 1e4)", R"("intensity": 1e-4)"}},
       {"range_that_ends_on_the_wall", light(R"("intensity": 0.405)")},
       {"far_light_of_a_group",
        {R"("intensity": 4)", R"("position": [1, 0, -2], "intensity": 5)"},
        from,
        "",
        [](Scene& s) {
          set_groups(s.lights[1], 2);
          set_groups(s.instances[ball], 1);
        }},
       {.name = "ranges_without_end", .lights = lamps, .settings = "range=infinite", .is_planned = false}}};
}

}  // namespace

const std::vector<EffectRows>& effect_rows() {
  static const std::vector<EffectRows> all = {profiles(),     cookies(), hulls(),
                                              environments(), areas(),   far_lights()};
  return all;
}

}  // namespace lightgrid::lab::verify
