// A gallery of busts in wax, marble, jade, terracotta, plaster and bronze between velvet draperies, and a
// table of balls that steps through the parameters of skin and Minnaert: the scene for materials that are not
// Lambert's.
#include <algorithm>
#include <string>
#include <vector>

#include "scenes/builtin.h"
#include "scenes/compose.h"
#include "scenes/gallery_parts.h"
#include "scenes/patterns.h"
#include "scenes/shapes.h"

namespace lightgrid {
namespace {

using namespace gallery;

constexpr float gallery_half_width = 4.2f, gallery_height = 4.6f, gallery_front = 8.5f, gallery_back = -12.5f;
constexpr float plinth_height = 1.02f;
constexpr glm::vec3 lamp_warm(1, 0.72f, 0.42f), lamp_rose(1, 0.38f, 0.36f), lamp_blue(0.32f, 0.52f, 1),
    lamp_teal(0.25f, 0.85f, 0.78f), lamp_violet(0.66f, 0.42f, 1), lamp_white(1, 0.93f, 0.84f);

Bitmap parquet_bitmap() {
  using namespace patterns;
  const int size = 256;
  const Field grain = noise(size, 4, 48, 4, 71);
  return color_bitmap("parquet", size, [=](int x, int y) {
    const Cell cell = cell_at(x, y, size, 2, 8, true);
    const float tone =
        (0.7f + 0.5f * cell.random) * (0.6f + 0.7f * grain.at(x, y)) * step_between(-0.5f, 2, cell.edge_px);
    return glm::vec4(glm::vec3(0.23f, 0.115f, 0.052f) * tone, 1);
  });
}

class Gallery {
 public:
  Scene make() {
    scene_.name = "gallery";
    scene_.ambient = glm::vec3(0.045f, 0.045f, 0.055f);
    add_materials();
    add_room();
    add_draperies();
    add_busts();
    add_samples();
    add_room_lights();
    add_camera(scene_, "entrance", {-0.35, 1.72, 6.1}, {0.12, 1.36, 0}, 44);
    add_camera(scene_, "samples", {0.9, 1.75, 2.7}, {-0.05, 0.92, -0.9}, 40);
    add_camera(scene_, "gallery", {3.3, 3.4, 7.6}, {-0.9, 1.0, -4}, 58);
    return std::move(scene_);
  }

 private:
  int skin(const char* name, glm::vec3 color, float roughness, glm::vec3 subsurface, float roll_off) {
    const int material = add_material(scene_, name, color, 0, roughness);
    scene_.materials[size_t(material)].model = {.subsurface_color = subsurface, .roll_off = roll_off};
    return material;
  }
  int minnaert(const char* name, glm::vec3 color, float roughness, float k) {
    const int material = add_material(scene_, name, color, 0, roughness);
    scene_.materials[size_t(material)].model.minnaert_k = k;
    return material;
  }

  void place(const char* name, Mesh mesh, const glm::dmat4& matrix = glm::dmat4(1)) {
    add_instance(scene_, name, add_mesh(scene_, std::move(mesh)), matrix);
  }

