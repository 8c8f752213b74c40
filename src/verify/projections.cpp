// Hard cases of the camera: very wide fields, jitter, projections of other kinds.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "shared/light_grid.h"
#include "verify/depth_images.h"

namespace lightgrid::verify {
namespace {

// Past 170 degrees the slopes of a tile's sides are differences of two numbers as large as the slope at the
// image's edge; most precision is lost at the axis, which here goes through the last pixel of a tile. Lights
// stand in the next tile, beside the planes through the pixels there, and just reach the pixels.
void fields_to_179_9(Check& c) {
  constexpr int width = 127, height = 95, axis_x = 63, axis_y = 47;
  for (const double degrees : {150.0, 170.0, 174.0, 176.0, 178.0, 179.0, 179.5, 179.9}) {
    const CullView view = field_of_view(degrees, width, height);
    const DepthImage depth = depth_of(view, [](int x, int y) { return 2 + (x * 7 + y * 3) % 5; });
    Random random(25);
    std::vector<CullLight> lights;
    const auto add = [&](int x, int y, int axis, double side) {
      const glm::dvec3 q = *surface_at(view, depth, x, y);
      glm::dvec3 normal(0, 0, q[axis] / -q.z);  // of the plane through the eye and the pixel's column or row
      normal[axis] = 1;
      const double size = -q.z * std::exp2(-6 - 10 * random.uniform());
      lights.push_back(point(q + side * size * glm::normalize(normal), size * (1 + 0x1p-30)));
    };
    for (int i = -3; i <= 3; ++i) {
      for (int repeat = 0; repeat < 4; ++repeat) {
        add(axis_x, axis_y + i, 0, 1), add(axis_x + 1, axis_y + i, 0, -1);
        add(axis_x + i, axis_y, 1, 1), add(axis_x + i, axis_y + 1, 1, -1);
      }
    }
    for (const CullLight& light : grazing_lights(view, depth, 200, true, random)) lights.push_back(light);
    c.pixels(view, lights, depth, c.every_test());
  }
}

// Halton's first points in bases 2 and 3, as engines move the image by parts of a pixel.
void jittered(Check& c) {
  constexpr double offsets[][2] = {{0, -1.0 / 6},       {-0.25, 1.0 / 6},  {0.25, -7.0 / 18},
                                   {-0.375, -1.0 / 18}, {0.125, 5.0 / 18}, {0.5, 0.5}};
  const CullView still = field_of_view(60, 64, 48);
  for (const auto& [x, y] : offsets) {
    CullView view = still;
    view.clip_from_view[2][0] += 2 * x / view.width, view.clip_from_view[2][1] += 2 * y / view.height;
    const auto distance = [](int px, int py) { return 2 + (px * 5 + py * 3) % 20; };
    const DepthImage depth = depth_of(view, distance);
    // Tiny lights at the pixels' own positions: a matrix off by a fraction of a pixel moves outer pixels to
    // the next tile.
    const HostGrid grid = c.pixels(view, lights_at_surfaces(view, depth, 1e-6), depth, c.every_tile());
    c.that(grid == c.engine.cull_depth(c.every_tile()[0], view, lights_at_surfaces(view, depth, 1e-6), depth),
           "the next frame through the same matrix has another grid");
  }
}

struct NamedMatrix {
  const char* name;
  int column, row;
  double value;
  bool orthographic;
};

// Each is either refused by name or loses nothing. Surfaces' positions come from the inverse matrix, which
// handles every kind of projection.
void other_projections(Check& c) {
  constexpr NamedMatrix changes[] = {{"shear of x by y", 1, 0, 0.3, false},
                                     {"shear of y by x", 0, 1, -0.4, false},
                                     {"oblique near plane in x", 0, 2, 0.004, false},
                                     {"oblique near plane in y", 1, 2, -0.004, false},
                                     {"w depends on x", 0, 3, 0.3, false},
                                     {"w depends on y", 1, 3, -0.2, false},
                                     {"x moved", 3, 0, 0.5, false},
                                     {"y moved", 3, 1, -0.5, false},
                                     {"x depends on z", 2, 0, 0.05, true},
                                     {"shear of x by y", 1, 0, 0.3, true},
                                     {"depth depends on x", 0, 2, 0.01, true},
                                     {"w depends on x", 0, 3, 0.05, true}};
  for (const NamedMatrix& change : changes) {
    CullView view =
        change.orthographic
            ? view_through({.half_x = 4, .half_y = 3, .near = 0.5, .far = 50, .orthographic = true}, 64, 48)
            : view_through({.half_x = 1, .half_y = 0.75, .near = 0.1}, 64, 48);
    view.clip_from_view[change.column][change.row] += change.value;
    const glm::dmat4 view_from_clip = glm::inverse(view.clip_from_view);
    DepthImage depth;
    std::vector<CullLight> lights;
    for (int y = 0; y < view.height; ++y) {
      for (int x = 0; x < view.width; ++x) {
        depth.values.push_back(change.orthographic ? 0.2f + 0.01f * float((x + y) % 60)
                                                   : 0.1f / float(2 + (x * 5 + y) % 9));
        const glm::dvec4 clip((x + 0.5) * 2 / view.width - 1, (y + 0.5) * 2 / view.height - 1,
                              depth.values.back(), 1);
        const glm::dvec4 p = view_from_clip * clip;
        lights.push_back(point(glm::dvec3(p) / p.w, 1e-4 * glm::length(glm::dvec3(p) / p.w)));
      }
    }
    try {
      const HostGrid grid = c.engine.cull_depth(tile_of(16), view, lights, depth);
      for (uint i = 0; i < lights.size(); ++i) {
        const auto list =
            list_of(grid, cell_of_pixel(i % view.width, i / view.width, 16, uint(grid.cells_x)));
        c.trials(1);
        if (!std::binary_search(list.begin(), list.end(), i))
          c.lost("{}: accepted, and pixel {} {} loses its light", change.name, i % view.width,
                 i / view.width);
      }
    } catch (const Error& error) {
      c.that(error.kind() == ErrorKind::input, "{}: {}", change.name, error.what());
    }
  }
}

// Found by fuzzing: squares of radii were infinite, and one kernel shape dropped lights that the other kept.
// Since then lights past 10^16 m are uploaded nearer, with finite squares.
void eye_1e26_m_off(Check& c) {
  const glm::dvec3 eye(-9.4e25, 0, 1);
  const CullView view = placed(sixty_degrees(), eye, 0.5, -0.1);
  Random random(39);
  std::vector<CullLight> lights;
  for (const glm::dvec3& middle : {glm::dvec3(0), eye / 2.0, eye * (1 - 1e-6), eye}) {
    for (int i = 0; i < 100; ++i) {
      const double radius = std::pow(10.0, double(random.uniform(0, 38)));
      lights.push_back(point(middle + any_direction(random) * 20.0, radius));
    }
  }
  for (const DepthInterval& bounds : {DepthInterval{12, 99}, every_distance}) {
    for (const CullerOptions& options : c.every_test()) {
      const HostGrid grid = c.grid_of_known_answer(view, lights, {bounds}, options);
      for (uint32_t i = 0; i < lights.size(); ++i) {
        if (!(lights[i].radius_m > 1.01 * glm::distance(lights[i].position, eye) + 1000)) continue;
        for (size_t cell = 0; cell < grid.cells.size(); ++cell) {
          c.contacts(1), c.trials(1);
          if (!std::ranges::binary_search(list_of(grid, cell), i))
            c.lost("{}: cell {} lost light {}, which reaches everything", to_string(options), cell, i);
        }
      }
    }
  }
}

// Found by fuzzing: half-z cut a tile where it has no surface. Since then the second view is refused; a culler
// that takes it must lose nothing.
void nearest_near_plane(Check& c) {
  for (const double near : {1e-37, 3e-53}) {
    const CullView view = view_through({.half_x = 2.6, .half_y = 0.44, .near = near}, 19, 13);
    const DepthImage depth = depth_of(
        view, [&](int x, int y) { return (x + y) % 5 ? near * std::exp2((x * 7 + y * 3) % 149) : sky; });
    std::vector<CullLight> lights = lights_at_surfaces(view, depth, 1e-3);
    for (int i = 0; i < 50; ++i) lights.push_back(point({i % 10 - 4.5, i % 7 - 3, -3 * i}, i % 13));
    try {
      c.pixels(view, lights, depth, every_mode());
    } catch (const Error& error) {
      c.that(near < 1e-37 && error.kind() == ErrorKind::input, "a near plane at {} m: {}", near,
             error.what());
    }
  }
}

}  // namespace

std::vector<HardCase> projection_cases() {
  const char* group = "camera";
  return {
      CASE(fields_to_179_9, "150 … 179.9° across; lights that just reach pixels about the axis",
           "a side's slope is the difference of two large ones", "nothing lost"),
      CASE(jittered, "six offsets by fractions of a pixel; a tiny light at each pixel's position",
           "jitter in one pass alone (HDRP #5287)",
           "nothing lost; the same matrix twice gives the same grid"),
      CASE(other_projections, "shears, oblique near planes, tilted w, moved images",
           "only the diagonal is read", "refused by name, or nothing lost"),
      CASE(eye_1e26_m_off,
           "the eye 10²⁶ m from the origin; lights there, at the eye and between, of 1 to 10³⁸ m",
           "infinite squares drop lights in one kernel shape",
           "the same bytes; what reaches everything is listed"),
      CASE(nearest_near_plane,
           "near planes of 10⁻³⁷ and 3·10⁻⁵³ m, surfaces up to 2¹⁴⁸ times as far, and sky",
           "half-z cuts where there is no surface",
           "nothing lost in any mode; the second is refused by name, or loses nothing"),
  };
}

}  // namespace lightgrid::verify
