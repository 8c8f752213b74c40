// Six rooms lit by light groups instead of shadows (Stone, 2009): each room's lamps light what is in the
// room, although their ranges go through its walls. A figure has lights of its own besides, and the court the
// moon.
#include <array>
#include <string>

#include "scene/light_groups.h"
#include "scene/random.h"
#include "scenes/builtin.h"
#include "scenes/compose.h"
#include "scenes/shapes.h"

namespace lightgrid {
namespace {

constexpr int columns = 3, rows = 2, lamps_of_room = 9;
constexpr float side = 6, height = 3.2f, thick = 0.12f;  // metres; a wall is two slabs, one of each room
constexpr float door_width = 1.6f, door_height = 2.3f;
constexpr int court = 5, figure_room = 1;
constexpr uint32_t figure_group = 1u << 6;

constexpr const char* room_names[columns * rows] = {"hall", "gallery", "study", "kitchen", "cellar", "court"};
constexpr std::array<glm::vec3, columns* rows> wall_colors = {
    glm::vec3(0.62f, 0.56f, 0.47f), glm::vec3(0.55f, 0.50f, 0.58f), glm::vec3(0.38f, 0.46f, 0.40f),
    glm::vec3(0.66f, 0.63f, 0.55f), glm::vec3(0.36f, 0.34f, 0.33f), glm::vec3(0.44f, 0.46f, 0.50f)};
constexpr std::array<glm::vec3, columns* rows> lamp_colors = {
    glm::vec3(1, 0.74f, 0.42f), glm::vec3(0.75f, 0.62f, 1), glm::vec3(0.45f, 0.95f, 0.62f),
    glm::vec3(1, 0.9f, 0.72f),  glm::vec3(1, 0.40f, 0.25f), glm::vec3(0.42f, 0.66f, 1)};

class Rooms {
 public:
  Scene make() {
    scene_.name = "rooms";
    scene_.ambient = glm::vec3(0.03f, 0.032f, 0.04f);
    scene_.group_names.assign(room_names, room_names + columns * rows);
    scene_.group_names.emplace_back("figure");
    lamp_ = add_material(scene_, "lamp", {0, 0, 0}, 0, 1);
    scene_.materials[size_t(lamp_)].emissive = glm::vec3(1.1f, 1, 0.9f);
    for (int room = 0; room < columns * rows; ++room) add_room(room);
    add_figure();
    add_moon();
    add_camera(scene_, "doors", {-8.4, 1.7, -2.2}, {0, 1.3, -3.2}, 62);
    add_camera(scene_, "kitchen", {-8.3, 1.8, -11.2}, {-3.5, 1.2, -3.2}, 66);
    add_camera(scene_, "court", {7.3, 1.7, -11.5}, {3.4, 1.2, -7.0}, 66);
    return std::move(scene_);
  }

 private:
  static glm::vec3 corner(int room) {
    return {-0.5f * columns * side + float(room % columns) * side, 0, -float(room / columns) * side};
  }
  static uint32_t group(int room) { return 1u << room; }

  void place(int room, const std::string& name, Mesh mesh, int material) {
    add_instance(scene_, std::string(room_names[room]) + " " + name,
                 add_mesh(scene_, shapes::finished(std::move(mesh), name, material)));
    set_groups(scene_.instances.back(), group(room));
  }

  // A slab along x (or z) from `low`, with a doorway in its middle.
  static Mesh wall(glm::vec3 low, bool along_x, bool door) {
    Mesh mesh;
    const glm::vec3 along = along_x ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
    const glm::vec3 across = along_x ? glm::vec3(0, 0, thick) : glm::vec3(thick, 0, 0);
    const auto box = [&](float from, float to, float bottom) {
      shapes::add_box(mesh, low + along * from + glm::vec3(0, bottom, 0),
                      low + along * to + across + glm::vec3(0, height, 0));
    };
    const float first = 0.5f * (side - door_width);
    if (!door) {
      box(0, side, 0);
      return mesh;
    }
    box(0, first, 0);
    box(first + door_width, side, 0);
    box(first, first + door_width, door_height);
    return mesh;
  }

  void add_room(int room) {
    const int column = room % columns, row = room / columns;
    const glm::vec3 at = corner(room), low = at - glm::vec3(0, 0, side);
    const std::string name = room_names[room];
    const int walls = add_material(scene_, name + " wall", wall_colors[size_t(room)], 0, 0.8f);
    const int floor = add_material(scene_, name + " floor", wall_colors[size_t(room)] * 0.6f, 0, 0.35f);
    place(room, "west wall", wall(low, false, column > 0), walls);
    place(room, "east wall", wall(low + glm::vec3(side - thick, 0, 0), false, column < columns - 1), walls);
    place(room, "north wall", wall(low, true, row < rows - 1), walls);
    place(room, "south wall", wall(low + glm::vec3(0, 0, side - thick), true, row > 0), walls);
    Mesh ground, ceiling;
    shapes::add_box(ground, low + glm::vec3(0, -0.2f, 0), low + glm::vec3(side, 0, side));
    place(room, "floor", std::move(ground), floor);
    if (room != court) {
      shapes::add_box(ceiling, low + glm::vec3(0, height, 0), low + glm::vec3(side, height + 0.2f, side));
      place(room, "ceiling", std::move(ceiling), walls);
    }
    add_furniture(room, at);
    add_lamps(room, at);
  }

