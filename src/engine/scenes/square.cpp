// A square at night, 54 by 72 m, and a street that crosses it: cafes under parasols, trees, hedges, strings
// of bulbs overhead, setts underfoot. 2.8 million triangles, nearly all in instances of a few dozen meshes,
// and 300 lights: the kind of scene on which forward, deferred and Forward+ are compared. What is far from
// the square's first camera has fewer triangles; the half of the street behind it, which has a camera of its
// own, has most.
#include "scenes/square_parts.h"

#include <algorithm>
#include <array>
#include <utility>

#include "scene/random.h"
#include "scenes/builtin.h"
#include "scenes/compose.h"
#include "scenes/shapes.h"

namespace lightgrid {
namespace {

using namespace square;

constexpr double side_x_m = 27, end_z_m = 36, street_x_m = 9, street_end_m = 128;
constexpr glm::vec3 lantern_light(1, 0.66f, 0.34f), candle_light(1, 0.52f, 0.2f),
    pool_light(0.35f, 0.85f, 0.95f);
constexpr glm::dvec3 first_eye(-9.3, 1.75, 30), first_target(-2.5, 3.1, 0);

class Square {
 public:
  Scene make() {
    scene_.name = "square";
    scene_.ambient = glm::vec3(0.022f, 0.027f, 0.045f);
    scene_.background = glm::vec3(0.007f, 0.011f, 0.028f);
    add_ground();
    add_houses();
    add_trees();
    add_hedges();
    add_terraces();
    add_lanterns();
    add_fountain();
    add_strings();
    add_camera(scene_, "square", first_eye, first_target, 60);
    add_camera(scene_, "terrace", {-25.6, 1.6, 29}, {-19.5, 1.5, 9}, 60);
    add_camera(scene_, "roofs", {24, 13, 33}, {-6, 0, -10}, 60);
    add_camera(scene_, "street", {0.5, 1.7, 38}, {-0.5, 3, 80}, 50);
    return std::move(scene_);
  }

 private:
  // Returns whether a place has fine meshes.
  bool is_near(glm::dvec3 at, double metres) const {
    return at.z > first_eye.z + 1 || glm::distance(at, first_eye) < metres;
  }
  void add(const char* name, int mesh, glm::dvec3 at, double degrees = 0, double scale = 1) {
    add_instance(scene_, name, mesh, placed(at, degrees, scale));
  }
  double any_turn() { return double(random_.uniform(0, 360)); }
  double jitter(float metres) { return double(random_.uniform(-metres, metres)); }

  void add_ground() {
    // The square between the pavements: 16 by 28 patches.
    constexpr int columns = 16, rows = 28;
    for (int column = 0; column < columns; ++column) {
      for (int row = 0; row < rows; ++row) {
        const glm::dvec3 at((column - columns / 2) * patch_m, 0, -end_z_m + row * patch_m);
        add("setts", is_near(at + glm::dvec3(1.2, 0, 1.2), 12) ? setts_ : flat_setts_, at);
      }
    }
    const int paving = add_mesh(scene_, pavement({-side_x_m, -19.2, -end_z_m, end_z_m}));
    add_instance(scene_, "pavement", paving);
    add_instance(scene_, "pavement", add_mesh(scene_, pavement({19.2, side_x_m, -end_z_m, end_z_m})));
    for (const double side : {-1.0, 1.0}) {
      const double turn = side > 0 ? 0 : 180;
      for (int i = 0; i < 60; ++i) add("kerb", kerb_, {side * 19.2, 0, -35.4 + 1.2 * i}, turn);
      for (int i = 0; i < 26; ++i) add("bollard", bollard_, {side * 18.3, 0, -33 + 2.6 * i});
      const double low = side > 0 ? 5 : -street_x_m, high = side > 0 ? street_x_m : -5;
      for (const double end : {-1.0, 1.0}) {
        const double z = end * end_z_m, far = end * street_end_m;
        add_instance(scene_, "pavement",
                     add_mesh(scene_, pavement({low, high, std::min(z, far), std::max(z, far)})));
        for (int i = 0; i < 76; ++i) add("kerb", kerb_, {side * 5, 0, end * (end_z_m + 0.6 + 1.2 * i)}, turn);
      }
    }
    for (const double end : {-1.0, 1.0}) {
      Mesh road;
      const float z0 = end < 0 ? -end_z_m : street_end_m;
      shapes::add_quad(road, {-5, -0.006f, z0}, {10, 0, 0}, {0, 0, end_z_m - street_end_m}, 5, 46);
      add_instance(scene_, "road", add_mesh(scene_, shapes::finished(std::move(road), "road", s_.asphalt)));
    }
  }