  void add_materials() {
    skin_ = skin("skin", {0.56f, 0.36f, 0.27f}, 0.45f, {0.62f, 0.13f, 0.08f}, 0.35f);
    dark_skin_ = skin("dark skin", {0.20f, 0.105f, 0.065f}, 0.38f, {0.34f, 0.075f, 0.04f}, 0.3f);
    wax_ = skin("wax", {0.66f, 0.52f, 0.36f}, 0.32f, {0.55f, 0.24f, 0.08f}, 0.6f);
    marble_ = skin("marble", {0.78f, 0.76f, 0.72f}, 0.3f, {0.26f, 0.22f, 0.17f}, 0.4f);
    jade_ = skin("jade", {0.13f, 0.38f, 0.25f}, 0.4f, {0.06f, 0.42f, 0.18f}, 0.8f);
    scene_.materials[size_t(jade_)].clearcoat = 0.7f;
    scene_.materials[size_t(jade_)].clearcoat_roughness = 0.12f;
    terracotta_ = minnaert("terracotta", {0.52f, 0.25f, 0.15f}, 0.9f, 0.6f);
    plaster_ = minnaert("plaster", {0.70f, 0.69f, 0.66f}, 1, 0.75f);
    velvet_red_ = minnaert("red velvet", {0.40f, 0.022f, 0.035f}, 0.95f, 1.5f);
    velvet_blue_ = minnaert("blue velvet", {0.035f, 0.075f, 0.30f}, 0.95f, 1.5f);
    veil_ = minnaert("veil", {0.80f, 0.74f, 0.62f}, 0.8f, 0.7f);
    scene_.materials[size_t(veil_)].base_color.a = 0.34f;
    scene_.materials[size_t(veil_)].alpha_mode = AlphaMode::blend;
    for (const int cloth : {velvet_red_, velvet_blue_, veil_})
      scene_.materials[size_t(cloth)].double_sided = true;
    bronze_ = add_material(scene_, "bronze", {0.66f, 0.45f, 0.26f}, 1, 0.36f);
    porphyry_ = add_material(scene_, "porphyry", {0.15f, 0.045f, 0.05f}, 0, 0.22f);
    stone_ = add_material(scene_, "plinth stone", {0.24f, 0.235f, 0.22f}, 0, 0.55f);
    wall_ = add_material(scene_, "wall", {0.085f, 0.10f, 0.105f}, 0, 0.85f);
    gold_ = add_material(scene_, "gilding", {0.95f, 0.70f, 0.34f}, 1, 0.3f);
    floor_ = add_material(scene_, "parquet", {1, 1, 1}, 0, 0.24f);
    use_color(scene_, floor_, parquet_bitmap(), 1.6f);
    lamp_ = add_material(scene_, "lamp", {0.1f, 0.08f, 0.06f}, 0, 0.6f);
    scene_.materials[size_t(lamp_)].emissive = 6.0f * lamp_warm;
  }

  void add_room() {
    const float w = gallery_half_width, h = gallery_height, front = gallery_front, back = gallery_back;
    Mesh ground;
    shapes::add_quad(ground, {-w, 0, front}, {2 * w, 0, 0}, {0, 0, back - front}, 8, 20);
    place("floor", shapes::finished(std::move(ground), "floor", floor_));
    Mesh walls;
    shapes::add_quad(walls, {-w, 0, front}, {0, 0, back - front}, {0, h, 0}, 20, 6);
    shapes::add_quad(walls, {w, 0, back}, {0, 0, front - back}, {0, h, 0}, 20, 6);
    shapes::add_quad(walls, {-w, 0, back}, {2 * w, 0, 0}, {0, h, 0}, 8, 6);
    shapes::add_quad(walls, {w, 0, front}, {-2 * w, 0, 0}, {0, h, 0}, 8, 6);
    shapes::add_quad(walls, {-w, h, back}, {2 * w, 0, 0}, {0, 0, front - back}, 8, 20);
    place("walls", shapes::finished(std::move(walls), "walls", wall_));
    for (const float side : {-1.0f, 1.0f}) {
      const float inner = side * (w - 0.14f), outer = side * w;
      const float low = std::min(inner, outer), high = std::max(inner, outer);
      place("cornice", box(gold_, "cornice", {low, h - 0.75f, back}, {high, h - 0.6f, front}));
      place("skirting", box(gold_, "skirting", {low, 0, back}, {high, 0.1f, front}));
    }
  }

  void add_draperies() {
    const int red = add_mesh(scene_, drapery(velvet_red_, 1.5f, 3.75f, 0.27f, 0.4));
    const int blue = add_mesh(scene_, drapery(velvet_blue_, 1.5f, 3.75f, 0.27f, 2.1));
    for (int i = 0; i < 7; ++i) {
      const double z = 5.6 - 2.8 * i;
      const int cloth = i % 2 ? blue : red;
      // The front looks into the room.
      add_instance(scene_, "drapery", cloth, placed({-gallery_half_width + 0.22, 0.08, z + 0.75}, 90));
      add_instance(scene_, "drapery", cloth, placed({gallery_half_width - 0.22, 0.08, z - 0.75}, -90));
    }
    place("curtain", drapery(velvet_red_, 5.2f, 4.2f, 0.42f, 1.0), placed({-2.6, 0.05, gallery_back + 0.35}));
    const int veil = add_mesh(scene_, drapery(veil_, 1.0f, 2.7f, 0.33f, 0.2));
    add_instance(scene_, "veil", veil, placed({-2.05, 0.9, -3.6}, 18));
    add_instance(scene_, "veil", veil, placed({1.15, 0.9, -3.9}, -18));
  }