  void add_furniture(int room, glm::vec3 at) {
    Random random(uint64_t(40 + room));
    const std::string name = room_names[room];
    const int wood = add_material(scene_, name + " wood", {0.32f, 0.19f, 0.10f}, 0, 0.5f);
    const int metal = add_material(scene_, name + " metal", lamp_colors[size_t(room)] * 0.8f, 1, 0.3f);
    Mesh table;
    const glm::vec3 top = at + glm::vec3(random.uniform(1.0f, 1.4f), 0.78f, -random.uniform(1.2f, 1.6f));
    shapes::add_box(table, top, top + glm::vec3(1.5f, 0.07f, 0.8f));
    for (const glm::vec2 leg : {glm::vec2(0.05f, 0.05f), {1.38f, 0.05f}, {0.05f, 0.68f}, {1.38f, 0.68f}})
      shapes::add_box(table, glm::vec3(top.x + leg.x, 0, top.z + leg.y),
                      glm::vec3(top.x + leg.x + 0.07f, 0.77f, top.z + leg.y + 0.07f));
    place(room, "table", std::move(table), wood);
    for (int i = 0; i < 3; ++i) {
      Mesh ball;
      const float radius = random.uniform(0.18f, 0.42f);
      const glm::vec3 centre =
          at + glm::vec3(random.uniform(3.6f, 5.3f), radius, -random.uniform(0.8f, 5.2f));
      shapes::add_sphere(ball, centre, radius, 6);
      place(room, "ball " + std::to_string(i), std::move(ball), i % 2 ? wood : metal);
    }
    if (room != 0 && room != 3) return;
    const int glass = add_material(scene_, name + " glass", {0.55f, 0.75f, 0.78f}, 0, 0.2f);
    scene_.materials[size_t(glass)].alpha_mode = AlphaMode::blend;
    scene_.materials[size_t(glass)].base_color.a = 0.35f;
    Mesh pane;
    shapes::add_box(pane, at + glm::vec3(2.6f, 0, -4.6f), at + glm::vec3(2.64f, 1.9f, -3.4f));
    place(room, "screen", std::move(pane), glass);
  }

  // Their ranges reach into the rooms beside them.
  void add_lamps(int room, glm::vec3 at) {
    Random random(uint64_t(60 + room));
    const std::string name = room_names[room];
    Mesh bulb;
    shapes::add_sphere(bulb, glm::vec3(0), 0.06f, 3);
    const int mesh = add_mesh(scene_, shapes::finished(std::move(bulb), name + " bulb", lamp_));
    for (int i = 0; i < lamps_of_room; ++i) {
      const glm::vec3 position =
          at + glm::vec3(1 + 2 * float(i % 3) + random.uniform(-0.3f, 0.3f), random.uniform(1.9f, 2.9f),
                         -1 - 2 * float(i / 3) + random.uniform(-0.3f, 0.3f));
      const glm::vec3 color = glm::mix(lamp_colors[size_t(room)], glm::vec3(1), random.uniform(0.0f, 0.3f));
      Light& light = add_point(scene_, name + " lamp " + std::to_string(i), position, color,
                               random.uniform(0.9f, 1.8f), random.uniform(3.5f, 5.5f));
      set_groups(light, group(room));
      add_lamp(scene_, name + " bulb " + std::to_string(i), mesh, placed(position));
      set_groups(scene_.instances.back(), group(room));
    }
  }

  void add_figure() {
    const int marble = add_material(scene_, "figure", {0.78f, 0.76f, 0.72f}, 0, 0.4f);
    Mesh figure;
    const glm::vec3 foot = corner(figure_room) + glm::vec3(2.9f, 0, -2.6f);
    const std::array<glm::vec2, 12> profile = {glm::vec2(0.30f, 0.001f), {0.30f, 0.25f}, {0.22f, 0.30f},
                                               {0.17f, 0.70f},           {0.23f, 1.05f}, {0.26f, 1.30f},
                                               {0.12f, 1.45f},           {0.08f, 1.52f}, {0.15f, 1.62f},
                                               {0.16f, 1.74f},           {0.10f, 1.86f}, {0.01f, 1.90f}};
    shapes::add_lathe(figure, foot, profile, 20);
    place(figure_room, "figure", std::move(figure), marble);
    set_groups(scene_.instances.back(), group(figure_room) | figure_group);
    const glm::vec3 from[3] = {{-1.6f, 2.7f, 1.5f}, {1.7f, 2.5f, 1.3f}, {0.2f, 2.8f, -2.0f}};
    for (int i = 0; i < 3; ++i) {
      Light& key = add_spot(scene_, "figure key " + std::to_string(i), foot + from[i],
                            foot + glm::vec3(0, 1.2f, 0), {1, 0.86f, 0.7f}, i == 2 ? 9.0f : 6.0f, 5, 12, 26);
      set_groups(key, figure_group);
    }
  }

  void add_moon() {
    Light moon;
    moon.name = "moon";
    moon.type = LightType::directional;
    moon.direction = glm::normalize(glm::vec3(-0.4f, -1, 0.35f));
    moon.color = {0.6f, 0.75f, 1};
    moon.intensity = 0.5f;
    set_groups(moon, group(court));
    scene_.lights.push_back(moon);
  }

  Scene scene_;
  int lamp_ = 0;
};

}  // namespace

Scene make_rooms() { return Rooms().make(); }

}  // namespace lightgrid
