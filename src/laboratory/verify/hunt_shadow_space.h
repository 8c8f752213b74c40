// The space that the hunt of shadows (hunt_shadows.h) draws from: random scenes of every class, with lamps
// and views.
#pragma once

#include <string>
#include <vector>

#include "verify/shadow_scenes.h"

namespace lightgrid::lab::verify {

struct HuntedScene {
  Scene scene;
  std::vector<View> views;
};

// A scene of a class about the origin, about 4 m wide, without lights. Returns its triangles, for lights that
// are placed on them.
using MakeScene = ShadowTriangles (*)(Scene& scene, Random& random);

struct ShadowHuntClass {
  const char* name;
  MakeScene make;
  double min_far_m = 0, max_far_m = 0;  // from the world's origin
};

HuntedScene hunted_scene(const ShadowHuntClass& hunted, uint64_t seed);

// Classes whose name matches the regular expression; all if it is empty. Throws Error(input) if none matches.
std::vector<ShadowHuntClass> chosen_shadow_classes(const std::string& filter);

void move_eye(View& view, const glm::dvec3& by);

}  // namespace lightgrid::lab::verify
