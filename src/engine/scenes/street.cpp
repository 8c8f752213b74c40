// A street 360 m long: the same bay of houses on both sides, each house with its own colour and shop light.
// Lights at every depth from arm's length to the far end: the case for depth slices.
#include "scenes/street_parts.h"

#include <array>
#include <utility>

#include "scene/random.h"
#include "scenes/builtin.h"
#include "scenes/compose.h"
#include "scenes/shapes.h"

namespace lightgrid {
namespace {

using namespace street;

constexpr glm::vec3 sodium(1, 0.64f, 0.30f), white(0.92f, 0.95f, 1), tail(1, 0.10f, 0.06f),
    head(1, 0.93f, 0.80f);

class Street {
 public:
  Scene make() {
    scene_.name = "street";
    scene_.ambient = glm::vec3(0.024f, 0.028f, 0.045f);
    scene_.background = glm::vec3(0.006f, 0.009f, 0.022f);
    add_instance(scene_, "road", add_mesh(scene_, road(m_)));
    add_instance(scene_, "pavements", add_mesh(scene_, pavements(m_)));
    add_instance(scene_, "road markings", add_mesh(scene_, markings(m_)));
    for (int house = 0; house < houses_a_side; ++house) {
      for (const int side : {-1, 1}) add_house(house, side);
    }
    for (int i = 0; i < lamp_posts_a_side; ++i) {
      for (const int side : {-1, 1}) add_lamp_post(i, side);
    }
    for (int i = 0; i < cars; ++i) add_car(i);
    add_garlands();
    add_moon();
    add_camera(scene_, "pavement", {-4.2, 1.7, -7.4}, {1.4, 2.5, -37}, 60);
    add_camera(scene_, "road", {0.1, 1.5, -46}, {0.6, 2.3, -80}, 50);
    add_camera(scene_, "roof", {-3, 11.5, -14}, {0.5, 0, -50}, 60);
    return std::move(scene_);
  }

 private:
  static float house_z(int house) { return -(house + 0.5f) * house_m; }

  void add_house(int house, int side) {
    // The right side faces -x; the left is the same, turned by 180 degrees.
    const glm::dmat4 matrix = placed({0, 0, house_z(house)}, side > 0 ? 0 : 180);
    const int kind = int(random_.next() % facades_.size()), shop = int(random_.next() % neon.size());
    add_instance(scene_, "facade", facades_[kind], matrix);
    add_instance(scene_, "house trim", trims_[kind % 2], matrix);
    add_instance(scene_, "shop inside", inside_, matrix);
    add_instance(scene_, "shop window", window_, matrix);
    add_instance(scene_, "sign", signs_[shop], matrix);
    const int windows = 2 * (kind % 2) + int(random_.next() >> 63);
    add_instance(scene_, "lit windows", lit_windows_[windows], matrix);
    add_instance(scene_, "dark windows", dark_windows_[windows], matrix);

    const auto at = [&](float out, float height, float along) {
      return glm::vec3(matrix * glm::dvec4(front_x_m + out, height, along, 1));
    };
    const glm::vec3 shop_color = glm::mix(sodium, neon[shop], 0.3f);
    for (const float along : {-2.1f, 1.2f})
      add_point(scene_, "shop", at(1.2f, 2.6f, along), shop_color, 5, 5);
    add_point(scene_, "sign", at(-0.55f, 3.75f, -1.6f), neon[shop], 2.4f, 5);
    add_point(scene_, "sign", at(-0.55f, 3.75f, 0.9f), neon[shop], 2.4f, 5);
    add_point(scene_, "door", at(-0.4f, 2.6f, 3.6f), sodium, 1.2f, 3.5f);
  }

  void add_lamp_post(int i, int side) {
    const float z = -(i + 0.5f) * lamp_spacing_m - (side > 0 ? lamp_spacing_m / 2 : 0);
    const glm::vec3 lamp(side * (kerb_x_m - 0.6f), 5.6f, z);
    add_instance(scene_, "lamp post", post_, placed({side * (kerb_x_m + 0.5), 0, z}, side > 0 ? 0 : 180));
    add_lamp(scene_, "lamp", lamp_, placed(lamp));
    // Half-angles 30 to 60 degrees; one post in nine is a flood light past 60.
    const bool flood = i % 9 == 4 && side > 0;
    const float outer = flood ? 72.f : 30.f + 30.f * random_.uniform();
    add_spot(scene_, "lamp post", lamp, lamp - glm::vec3(side * 1.6f, 5, 0), sodium, flood ? 120.f : 170.f,
             14, 0.6f * outer, outer);
    add_point(scene_, "lamp glow", lamp + glm::vec3(0, 0.25f, 0), sodium, 2.5f, 4);
  }

