// The hall: placement of its parts, and its lights. Warm light along the nave; one aisle cool, the other
// rose.
#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/builtin.h"
#include "scenes/compose.h"
#include "scenes/hall_parts.h"
#include "scenes/shapes.h"

namespace lightgrid {
namespace {

using namespace hall;

constexpr glm::vec3 warm(1, 0.62f, 0.28f), rose(1, 0.36f, 0.40f), violet(0.62f, 0.38f, 1),
    blue(0.30f, 0.55f, 1), teal(0.22f, 0.85f, 0.72f), candle(1, 0.70f, 0.38f);

class Hall {
 public:
  Scene make() {
    scene_.name = "hall";
    scene_.ambient = glm::vec3(0.030f, 0.032f, 0.045f);
    add_shell();
    add_bays();
    add_columns();
    add_chandeliers();
    add_candles();
    add_sconces();
    add_lanterns();
    add_cornice_lights();
    add_apse();
    add_balcony();
    add_key_lights();
    const WorldBox box = world_box(scene_);
    place("backing", backing(m_, glm::vec3(box.min) - 0.05f, glm::vec3(box.max) + 0.05f));
    add_camera(scene_, "entrance", {-0.9, 1.75, 11.6}, {0.35, 3.05, -6}, 62);
    add_camera(scene_, "aisle", {4.7, 1.75, 10.4}, {2.3, 2.45, -1}, 62);
    add_camera(scene_, "balcony", {1.1, 6.1, 13.4}, {-0.4, 2.9, -6}, 60);
    return std::move(scene_);
  }

 private:
  void place(const char* name, Mesh mesh, const glm::dmat4& matrix = glm::dmat4(1)) {
    add_instance(scene_, name, add_mesh(scene_, std::move(mesh)), matrix);
  }

  static float bay_z(int bay) { return half_length_m - bay_m * (bay + 0.5f); }
  static glm::dmat4 bay_side(int bay, int side) { return placed({0, 0, bay_z(bay)}, side > 0 ? 0 : 180); }

  void add_shell() {
    place("floor", floor_slab(m_));
    place("carpet", carpet(m_));
    place("vault", vault(m_));
    place("end walls", end_walls(m_));
    place("apse", apse(m_));
    place("dais", dais(m_));
    place("rose window", rose_window(m_));
    place("door", door(m_));
    const int rib_mesh = add_mesh(scene_, rib(m_));
    for (int i = 0; i <= bays; ++i)
      add_instance(scene_, "rib", rib_mesh, placed({0, 0, half_length_m - bay_m * i}));
  }

  void add_bays() {
    const std::array parts = {add_mesh(scene_, bay_stone(m_)), add_mesh(scene_, bay_brick(m_)),
                              add_mesh(scene_, bay_trim(m_)), add_mesh(scene_, bay_wood(m_))};
    const int tympanum = add_mesh(scene_, bay_tympanum(m_)), vitrine = add_mesh(scene_, bay_vitrine(m_));
    const int gate = add_mesh(scene_, bay_lattice(m_)), gate_frame = add_mesh(scene_, bay_lattice_frame(m_));
    const std::array urns = {add_mesh(scene_, urn(m_.porcelain)), add_mesh(scene_, urn(m_.gold)),
                             add_mesh(scene_, urn(m_.jade)), add_mesh(scene_, urn(m_.bronze))};
    const int screen = add_mesh(scene_, screen_glass(m_)), screen_bars = add_mesh(scene_, screen_frame(m_));
    for (int bay = 0; bay < bays; ++bay) {
      for (const int side : {-1, 1}) {
        if (bay % 2 == 1 && (bay > 1 || side < 0)) {
          const glm::dmat4 stand = placed({side * 4.95, 0, bay_z(bay) - bay_m / 2}, side * 12);
          add_instance(scene_, "screen", screen, stand);
          add_instance(scene_, "screen frame", screen_bars, stand);
        }
        const glm::dmat4 matrix = bay_side(bay, side);
        for (const int part : parts) add_instance(scene_, "bay", part, matrix);
        add_instance(scene_, "urn", urns[(bay + (side > 0)) % 4],
                     placed({side * 6.4, 0.95, bay_z(bay)}, 0, 1.35));
        const bool glazed = bay % 3 == 1, gated = bay == 3 || bay == 6;
        if (glazed) add_instance(scene_, "stained glass", tympanum, matrix);
        if (bay % 2 == 0) add_instance(scene_, "vitrine", vitrine, matrix);
        if (gated) {
          add_instance(scene_, "gate", gate, matrix);
          add_instance(scene_, "gate frame", gate_frame, matrix);
        }
        add_point(scene_, "niche", {side * 6.15f, 2.75f, bay_z(bay)}, aisle_color(bay, side), 1.1f, 2.8f);
        add_point(scene_, "niche foot", {side * 6.0f, 1.1f, bay_z(bay) + 0.55f}, candle, 0.3f, 1.8f);
      }
    }
  }

