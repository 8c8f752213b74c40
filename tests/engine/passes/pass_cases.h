// Hard cases of passes: the world grid, the light buffer and the voxel light buffer. As those of culling
// (`lightgrid verify`) they have an input, the fault of naive code that breaks on it and a property that must
// hold (docs/details/hard_cases.md#cases-of-passes).
#pragma once

#include <fmt/format.h>

#include "renderer/shared_grids.h"
#include "scene/camera.h"
#include "scene/random.h"
#include "scenes/compose.h"
#include "support/devices.h"
#include "support/long_tests.h"

namespace lightgrid {

constexpr double no_end = std::numeric_limits<double>::infinity();

// Cells of the world and the list of each (docs/techniques/world_grid.md).
struct WorldListsOf {
  WorldGridShape shape;
  double cell;  // the setting world-cell, 0: auto
  int index_bits;
  auto operator<=>(const WorldListsOf&) const = default;
};
struct ListedWorld {
  WorldLayout layout;
  HostWorldGrid grid;
};

// The findings of a case: how much it compared, and its first fault.
class PassCheck {
 public:
  virtual ~PassCheck() = default;

  // Lists as WorldGrid::build makes them, in the buffers that the last build of these settings used. Virtual
  // so that world_faults_test can alter them.
  virtual ListedWorld world_lists(const WorldListsOf& of, std::span<const CullLight> lights,
                                  const WorldBox& bounds, const View& view);

  size_t many = long_tests() ? 1'000'000 : 100'000;  // lights in one place

  template <typename... Args>
  bool that(bool holds, fmt::format_string<Args...> format, Args&&... args) {
    ++trials;
    if (!holds && fault.empty()) fault = fmt::format(format, std::forward<Args>(args)...);
    return holds;
  }

  uint64_t trials = 0;
  uint64_t contacts = 0;  // (point, light) pairs that are certainly lit
  std::string fault;
};

struct PassCase {
  const char* name;
  const char* input;
  const char* breaks;     // the fault of naive code
  const char* invariant;  // the property that must hold
  void (*run)(PassCheck&);
};
#define CASE(name, input, breaks, invariant) \
  { #name, input, breaks, invariant, name }

std::vector<PassCase> world_cases();
std::vector<PassCase> light_buffer_cases();
std::vector<PassCase> voxel_cases();

// A wall of 8 x 8 m in front of an eye at the origin, oblique: 2 to 6 m away. It makes the plan and bounds
// volumes.
Scene wall_scene(const glm::dvec3& origin = glm::dvec3(0));

// The eye at the origin, looking along -z.
View eye_view(int width, int height, const glm::dvec3& origin = glm::dvec3(0));

// Hundreds of points and spots, some of them thin, in the space between the eye and the wall and around it.
void add_random_lights(Scene& scene, int count, uint64_t seed);

}  // namespace lightgrid
