// The views of the hard cases, and their cells and lights as the oracle has them.
#pragma once

#include <string>

#include "oracle/cell.h"
#include "verify/engine.h"

namespace lightgrid::lab::verify {

constexpr double no_end = std::numeric_limits<double>::infinity();

enum class DepthOrder { reversed, standard };

// Slopes at the image's edges are shift ± half. The eye is at the origin and looks along -z.
struct Lens {
  double half_x = 1, half_y = 1;  // slopes; metres where orthographic
  double near = 0.1, far = no_end;
  double shift_x = 0, shift_y = 0;
  bool orthographic = false;
  DepthOrder order = DepthOrder::reversed;
};
CullView view_through(const Lens& lens, int width, int height);
CullView field_of_view(double fov_y_deg, int width, int height);
const CullView& sixty();        // degrees; 127 x 73
const CullView& small_sixty();  // 64 x 48

// The same view for the oracle (oracle/position.h), which reads size, matrices and kind of projection.
View oracle_view(const CullView& view);

float depth_of_nothing(const CullView& view);            // 0 reversed, 1 standard
double depth_at(const CullView& view, double distance);  // z/w in double
double distance_at(const CullView& view, double depth);
// View space: the point at `distance` along the view axis through the centre of pixel (px, py). `view` is
// oracle_view's.
glm::dvec3 position_at(const View& view, int px, int py, double distance);
int tiles_x(const CullView& view, int tile);
size_t tile_count(const CullView& view, int tile);

// The camera moved and turned; lights moved and turned with it look the same.
CullView placed(CullView view, const glm::dvec3& eye, double yaw_rad, double pitch_rad);
glm::dvec3 to_view(const CullView& view, const glm::dvec3& world);
glm::dvec3 to_world(const CullView& view, const glm::dvec3& in_view);
void move_to_world(const CullView& view, std::vector<CullLight>& lights);  // positions and directions

std::vector<OracleLight> oracle_lights(const CullView& view, std::span<const CullLight> lights);

// The median of the lights' positions, each axis alone, without positions that are not finite. World, metres.
glm::dvec3 median_light(std::span<const CullLight> lights);

// As cell_of_grid.
Cell cell_of(const CullView& view, int tile, size_t index, const DepthInterval& bounds, bool pixel_centres);

// The lights that certainly touch each cell, ascending.
using Touching = std::vector<std::vector<uint32_t>>;
Touching touching_lights(const CullView& view, std::span<const OracleLight> lights,
                         std::span<const DepthInterval> bounds, int tile, bool pixel_centres);

struct NamedView {
  std::string name;
  CullView view;
};
// Fields of 0.1, 60, 170 and 179 degrees, off centre, orthographic, standard depth, far from the origin and
// turned.
std::vector<NamedView> hard_views(int width, int height);

}  // namespace lightgrid::lab::verify
