// Lights as JSON: `lightgrid capture`'s lights.json, and the light lists of Red Eclipse maps.
#pragma once

#include <filesystem>
#include <vector>

#include "scene/scene.h"

namespace lightgrid {

// Red Eclipse maps are z up, in map units; this project takes 8 units to the metre (a player there is 14
// units high: 1.75 m), and turns them y up. Radius 0 (unlimited) becomes an infinite radius.
inline constexpr double metres_per_redeclipse_unit = 0.125;

// {"lights": [{"type": "point|spot|directional", "position", "direction", "radius", "inner_cone",
// "outer_cone",
//   "color", "intensity"}]}, world space, metres, radians (half-angles). Absent: type point, radius infinite,
//   colour white, intensity 1. Throws Error(input) that names the file, the light and the field; NaN, a
//   negative radius, a zero direction and cones outside 0 <= inner < outer <= pi are errors.
std::vector<Light> load_lights_file(const std::filesystem::path& path);

// The optional "camera" of a lights file in the command line's form ("eye:…"), or empty.
std::string camera_of_lights_file(const std::filesystem::path& path);

void save_lights_file(const std::filesystem::path& path, const std::vector<Light>& lights);

}  // namespace lightgrid