  Mesh pavement(std::array<double, 4> x_and_z) const {
    Mesh mesh;
    const auto [x0, x1, z0, z1] = x_and_z;
    shapes::add_quad(mesh, {x0, 0.14, z1}, {x1 - x0, 0, 0}, {0, 0, z0 - z1}, 2, 12);
    return shapes::finished(std::move(mesh), "pavement", s_.paving);
  }

  void add_houses() {
    const double front = street::front_x_m, wide = street::house_m;
    for (int i = 0; i < 8; ++i) {
      add_house({-side_x_m + front, 0, -31.5 + wide * i}, 180);
      add_house({side_x_m - front, 0, -31.5 + wide * i}, 0);
    }
    for (const double end : {-1.0, 1.0}) {
      const double turn = end < 0 ? 90 : 270;
      for (const double x : {-22.5, -13.5, 13.5, 22.5}) add_house({x, 0, end * (end_z_m - front)}, turn);
      for (int i = 0; i < 9; ++i) {
        const double z = end * (48.5 + wide * i);
        add_house({-street_x_m + front, 0, z}, 180);
        add_house({street_x_m - front, 0, z}, 0);
      }
      for (const double x : {-4.5, 4.5}) add_house({x, 0, end * (street_end_m - front)}, turn);
    }
  }

  void add_house(glm::dvec3 at, double degrees) {
    const int number = houses_++, kind = int(random_.next() % 4),
              shop = int(random_.next() % street::neon.size());
    const int lit = 2 * (kind % 2) + int(random_.next() >> 63);
    const glm::dmat4 matrix = placed(at, degrees);
    const auto put = [&](const char* name, int mesh) { add_instance(scene_, name, mesh, matrix); };
    put("facade", facades_[kind]);
    put("house body", bodies_[kind]);
    put("roof", roofs_[kind]);
    put("chimneys", chimneys_[kind]);
    put("house trim", trims_[kind % 2]);
    put("shop inside", inside_);
    put("shop window", window_);
    put("sign", signs_[shop]);
    put("lit windows", lit_windows_[lit]);
    put("dark windows", dark_windows_[lit]);
    for (const street::Rectangle& w : street::windows(kind)) {
      const glm::dmat4 sill = matrix * placed({0, w.y0, (w.z0 + w.z1) / 2});
      add_instance(scene_, "railing", is_near(at, 30) ? railing_ : far_railing_, sill);
      if (random_.uniform() < 0.4f)
        add_instance(scene_, "flowers", flowers_[random_.next() % 2],
                     sill * placed({street::front_x_m - 0.3, 0, 0}));
    }
    if (number % 3 == 1) put("ivy", ivy_[number % 2]);
    const auto in_world = [&](double out, double high, double along) {
      return glm::vec3(matrix * glm::dvec4(street::front_x_m + out, high, along, 1));
    };
    add_point(scene_, "shop", in_world(0.9, 2.5, -0.5), glm::mix(lantern_light, street::neon[shop], 0.25f),
              15, 7.5f);
    if (number % 2 == 0) add_point(scene_, "sign", in_world(-0.6, 3.7, -0.4), street::neon[shop], 4, 6);
  }

  void add_tree(glm::dvec3 at) {
    const double turn = any_turn(), scale = 0.9 + 0.25 * random_.uniform();
    const size_t kind = random_.next() % 2;
    add("trunk", trunk_, at, turn, scale);
    add("crown",
        (is_near(at, 16)   ? near_crowns_
         : at.z > -end_z_m ? crowns_
                           : far_crowns_)[kind],
        at, turn, scale);
  }

