// Lights as JSON: `lightgrid capture`'s lights.json, and the light lists of Red Eclipse maps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightgrid {

// Red Eclipse maps are z up, in map units; this project uses 8 units a metre (a player there is 14 units
// high: 1.75 m), and turns them y up. Radius 0 (unlimited) becomes an infinite radius.
inline constexpr double metres_per_redeclipse_unit = 0.125;

// {"lights": [{"name", "type": "point|spot|directional|virtual", "position", "direction", "radius",
// "inner_cone", "outer_cone", "color", "intensity", "casts_shadow", "source_radius", "nearest"}],
// "instances": [{"name"}]}, world space, metres, radians (half-angles), and the properties of effects
// (scene/property_rows.h). Defaults: type point, radius infinite, colour white, intensity 1, cones 0 and pi/4,
// casts_shadow false; without a source_radius soft shadows are those of the setting's sphere. "instances" are
// the scene's, by name. Point and spot lights require a position, spot and directional lights a direction. "range" is another name of "radius". An unknown field of
// a light or an instance is an error that names the nearest one. A light with "rgb255" is from a Red Eclipse
// map: a point light with colour rgb255 / 255 and radiant intensity (radius / 2)^2 candela, 1 lux at half the
// radius; radius 0 gives the intensity of 16 m. Throws Error(input) that names the file, the light and the
// field: NaN, numbers beyond a float's range (colour times intensity too), a negative radius, colour or
// intensity, a zero direction and cones outside 0 <= inner < outer <= pi are errors; so is a file above
// max_lights_file_bytes. Those replace the scene's lights.
void load_lights(Scene& scene, const std::filesystem::path& path);
// The same from a file's text; `path` is for messages, and its folder has the files that the text names.
void read_lights(Scene& scene, const std::string& text, const std::filesystem::path& path);
// The same for no scene: the file names no instances.
std::vector<Light> load_lights_file(const std::filesystem::path& path);

inline constexpr uintmax_t max_lights_file_bytes = uintmax_t(128) << 20;

// The optional "camera" of a lights file in the command line's form ("eye:…"), or empty.
std::string camera_of_lights_file(const std::filesystem::path& path);

// A lights file from which load_lights_file reads equal lights back: positions to the last bit of a double,
// the rest of a float. Fields that a light's type does not use are omitted.
std::string lights_file_text(const std::vector<Light>& lights);

}  // namespace lightgrid