  // From teal by the entrance to violet by the dais on the left, from warm to rose on the right.
  static glm::vec3 aisle_color(int bay, int side) {
    const float far = float(bay) / (bays - 1);
    return side < 0
               ? glm::mix(glm::mix(teal, blue, std::min(2 * far, 1.f)), violet, std::max(2 * far - 1, 0.f))
               : glm::mix(warm, rose, far);
  }
  int aisle_lamp(int bay, int side) const {
    return side < 0 ? (bay < 3   ? m_.lamp_teal
                       : bay < 6 ? m_.lamp_blue
                                 : m_.lamp_violet)
                    : (bay < 4 ? m_.lamp_warm : m_.lamp_rose);
  }

  void add_columns() {
    const std::array parts = {add_mesh(scene_, column_shaft(m_)), add_mesh(scene_, column_stone(m_)),
                              add_mesh(scene_, column_rings(m_))};
    for (int i = 0; i <= bays; ++i) {
      for (const int side : {-1, 1}) {
        for (const int part : parts) {
          add_instance(scene_, "column", part,
                       placed({side * column_x_m, 0, half_length_m - bay_m * i}, 37.0 * i));
        }
      }
    }
  }

  void add_chandeliers() {
    const int frame = add_mesh(scene_, chandelier(m_)),
              flame = add_mesh(scene_, lamp_globe(m_.lamp_warm, 0.05f));
    const auto spokes = shapes::arc(glm::vec3(0), {1, 0, 0}, {0, 0, 1}, 0, 2 * glm::pi<float>(), 12);
    for (const float z : {5.625f, -1.875f, -9.375f}) {
      const glm::vec3 center(0, 6.1f, z);
      add_instance(scene_, "chandelier", frame, placed(center));
      for (int i = 0; i < 12; ++i) {
        const glm::vec3 at = center + spokes[i] * 1.15f + glm::vec3(0, 0.25f, 0);
        add_lamp(scene_, "candle", flame, placed(at));
        add_point(scene_, "chandelier", at, candle, 1.2f, 4);
      }
    }
  }

  void add_candles() {
    const int stand = add_mesh(scene_, candle_stand(m_));
    const int flame = add_mesh(scene_, lamp_globe(m_.lamp_warm, 0.055f));
    for (int i = 0; i < 21; ++i) {
      for (const float x : {-1.3f, 1.3f}) {
        const glm::vec3 at(x, 0.38f, 12 - 1.1f * i);
        add_instance(scene_, "candle stand", stand, placed({at.x, 0, at.z}));
        add_lamp(scene_, "candle", flame, placed(at));
        add_point(scene_, "floor candle", at + glm::vec3(0, 0.08f, 0), glm::mix(candle, rose, i / 30.f), 0.4f,
                  2.2f);
      }
    }
  }

  // On each column one lamp to the nave, one to the aisle, and one at its foot that shines up the shaft.
  void add_sconces() {
    const int holder = add_mesh(scene_, sconce(m_)),
              warm_globe = add_mesh(scene_, lamp_globe(m_.lamp_warm, 0.09f));
    for (int i = 1; i < bays; ++i) {
      const float z = half_length_m - bay_m * i;
      for (const int side : {-1, 1}) {
        const glm::vec3 color = aisle_color(i, side);
        const int globe = add_mesh(scene_, lamp_globe(aisle_lamp(i, side), 0.09f));
        for (const int facing : {-1, 1}) {
          const bool to_nave = facing != side;
          const glm::vec3 at(side * column_x_m + facing * 0.62f, 2.75f, z);
          add_instance(scene_, "sconce", holder, placed(at, facing > 0 ? 0 : 180));
          add_lamp(scene_, "sconce lamp", to_nave ? warm_globe : globe, placed(at + glm::vec3(0, 0.09f, 0)));
          add_point(scene_, "sconce", at + glm::vec3(0, 0.1f, 0), to_nave ? warm : color,
                    to_nave ? 1.1f : 1.3f, 3.2f);
        }
        add_point(scene_, "column foot", {side * column_x_m - side * 0.75f, 0.25f, z + 0.35f},
                  glm::mix(color, violet, 0.3f), 0.5f, 2.6f);
      }
    }
  }

