// Scenes made in code, the same on every machine.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace lightgrid {

struct BuiltinScene {
  const char* name;
  const char* summary;  // one line, for `lightgrid scenes`
  Scene (*make)();
  bool large = false;  // millions of triangles: tests over all scenes leave it out, and it has its own
};

// hall, spheres, terrain, street, particles, gallery, rooms, square.
const std::vector<BuiltinScene>& builtin_scenes();

// nullptr if there is none of that name.
const BuiltinScene* find_builtin_scene(std::string_view name);

Scene make_hall();
Scene make_spheres();
Scene make_terrain();
Scene make_street();
Scene make_particles();
Scene make_gallery();
Scene make_square();
Scene make_rooms();

}  // namespace lightgrid