  void add_trees() {
    for (const double side : {-1.0, 1.0}) {
      for (int i = 0; i < 8; ++i) add_tree({side * 14.5, 0, -34.5 + 9.4 * i});
      for (int i = 0; i < 9; ++i) {
        for (const double end : {-1.0, 1.0}) add_tree({side * 6.4, 0.14, end * (46 + 9.0 * i)});
      }
    }
  }

  void add_hedge(glm::dvec3 at, double degrees) {
    const int kind = int(random_.next() % 2);
    add("hedge",
        (is_near(at, 12)   ? near_hedges_
         : is_near(at, 34) ? hedges_
                           : far_hedges_)[kind],
        at, degrees);
    add("hedge core", hedge_core_, at, degrees);
    add("hedge box", hedge_box_, at, degrees);
  }

  void add_hedges() {
    for (const double side : {-1.0, 1.0}) {
      for (int i = 0; i < 42; ++i) {
        if (i % 5 < 4) add_hedge({side * 19.9, 0.14, -33.5 + 1.7 * i}, 0);
        add_hedge({side * 5.5, 0.14, 41 + 2.0 * i}, 0);
      }
      // Beds beside the fountain.
      for (int i = 0; i < 6; ++i) {
        add_hedge({side * 8.2, 0, -11.2 + 1.7 * i}, 0);
        add_hedge({-4.3 + 1.7 * i, 0, -6.9 + side * 8.2}, 90);
      }
    }
  }

  // A table, its chairs, and what stands on it.
  void add_table(glm::dvec3 at, int number) {
    const bool fine = is_near(at, 21);
    at += glm::dvec3(jitter(0.2f), 0, jitter(0.2f));
    add("table", fine ? table_ : far_table_, at, any_turn());
    if (fine) add("crockery", crockery_, at + glm::dvec3(0, table_m, 0), any_turn());
    const double first = any_turn();
    const int chairs = 2 + int(random_.next() % 3);
    for (int i = 0; i < chairs; ++i) {
      const double turn = first + 360.0 * i / chairs + jitter(14);
      const glm::dmat4 place = placed(at, turn) * placed({0, 0, -0.68 + jitter(0.08f)});
      add_instance(scene_, "chair", fine ? chair_ : far_chair_, place);
    }
    if (number % 2 == 0) {
      add_lamp(scene_, "candle", bulb_, placed(at + glm::dvec3(0.04, table_m + 0.1, -0.05), 0, 1.4));
      add_point(scene_, "candle", at + glm::dvec3(0.04, table_m + 0.12, -0.05), candle_light, 0.6f, 2.5f);
    }
  }

  void add_parasol(glm::dvec3 at) {
    const double turn = any_turn();
    add("parasol", parasols_[random_.next() % 3], at, turn);
    add("parasol pole", parasol_pole_, at, turn);
    add_lamp(scene_, "parasol lamp", bulb_, placed(at + glm::dvec3(0.12, parasol_lamp_m, 0), 0, 2));
    add_point(scene_, "parasol lamp", at + glm::dvec3(0.12, parasol_lamp_m, 0), lantern_light, 4, 5);
  }

  void add_terraces() {
    int number = 0;
    for (int i = 0; i < 23; ++i) {
      const double z = -33 + 3 * i;
      for (const double x : {-24.6, -22.1}) add_table({x, 0.14, z}, number++);
      if (i % 2) add_parasol({-23.3, 0.14, z - 1.4});
    }
    for (int i = 0; i < 17; ++i) {
      const double z = -33 + 4 * i;
      add_table({22.6, 0.14, z}, number++);
      if (i % 2) add_parasol({23.9, 0.14, z - 1.6});
    }
    for (const double x : {-17.0, -13.5, -10.0, 10.0, 13.5, 17.0}) add_table({x, 0, 32.6}, number++);
    for (const double x : {-11.8, 11.8}) add_parasol({x, 0, 33});
    for (int i = 0; i < 20; ++i) add_table({i % 2 ? 7.4 : -7.4, 0.14, 44 + 2.2 * i}, 1);
    // On the setts, on both sides of the first camera's way.
    for (int i = 0; i < 6; ++i) {
      for (const double x : {-18.0, -15.6, -4.3, -1.6, 1.1}) add_table({x, 0, 9 + 2.9 * i}, number++);
      if (i % 2 == 0) {
        add_parasol({-16.8, 0, 10.4 + 2.9 * i});
        add_parasol({-2.9, 0, 10.4 + 2.9 * i});
      }
    }
    for (const double side : {-1.0, 1.0}) {
      for (int i = 0; i < 6; ++i) add("bench", bench_, {side * 11.6, 0, -27 + 9.4 * i}, side > 0 ? 0 : 180);
    }
  }

