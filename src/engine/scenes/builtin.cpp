#include "scenes/builtin.h"

#include <algorithm>

namespace lightgrid {

const std::vector<BuiltinScene>& builtin_scenes() {
  static const std::vector<BuiltinScene> scenes = {
      {"hall", "a vaulted hall: columns, niches, glass, iron lattices, lamps of many colours", make_hall},
      {"spheres", "600 spheres floating in the dark, 2 to 90 m away: depth steps everywhere", make_spheres},
      {"terrain", "hills under 255 small coloured lights, seen from above", make_terrain},
      {"street", "a wet street 360 m long at night: shops, lamp posts, cars, garlands", make_street},
      {"particles", "a yard at night full of smoke: blended puffs that face the camera, lit by sparks",
       make_particles},
      {"gallery", "busts of skin, wax and stone between velvet: materials that are not Lambert's",
       make_gallery},
      {"rooms", "six rooms lit by light groups instead of shadows, a figure with lights of its own",
       make_rooms},
      {"square", "a square at night: cafes, trees, hedges, wires; 2.8 million triangles under 300 lights",
       make_square, true},
  };
  return scenes;
}

const BuiltinScene* find_builtin_scene(std::string_view name) {
  const auto& scenes = builtin_scenes();
  const auto found =
      std::find_if(scenes.begin(), scenes.end(), [&](const auto& s) { return s.name == name; });
  return found == scenes.end() ? nullptr : &*found;
}

}  // namespace lightgrid
