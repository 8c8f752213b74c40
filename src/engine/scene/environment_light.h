// Light from surroundings (docs/environment.md): radiance by direction, and what shading reads of it.
#pragma once

#include <array>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

namespace lightgrid {

// Radiance by longitude and latitude, constant within a texel. Row 0 is at the top (+y). Its middle column
// looks along +x, the column three quarters along it +z, its left and right edge -x. Linear.
struct RadianceMap {
  std::string name;  // for messages
  int width = 0, height = 0;
  std::vector<glm::vec3> texels;
};

inline constexpr double max_radiance = 1e30;  // of files; sums of it are finite in float

// Reads an .hdr or .exr picture. Throws Error(input) that names the file, and the pixel whose value is not
// from 0 to max_radiance.
RadianceMap read_radiance_map(const std::filesystem::path& path);

// A gradient from the zenith over the horizon to the ground.
RadianceMap sky_gradient(const glm::dvec3& zenith, const glm::dvec3& horizon, const glm::dvec3& ground);

// The gradient whose mean over all directions is `mean`.
RadianceMap sky_of_mean(const glm::dvec3& mean);

glm::dvec3 direction_of_texel(const RadianceMap& map, int column, int row);  // of its middle, unit
// Radiance from a unit direction of the world.
glm::dvec3 radiance_at(const RadianceMap& map, const glm::dvec3& direction);

// As shared/effects/environment_light.h lays it out.
struct EnvironmentTable {
  int cells = 0;  // along a side
  std::vector<glm::dvec3> texels;
};

// For red, green and blue each: x, y, z, xx, yy, zz, xy, xz, yz.
using RadianceMoments = std::array<std::array<double, 9>, 3>;

struct Environment {
  std::string name;  // of its map
  RadianceMoments moments{};
  std::vector<EnvironmentTable> tables;  // of rising roughness, and the background
};

// With `moments` in place of the map's, if they are given.
std::shared_ptr<const Environment> make_environment(const RadianceMap& map,
                                                    const RadianceMoments* moments = nullptr);

// The radiance that a lobe of this perceptual roughness receives around a unit direction, from the tables.
glm::dvec3 lobe_radiance(const Environment& environment, const glm::dvec3& direction, double roughness);

// The radiance from a direction, from the table of the background.
glm::dvec3 background_radiance(const Environment& environment, const glm::dvec3& direction);

// "sky", "sky:" and nine numbers (red, green and blue at the zenith, the horizon and the ground), or the path
// of a file; "none": null. Throws Error(input).
std::shared_ptr<const Environment> parse_environment(const std::string& text);

}  // namespace lightgrid