  void add_lanterns() {
    const int frame = add_mesh(scene_, lantern(m_));
    for (int bay = 0; bay < bays; ++bay) {
      for (const int side : {-1, 1}) {
        const glm::vec3 at(side * 4.8f, 4.3f, bay_z(bay));
        const int globe = add_mesh(scene_, lamp_globe(aisle_lamp(bay, side), 0.1f));
        add_instance(scene_, "lantern", frame, placed(at));
        add_lamp(scene_, "lantern lamp", globe, placed(at));
        add_point(scene_, "lantern", at, aisle_color(bay, side), 4.5f, 4);
      }
    }
  }

  // Hidden behind the cornice: they light the painted vault.
  void add_cornice_lights() {
    for (int i = 0; i < 2 * bays; ++i) {
      for (const int side : {-1, 1}) {
        const float z = half_length_m - bay_m / 2 * (i + 0.5f);
        add_point(scene_, "cornice", {side * 2.5f, 7.05f, z},
                  glm::mix(blue, i % 4 < 2 ? violet : warm, 0.45f), 1.3f, 3.4f);
      }
    }
  }

  void add_apse() {
    const glm::vec3 center(0, 2.95f, -13.3f);
    place("pedestal", pedestal(m_), placed({center.x, 0.6, center.z}));
    place("armillary sphere", armillary(m_), placed(center, 0, 1.25));
    place("core", lamp_globe(m_.lamp_warm, 0.24f), placed(center));
    add_point(scene_, "core", center, {1, 0.72f, 0.4f}, 2.2f, 4);
    for (int i = 0; i < 8; ++i) {
      const float x = (i % 4 - 1.5f) * 1.0f, y = i < 4 ? 1.0f : 3.9f;
      add_point(scene_, "apse", {x, y, -15.9f}, i % 2 ? violet : warm, 2.2f, 3.2f);
    }
    for (int i = 0; i < 6; ++i) {
      const float turn = 1.0472f * i;
      const glm::vec3 at(2.0f * float(std::cos(double(turn))), 7.7f + 1.9f * float(std::sin(double(turn))),
                         -14.4f);
      add_point(scene_, "rose window", at, i % 2 ? blue : rose, 0.9f, 2.6f);
    }
    for (int i = 0; i < 6; ++i) {
      const glm::vec3 from((i % 2 ? 1.f : -1.f) * (1.2f + 0.6f * (i / 2)), 6.6f, -9.6f + 0.9f * (i / 2));
      add_spot(scene_, "armillary spot", from, center, i % 2 ? warm : glm::vec3(0.8f, 0.85f, 1), 34, 9, 8,
               15);
    }
  }

  void add_balcony() {
    place("balcony", balcony(m_));
    const int post = add_mesh(scene_, baluster(m_));
    for (int i = 0; i < 17; ++i) add_instance(scene_, "baluster", post, placed({-2.8 + 0.35 * i, 4.3, 12.6}));
    for (int i = 0; i < 6; ++i) {
      add_point(scene_, "under the balcony", {-2.5f + i, 3.5f, 13.7f}, i % 2 ? warm : rose, 0.8f, 3);
    }
  }

  // From the ribs down across the nave, onto the opposite columns and the floor in front of them.
  void add_key_lights() {
    for (int i = 1; i <= 5; ++i) {
      const float z = half_length_m - bay_m * (i + 0.5f);
      for (const int side : {-1, 1}) {
        add_spot(scene_, "key", {side * 2.1f, 8.5f, z}, {-side * 2.4f, 0.6f, z - 1.9f}, {1, 0.80f, 0.56f},
                 190, 12, 12, 24);
      }
    }
  }

  Scene scene_;
  const hall::Materials m_ = add_materials(scene_);
};

}  // namespace

Scene make_hall() { return Hall().make(); }

}  // namespace lightgrid