  void add_lantern(glm::dvec3 at) {
    add("lantern post", is_near(at, 45) ? lantern_post_ : far_lantern_post_, at);
    add_lamp(scene_, "lantern", lantern_, placed(at));
    const glm::vec3 lamp = glm::vec3(at) + glm::vec3(0, lantern_height_m, 0);
    add_spot(scene_, "lantern", lamp, lamp - glm::vec3(0, 1, 0), lantern_light, 80, 13, 42, 68);
    add_point(scene_, "lantern glow", lamp, lantern_light, 9, 6.5f);
  }

  void add_lanterns() {
    for (const double side : {-1.0, 1.0}) {
      for (int i = 0; i < 7; ++i) add_lantern({side * 11.2, 0, -29.8 + 9.4 * i});
      for (int i = 0; i < 4; ++i) {
        for (const double end : {-1.0, 1.0}) add_lantern({side * 5.7, 0.14, end * (42 + 22.0 * i)});
      }
    }
  }

  void add_fountain() {
    const glm::dvec3 at(0, 0, -7);
    add("fountain", fountain_, at);
    add("water", water_, at);
    for (int i = 0; i < 8; ++i) {
      const glm::dvec3 place = glm::dvec3(placed(at, 45.0 * i) * glm::dvec4(2.2, 0.75, 0, 1));
      add_point(scene_, "pool", place, pool_light, 5, 6);
    }
  }

  // Strings of bulbs from side to side; what is left of the 300 lights hangs there.
  void add_strings() {
    constexpr int strings = 8, lights = 300;
    const int rest = lights - int(scene_.lights.size());
    for (int i = 0; i < strings; ++i) {
      const float z = -34 + 9.4f * i, across = i % 2 ? 3.f : -3.f;
      const glm::vec3 from(-side_x_m, 8.2f, z - across), to(side_x_m, 8.2f, z + across);
      Mesh wire, bulbs;
      add_tube(wire, sagging(from, to, 2.4f, 48), 0.012f, 5);
      const int here = rest * (i + 1) / strings - rest * i / strings;
      const auto line = sagging(from, to, 2.4f, 12 * (here + 1));
      for (size_t k = 1; k + 1 < line.size(); ++k) {
        if (k % 12) {
          shapes::add_sphere(bulbs, line[k] - glm::vec3(0, 0.05f, 0), 0.03f, 2);
          continue;
        }
        const glm::vec3 at = line[k] - glm::vec3(0, 0.11f, 0),
                        color = street::neon[(k / 12 + i) % street::neon.size()];
        add_lamp(scene_, "bulb", bulbs_[(k / 12 + i) % street::neon.size()], placed(at));
        add_point(scene_, "bulb", at, color, 7, 7.5f);
      }
      add_instance(scene_, "wire", add_mesh(scene_, shapes::finished(std::move(wire), "wire", s_.iron)));
      add_instance(scene_, "small bulbs",
                   add_mesh(scene_, shapes::finished(std::move(bulbs), "bulbs", m_.bulb)));
    }
    // Wires without lights along the street.
    for (int i = 0; i < 10; ++i) {
      Mesh wire;
      const float z = (i % 2 ? 40 : -40) + (i % 2 ? 8.4f : -8.4f) * i;
      add_tube(wire, sagging({-9, 7.5f, z}, {9, 7.2f, z - 2}, 0.5f, 16), 0.012f, 4);
      add_instance(scene_, "wire", add_mesh(scene_, shapes::finished(std::move(wire), "wire", s_.iron)));
    }
  }