  void add_car(int i) {
    const int side = i % 2 ? 1 : -1;
    const float z = -12 - 340.f * (i + 0.7f * random_.uniform()) / cars;
    const double x = side * 1.9;
    // Right-hand traffic: cars on the right (x > 0) drive away, along -z.
    const glm::dmat4 matrix = placed({x, 0, z}, side > 0 ? 0 : 180);
    add_instance(scene_, "car", cars_[random_.next() % cars_.size()], matrix);
    add_instance(scene_, "car glass", car_glass_, matrix);
    add_instance(scene_, "car wheels", car_wheels_, matrix);
    add_lamp(scene_, "head lamps", car_heads_, matrix);
    add_lamp(scene_, "tail lamps", car_tails_, matrix);
    for (const float across : {-0.6f, 0.6f}) {
      const glm::vec3 nose(float(x) + across, 0.62f, z - side * 2.15f),
          back(float(x) + across, 0.7f, z + side * 2.25f);
      add_spot(scene_, "head lamp", nose, nose + glm::vec3(0, -0.09f, -side), head, 45, 14, 10, 24);
      add_point(scene_, "tail lamp", back, tail, 0.6f, 2.4f);
    }
  }

  // Strings of coloured bulbs across the street, every 24 m.
  void add_garlands() {
    for (int i = 0; i < 14; ++i) {
      const float z = -18 - 24.f * i;
      add_instance(scene_, "wire", wire_, placed({0, 0, z}));
      for (int bulb = 0; bulb < 9; ++bulb) {
        const float t = (bulb + 0.5f) / 9 * 2 - 1;
        const glm::vec3 at(t * front_x_m, garland_height_m(t) - 0.08f, z);
        const int color = (bulb + i) % int(neon.size());
        add_lamp(scene_, "bulb", bulbs_[color], placed(at));
        add_point(scene_, "bulb", at, neon[color], 1.6f, 4.5f);
      }
    }
  }

  void add_moon() {
    Light& moon = scene_.lights.emplace_back();
    moon.name = "moon";
    moon.type = LightType::directional;
    moon.direction = glm::normalize(glm::vec3(0.45f, -0.75f, -0.4f));
    moon.color = {0.55f, 0.68f, 1};
    moon.intensity = 0.3f;
  }

  Scene scene_;
  Random random_{17};
  const street::Materials m_ = street::add_materials(scene_);
  const std::vector<int> facades_ = added(street::facades(m_)), cars_ = added(car_bodies(m_)),
                         signs_ = added(sign_meshes(m_)), bulbs_ = added(bulb_meshes(m_)),
                         lit_windows_ = added(lit_windows(m_)), dark_windows_ = added(dark_windows(m_)),
                         trims_ = added(house_trims(m_));
  const int inside_ = add_mesh(scene_, shop_inside(m_)), window_ = add_mesh(scene_, shop_window(m_)),
            post_ = add_mesh(scene_, lamp_post(m_)), lamp_ = add_mesh(scene_, lamp_head(m_)),
            car_glass_ = add_mesh(scene_, car_glass(m_)), car_wheels_ = add_mesh(scene_, car_wheels(m_)),
            car_heads_ = add_mesh(scene_, car_lamps(m_, true)),
            car_tails_ = add_mesh(scene_, car_lamps(m_, false)), wire_ = add_mesh(scene_, garland_wire(m_));

  std::vector<int> added(std::vector<Mesh> meshes) {
    std::vector<int> indices;
    for (Mesh& mesh : meshes) indices.push_back(add_mesh(scene_, std::move(mesh)));
    return indices;
  }
};

}  // namespace

Scene make_street() { return Street().make(); }

}  // namespace lightgrid
