// Photometric files (ANSI/IES LM-63): candela by vertical and horizontal angle (docs/profiles.md).
#pragma once

#include "scene/light_axes.h"

namespace lightgrid {

// FileTable::shape of a profile.
enum ProfileShape : size_t { profile_type, profile_polar_angles, profile_azimuths };
// LM-63's numbers.
enum class Photometry : uint32_t { c = 1, b = 2, a = 3 };

// The property "profile" of point and spot lights, in lights files, and "light_profile" in extras. Its table
// has one form for all types and symmetries: FileTable::values are
//   the largest candela value, multiplied as the file says;
//   polar angles in degrees, ascending, 0 to 180 from the pole;
//   azimuths in degrees, ascending, of a full turn (types A and B: -90 to 90) or only one;
//   for each azimuth the shares of the largest value at its polar angles, 0 to 1.
extern const Property<SharedTable> light_profile;

// Throws Error(input) that names the field and its value.
FileTable parse_profile(const std::vector<uint8_t>& bytes);

// Null: the light has none. Directional lights have none.
SharedTable profile_of(const Light& light);
float largest_candela(const FileTable& profile);

// The directions in the world from which angles are measured: polar angles from `pole`, azimuths from `first`
// towards `second`.
struct ProfileAxes {
  glm::dvec3 pole, first, second;
};
ProfileAxes profile_axes(const FileTable& profile, const LightAxes& axes);

// The share of the largest candela value in a direction, in double: bilinear in both angles, 0 outside of the
// file's angles. polar: 0 to 180 degrees; azimuth: -180 to 360.
double profile_share(const FileTable& profile, double polar_deg, double azimuth_deg);

// The same function on equal steps that contain the file's angles: bilinear in a cell, it has the same values.
// Angles that no step of max_profile_steps contains move to the nearest step.
struct ProfileGrid {
  uint32_t rows = 1,
           columns = 0;  // steps from the first to the last polar angle, and of a turn; 0: one column
  double first_rad = 0, last_rad = 0;  // polar angles
  bool front = false;                  // 0 behind the plane of `pole` and `second`
  std::vector<float> shares;           // a column of rows + 1 after the other; the last repeats the first
};
inline constexpr uint32_t max_profile_steps = 36'000;
inline constexpr size_t max_profile_values = size_t(1) << 23;
ProfileGrid grid_of(const FileTable& profile);

}  // namespace lightgrid