  // A lamp from the ceiling, a coloured light behind and one at the foot.
  void add_bust(int material, glm::dvec3 at, double degrees, glm::vec3 rim, glm::vec3 foot,
                double scale = 1) {
    const std::string name = scene_.materials[size_t(material)].name;
    if (bust_of_.size() <= size_t(material)) bust_of_.resize(size_t(material) + 1, -1);
    int& mesh = bust_of_[size_t(material)];
    if (mesh < 0) mesh = add_mesh(scene_, bust(material));
    if (socle_ < 0) {
      socle_ = add_mesh(scene_, socle(porphyry_));
      plinth_ = add_mesh(scene_, plinth(stone_, plinth_height));
    }
    const glm::dmat4 turned = placed({0, 0, 0}, degrees);
    const auto place_of = [&](glm::dvec3 offset) {
      return glm::vec3(at + glm::dvec3(turned * glm::dvec4(offset * scale, 1)) +
                       glm::dvec3(0, plinth_height, 0));
    };
    add_instance(scene_, "plinth", plinth_, placed(at, degrees));
    add_instance(scene_, "socle", socle_, placed(place_of({0, 0, 0}), degrees, scale));
    add_instance(scene_, name, mesh, placed(place_of({0, 0.115, 0}), degrees, scale));
    add_spot(scene_, "lamp of " + name, place_of({0.75, 1.75, 1.7}), place_of({0, 0.46, 0}), lamp_white, 19,
             4.6f, 10, 18);
    add_point(scene_, "behind " + name, place_of({-0.42, 0.72, -0.42}), rim, 0.42f, 1.3f);
    add_point(scene_, "beside " + name, place_of({0.46, 0.42, -0.10}), rim, 0.16f, 1.0f);
    add_point(scene_, "foot of " + name, place_of({-0.12, 0.05, 0.46}), foot, 0.11f, 1.1f);
    add_point(scene_, "plinth of " + name, glm::vec3(at) + glm::vec3(0, 0.16f, 0.42f), foot, 0.22f, 1.3f);
  }

  void add_busts() {
    add_bust(skin_, {-1.25, 0, 3.55}, 20, lamp_blue, lamp_warm);
    add_bust(jade_, {1.22, 0, 3.2}, -24, lamp_teal, lamp_warm);
    const int left[] = {marble_, terracotta_, wax_, bronze_, plaster_},
              right[] = {dark_skin_, marble_, plaster_, jade_, skin_};
    const glm::vec3 rims[] = {lamp_rose, lamp_blue, lamp_violet, lamp_teal, lamp_rose};
    for (int i = 0; i < 5; ++i) {
      const double z = 1.4 - 2.8 * i;
      add_bust(left[i], {-2.75, 0, z}, 52, rims[i], lamp_warm);
      add_bust(right[i], {2.75, 0, z - 0.5}, -52, rims[(i + 2) % 5], lamp_warm);
    }
    add_bust(marble_, {0, 0, -9.6}, 0, lamp_violet, lamp_rose, 1.9);
  }