  std::vector<int> added(std::vector<Mesh> meshes) {
    std::vector<int> indices;
    for (Mesh& mesh : meshes) indices.push_back(add_mesh(scene_, std::move(mesh)));
    return indices;
  }
  int added(Mesh mesh) { return add_mesh(scene_, std::move(mesh)); }
  Mesh small_bulb() const {
    Mesh mesh;
    shapes::add_sphere(mesh, glm::vec3(0), 0.035f, 3);
    return shapes::finished(std::move(mesh), "small bulb", m_.bulb);
  }

  Scene scene_;
  Random random_{23};
  int houses_ = 0;
  const street::Materials s_ = street::add_materials(scene_);
  const square::Materials m_ = square::add_materials(scene_);
  const std::vector<int> facades_ = added(street::facades(s_)), signs_ = added(street::sign_meshes(s_)),
                         lit_windows_ = added(street::lit_windows(s_)),
                         dark_windows_ = added(street::dark_windows(s_)),
                         trims_ = added(street::house_trims(s_)), bulbs_ = added(street::bulb_meshes(s_)),
                         bodies_ = added({body(s_, 0), body(s_, 1), body(s_, 2), body(s_, 3)}),
                         roofs_ = added({roof(m_, 0), roof(m_, 1), roof(m_, 2), roof(m_, 3)}),
                         chimneys_ =
                             added({chimneys(s_, 0), chimneys(s_, 1), chimneys(s_, 2), chimneys(s_, 3)}),
                         near_crowns_ = added({crown(m_, 21400, 0.115f, 1), crown(m_, 21400, 0.115f, 2)}),
                         crowns_ = added({crown(m_, 3400, 0.27f, 1), crown(m_, 3400, 0.27f, 2)}),
                         far_crowns_ = added({crown(m_, 1500, 0.43f, 1), crown(m_, 1500, 0.43f, 2)}),
                         near_hedges_ = added({hedge(m_, 3400, 0.065f, 3), hedge(m_, 3400, 0.065f, 4)}),
                         hedges_ = added({hedge(m_, 800, 0.13f, 3), hedge(m_, 800, 0.13f, 4)}),
                         far_hedges_ = added({hedge(m_, 240, 0.22f, 3), hedge(m_, 240, 0.22f, 4)}),
                         ivy_ = added({ivy(m_, 5), ivy(m_, 6)}),
                         flowers_ = added({flowers(m_, 7), flowers(m_, 8)}),
                         parasols_ =
                             added({parasol_canopy(m_, 0), parasol_canopy(m_, 1), parasol_canopy(m_, 2)});
  const int inside_ = added(street::shop_inside(s_)), window_ = added(street::shop_window(s_)),
            setts_ = added(setts(m_)), flat_setts_ = added(flat_setts(m_, 1, 1)), kerb_ = added(kerb(m_)),
            bollard_ = added(bollard(s_)), railing_ = added(railing(s_, true)),
            far_railing_ = added(railing(s_, false)), trunk_ = added(trunk(m_)),
            hedge_core_ = added(hedge_core(m_)), hedge_box_ = added(hedge_box(m_)),
            table_ = added(table(m_, true)), far_table_ = added(table(m_, false)),
            crockery_ = added(crockery(m_)), chair_ = added(chair(m_, true)),
            far_chair_ = added(chair(m_, false)), parasol_pole_ = added(parasol_pole(s_)),
            lantern_post_ = added(lantern_post(s_, true)), far_lantern_post_ = added(lantern_post(s_, false)),
            lantern_ = added(lantern(s_)), bench_ = added(bench(m_)), fountain_ = added(fountain(s_)),
            water_ = added(fountain_water(m_)), bulb_ = added(small_bulb());
};

}  // namespace

Scene make_square() { return Square().make(); }

}  // namespace lightgrid
