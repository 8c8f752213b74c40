// How a hard case of shadows is decided, and the scenes that several of them start from.
#pragma once

#include "verify/check.h"
#include "verify/shadow_pairs.h"
#include "verify/shadow_scenes.h"

namespace lightgrid::lab::verify {

// The shares of the pairs that a case must show, so that it proves something.
struct Shows {
  double seen = 0.02, hidden = 0.02;  // at least, decided
  double either = 0.05;               // at most
};
constexpr Shows all_seen{.seen = 0.9, .hidden = 0}, mostly_seen{.seen = 0.5, .hidden = 0.001};

// Compares every pair of a pixel and a light that casts with the oracle in double, in both kernel shapes.
// Returns the images of the lanes; none if the engine finds no shadows.
std::vector<ShadowImage> shadows(Check& c, const Scene& scene, const std::vector<View>& views,
                                 const Shows& shows = {});

// Parts of shadow_cases(): of eye, light and surface, views and lists; of lights that touch casters.
std::vector<CaseRun> shadow_cases_of_views();
std::vector<CaseRun> shadow_cases_of_contacts();

// A floor of 8 x 8 m with a post and a table on it, seen from a corner.
Scene furnished_floor(int cells = 2);
View of_the_floor(int width = 64, int height = 48);

// A soup, and lamps around it and at places on its triangles.
Scene soup_scene(const ShadowTriangles& triangles, Random& random, int lamps, int lamps_on_it = 0);
std::vector<View> of_the_soup();

// The scene and its view turned about the origin.
void turn(Scene& scene, std::vector<View>& views, const glm::dmat4& turn);

}  // namespace lightgrid::lab::verify