  // Three rows on a table: roll-off from 0 to 1, k from 1/4 to 2, and rougher and rougher paint.
  void add_samples() {
    constexpr int columns = 7;
    constexpr float spacing = 0.27f, radius = 0.105f, top = 0.86f;
    const glm::vec3 centre(0, top, -0.9f);
    place("table", box(porphyry_, "table", centre + glm::vec3(-1.15f, -0.06f, -0.52f),
                       centre + glm::vec3(1.15f, 0, 0.52f)));
    place("table foot", box(stone_, "table foot", {centre.x - 0.85f, 0, centre.z - 0.3f},
                            {centre.x + 0.85f, top - 0.06f, centre.z + 0.3f}));
    const float roll_offs[columns] = {0, 0.15f, 0.3f, 0.45f, 0.6f, 0.8f, 1},
                ks[columns] = {0.25f, 0.5f, 0.75f, 1, 1.25f, 1.5f, 2};
    for (int i = 0; i < columns; ++i) {
      const std::string number = std::to_string(i);
      const int of_row[] = {
          skin(("sample of skin " + number).c_str(), {0.50f, 0.40f, 0.34f}, 0.5f, {0.5f, 0.12f, 0.08f},
               roll_offs[i]),
          minnaert(("sample of minnaert " + number).c_str(), {0.42f, 0.46f, 0.52f}, 0.9f, ks[i]),
          add_material(scene_, "sample of paint " + number, {0.46f, 0.36f, 0.12f}, 0,
                       0.15f + 0.14f * float(i))};
      for (int row = 0; row < 3; ++row) {
        const glm::vec3 at =
            centre + glm::vec3(spacing * float(i - columns / 2), radius, 0.32f - 0.32f * float(row));
        add_instance(scene_, "sample", add_mesh(scene_, ball(of_row[row], radius, 8)), placed(at));
      }
    }
    for (const float side : {-1.0f, 1.0f})
      add_spot(scene_, "lamp of the table", centre + glm::vec3(side * 1.5f, 2.4f, 1.5f), centre, lamp_white,
               13, 4.5f, 14, 24);
    const int globe = add_mesh(scene_, ball(lamp_, 0.035f, 5));
    for (int i = 0; i < 6; ++i) {
      const glm::vec3 at =
          centre + glm::vec3(0.42f * (float(i) - 2.5f), 0.62f + 0.05f * float(i % 2), i % 2 ? 0.42f : -0.1f);
      add_instance(scene_, "pendant", globe, placed(at));
      add_point(scene_, "pendant", at, i % 3 ? lamp_warm : lamp_rose, 0.34f, 1.7f);
    }
  }

  void add_room_lights() {
    const glm::vec3 colors[] = {lamp_warm, lamp_rose, lamp_violet, lamp_blue, lamp_teal};
    for (int i = 0; i < 24; ++i) {
      const float z = 7.6f - 0.82f * float(i);
      for (const float side : {-1.0f, 1.0f}) {
        const glm::vec3 color = colors[(i / 2 + (side > 0 ? 2 : 0)) % 5];
        add_point(scene_, "skirting", {side * 3.62f, 0.16f, z}, color, 0.20f, 1.7f);
        add_point(scene_, "cornice", {side * 3.7f, gallery_height - 0.9f, z},
                  glm::mix(color, lamp_warm, 0.5f), 0.5f, 2.2f);
      }
    }
    for (int i = 0; i < 9; ++i)
      add_point(scene_, "over the floor", {i % 2 ? 0.7f : -0.7f, 1.1f, 5.4f - 1.9f * float(i)}, colors[i % 5],
                0.5f, 2.3f);
    for (int i = 0; i < 7; ++i) {
      const float z = 5.6f - 2.8f * float(i);
      for (const float side : {-1.0f, 1.0f})
        add_spot(scene_, "wall washer", {side * 2.5f, 4.2f, z}, {side * 4.1f, 1.5f, z}, lamp_white, 5, 4.5f,
                 16, 30);
    }
    for (int i = 0; i < 9; ++i) {
      add_point(scene_, "curtain", {-2.4f + 0.6f * float(i), i % 2 ? 0.3f : 3.4f, gallery_back + 0.95f},
                i % 3 ? lamp_rose : lamp_violet, 0.5f, 2.2f);
      add_point(scene_, "ceiling", {i % 2 ? 0.9f : -0.9f, gallery_height - 0.35f, 6.6f - 2.2f * float(i)},
                lamp_warm, 2.2f, 3.8f);
    }
  }

  Scene scene_;
  std::vector<int> bust_of_;  // by material
  int socle_ = -1, plinth_ = -1;
  int skin_, dark_skin_, wax_, marble_, jade_, terracotta_, plaster_, velvet_red_, velvet_blue_, veil_,
      bronze_, porphyry_, stone_, wall_, gold_, floor_, lamp_;
};

}  // namespace

Scene make_gallery() { return Gallery().make(); }

}  // namespace lightgrid
