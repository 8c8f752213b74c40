// Hard cases of the world grid (docs/techniques/world_grid.md): points that lights just reach, in double,
// against the list that shading finds for the point's position in view space.
#include <algorithm>
#include <cmath>

#include "passes/pass_cases.h"
namespace lightgrid {
namespace {

struct WorldGridChoice {
  WorldGridShape shape;
  double cell;
  const char* name;
};
constexpr WorldGridChoice world_grids[] = {{WorldGridShape::cubes, 1, "3d"},
                                           {WorldGridShape::cubes, 0.25, "3d, a quarter"},
                                           {WorldGridShape::columns, 1, "2d"},
                                           {WorldGridShape::hashed, 1, "hashed"}};
const WorldBox no_surfaces{glm::dvec3(no_end), glm::dvec3(-no_end)};

View world_view(const glm::dvec3& eye, const glm::dvec3& target) {
  return make_view(look_at(eye, target), 64, 48);
}

CullLight world_spot(const glm::dvec3& position, double radius, const glm::dvec3& direction,
                     double cos_outer) {
  return {position, radius, direction, cos_outer};
}

bool lights_point(const CullLight& light, const glm::dvec3& point) {
  const glm::dvec3 from = point - light.position;
  const double distance = std::hypot(from.x, from.y, from.z);
  if (!(distance < light.radius_m)) return false;
  return light.cos_outer < 0 || glm::dot(from, light.direction) > distance * light.cos_outer;
}

// A point that a light just reaches, or lies well within.
glm::dvec3 reached_point(const CullLight& light, Random& random) {
  const glm::dvec3 any = any_direction(random);
  glm::dvec3 direction = any;
  if (light.cos_outer >= 0) {
    const glm::dvec3 across = glm::normalize(any - light.direction * glm::dot(any, light.direction));
    const double angle = std::acos(std::min(light.cos_outer, 1.0)) * (1 - 1e-6 * double(random.uniform()));
    direction = light.direction * std::cos(angle) + across * std::sin(angle);
  }
  constexpr double inward[] = {1e-8, 1e-6, 1e-4, 0.5};
  const double radius = std::isfinite(light.radius_m) ? light.radius_m : 100;
  return light.position + direction * (radius * (1 - inward[random.next() % 4]));
}

// Each light that reaches a point's position, as shading computes it, is in the list that shading reads
// there, once.
void expect_listed(PassCheck& c, const ListedWorld& built, const View& view,
                   const std::vector<CullLight>& lights, std::span<const glm::dvec3> points,
                   const char* name) {
  const HostWorldGrid& lists = built.grid;
  const WorldViewParams rows = world_view_params(built.layout, view);
  const glm::dmat3 rotation(view.view_from_world);
  for (const glm::dvec3& point : points) {
    const glm::vec3 in_view(rotation * (point - view.eye));
    const glm::dvec3 shaded = glm::transpose(rotation) * glm::dvec3(in_view) + view.eye;
    const glm::uvec2 range = lists.range_at(world_position(in_view, rows));
    if (!c.that(uint64_t(range.x) + range.y <= lists.indices.size(), "{}: a list past the end", name))
      continue;
    const std::span<const uint32_t> list = std::span(lists.indices).subspan(range.x, range.y);
    for (const auto part : {list, lists.everywhere()}) {
      c.that(std::ranges::adjacent_find(part, std::greater_equal()) == part.end(), "{}: a list is not sorted",
             name);
      c.that(part.empty() || part.back() < lights.size(), "{}: no such light", name);
    }
    for (uint32_t i = 0; i < lights.size(); ++i) {
      const bool in_cell = std::ranges::binary_search(list, i),
                 everywhere = std::ranges::binary_search(lists.everywhere(), i);
      c.that(!(in_cell && everywhere), "{}: light {} is listed twice", name, i);
      if (!lights_point(lights[i], shaded)) continue;
      ++c.contacts;
      c.that(in_cell || everywhere, "{}: light {} is lost at ({}, {}, {})", name, i, point.x, point.y,
             point.z);
    }
  }
}

std::vector<glm::dvec3> points_of(const std::vector<CullLight>& lights, size_t count, uint64_t seed) {
  Random random(seed);
  std::vector<glm::dvec3> points;
  for (size_t i = 0; i < count && !lights.empty(); ++i)
    points.push_back(reached_point(lights[random.next() % lights.size()], random));
  return points;
}

// Lists of every shape, of one build or of builds one after the other.
void hold(PassCheck& c, const std::vector<CullLight>& lights, const View& view, size_t points,
          uint64_t seed = 1) {
  const std::vector<glm::dvec3> at = points_of(lights, points, seed);
  for (const auto& [shape, cell, name] : world_grids) {
    const auto built = c.world_lists({shape, cell, 16}, lights, no_surfaces, view);
    expect_listed(c, built, view, lights, at, name);
  }
}

void on_a_corner(PassCheck& c) {
  std::vector<CullLight> lights;
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z) {
        lights.push_back({{2 * x, 2 * y, 2 * z}, 2});
        lights.push_back({{2 * x + 1e-7, 2 * y, 2 * z - 1e-7}, 1});
      }
    }
  }
  hold(c, lights, world_view({1, 2, 9}, {0, 0, 0}), 2000);
}

// Cells have corners at whole metres from the origin, or at a quarter of them: balls of 1 m around it make
// the grid's box. Each other ball ends a nanometre past the corner, the edge or the face of a cell that is
// nearest to it.
void tangent_to_cells(PassCheck& c) {
  Random random(41);
  std::vector<CullLight> lights = {{glm::dvec3(-20), 1}, {glm::dvec3(20), 1}};
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 300; ++i) {
    glm::dvec3 away = glm::abs(any_direction(random)), point;
    for (int axis = 0; axis < 3; ++axis) {
      point[axis] = double(random.next() % 31) - 15;
      if (axis >= 3 - i % 3) {
        away[axis] = 0;
        point[axis] += 0.125;  // between two corners
      }
    }
    points.push_back(point);
    lights.push_back({point - glm::normalize(away) * (1 - 1e-9), 1});
  }
  const View view = world_view({0, 0, 5}, {0, 0, 0});
  for (const auto& [shape, cell, name] : world_grids) {
    const auto built = c.world_lists({shape, cell, 16}, lights, no_surfaces, view);
    expect_listed(c, built, view, lights, points, name);
  }
}

void eye_inside(PassCheck& c) {
  const glm::dvec3 eye(3, 1, 2);
  hold(c, {{eye, 1}, {eye + 1e-6, 5}, world_spot(eye, 3, {0, 0, -1}, 0.8), {eye, 0.01}},
       world_view(eye, {0, 0, 0}), 1000);
}

void larger_than_the_grid(PassCheck& c) {
  std::vector<CullLight> lights;
  Random random(5);
  for (int i = 0; i < 100; ++i) lights.push_back({any_direction(random) * 10.0, 0.5});
  for (const double radius : {1e2, 1e4, 1e6, 1e12, no_end}) lights.push_back({{1, 2, 3}, radius});
  hold(c, lights, world_view({0, 0, 12}, {0, 0, 0}), 2000);
}

void empty(PassCheck& c) {
  const View view = world_view({0, 0, 5}, {0, 0, 0});
  for (const auto& [shape, cell, name] : world_grids) {
    const auto built = c.world_lists({shape, cell, 16}, {}, no_surfaces, view);
    const HostWorldGrid& lists = built.grid;
    for (const glm::dvec3& point : {glm::dvec3(0), glm::dvec3(1e9, -5, 2)}) {
      const glm::uvec2 range =
          lists.range_at(world_position(glm::vec3(point), world_view_params(built.layout, view)));
      c.that(range.y == 0 && lists.indices.empty(), "{}: {} lights of none", name, range.y);
    }
  }
}

// As many as the run's number of adversarial lights, up to a million.
void many_in_one_cell(PassCheck& c) {
  const size_t count = c.many;
  const std::vector<CullLight> lights(count, CullLight{{0.3, 0.2, 0.1}, 1});
  const View view = world_view({0, 0, 5}, {0, 0, 0});
  for (const auto& [shape, cell, name] : {WorldGridChoice{WorldGridShape::cubes, 2, "3d"},
                                          WorldGridChoice{WorldGridShape::hashed, 2, "hashed"}}) {
    const auto built = c.world_lists({shape, cell, 32}, lights, no_surfaces, view);
    const HostWorldGrid& lists = built.grid;
    const glm::vec3 middle(glm::dmat3(view.view_from_world) * (glm::dvec3(0.3, 0.2, 0.1) - view.eye));
    const glm::uvec2 range = lists.range_at(world_position(middle, world_view_params(built.layout, view)));
    c.that(range.y == count, "{}: {} of {} lights", name, range.y, count);
    const std::span<const uint32_t> list = std::span(lists.indices).subspan(range.x, range.y);
    c.that(std::ranges::adjacent_find(list, std::greater_equal()) == list.end(), "{}: the list is not sorted",
           name);
    c.contacts += count;
  }
}

std::vector<CullLight> cloud(const glm::dvec3& middle, double size, double radius, int count, uint64_t seed) {
  Random random(seed);
  std::vector<CullLight> lights;
  for (int i = 0; i < count; ++i) {
    CullLight light{middle + any_direction(random) * (size * double(random.uniform())),
                    radius * double(0.5f + random.uniform())};
    light.direction = any_direction(random);
    if (i % 3 == 0) light.cos_outer = double(random.uniform());
    lights.push_back(light);
  }
  return lights;
}

void eye_outside(PassCheck& c) {
  for (const double distance : {30.0, 1e3, 1e6, 1e9}) {
    hold(c, cloud({0, 0, 0}, 10, 1, 100, 7), world_view({distance, distance / 3, -distance}, {0, 0, 0}), 500);
  }
}

void thin_spots(PassCheck& c) {
  Random random(11);
  std::vector<CullLight> lights;
  for (int i = 0; i < 200; ++i) {
    const double angle = std::pow(10.0, -7 * double(random.uniform()));  // radians; some lower to 0
    lights.push_back(
        world_spot(any_direction(random) * 5.0, 4, any_direction(random), i % 20 ? std::cos(angle) : 1));
  }
  hold(c, lights, world_view({0, 0, 15}, {0, 0, 0}), 1000);
}

// Each build has another grid, in buffers that the one before has used.
void moving_bounds(PassCheck& c) {
  for (const double size : {5.0, 500.0, 0.05, 20.0}) {
    hold(c, cloud({size, -size, 3}, size, 1, 150, uint64_t(size * 100)), world_view({0, 0, size}, {0, 0, 0}),
         300);
  }
}

void invalid_numbers(PassCheck& c) {
  std::vector<CullLight> lights = cloud({0, 0, 0}, 5, 1, 60, 13);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  size_t at = 0;
  for (const double bad : {nan, no_end, -no_end}) {
    for (int axis = 0; axis < 3; ++axis) lights[at++].position[axis] = bad;
  }
  for (const double bad : {nan, -1.0, -no_end, 0.0, -0.0}) lights[at++].radius_m = bad;
  std::vector<CullLight> good(lights.begin() + std::ptrdiff_t(at), lights.end());
  const View view = world_view({0, 0, 8}, {0, 0, 0});
  const std::vector<glm::dvec3> points = points_of(good, 500, 3);
  for (const auto& [shape, cell, name] : world_grids) {
    const auto built = c.world_lists({shape, cell, 16}, lights, no_surfaces, view);
    const HostWorldGrid& lists = built.grid;
    expect_listed(c, built, view, lights, points, name);
    c.that(std::ranges::none_of(lists.indices, [&](uint32_t i) { return i + 2 < at; }),
           "{}: a light that is nowhere is listed", name);
  }
}

// Lights whose distance from each other is no double, of every size, and the eye between them and at them.
void at_the_ends_of_the_doubles(PassCheck& c) {
  constexpr double most = std::numeric_limits<double>::max();
  for (const double end : {8.9e307, 9.1e307, most}) {
    for (const double radius : {1.0, 1e15, 1e291, end / 2, end}) {
      const std::vector<CullLight> lights = {
          {{-end, 100, 0}, radius}, {{end, 100, 0}, radius}, {{0, -end, end}, radius}};
      for (const glm::dvec3& eye : {glm::dvec3(0), lights[0].position, lights[1].position}) {
        const View view = world_view(eye, eye == glm::dvec3(0) ? glm::dvec3(0, 0, -1) : glm::dvec3(0));
        std::vector<glm::dvec3> points;
        for (const double away : {0.0, 0.5, 1e6, 1e14})
          points.insert(points.end(), {eye + glm::dvec3(away, 0, 0), eye - glm::dvec3(0, away, away)});
        for (const auto& [shape, cell, name] : world_grids) {
          const auto built = c.world_lists({shape, cell, 16}, lights, no_surfaces, view);
          expect_listed(c, built, view, lights, points, name);
        }
      }
    }
  }
}

void parked_far_away(PassCheck& c) {
  at_the_ends_of_the_doubles(c);
  std::vector<CullLight> lights = cloud({0, 0, 0}, 10, 1, 200, 17);
  const size_t near = lights.size();
  constexpr double most = std::numeric_limits<double>::max();
  for (const double far : {1e6, 1e19, 1e30, 3.4e38, 1e300, most}) lights.push_back({{far, -far, far / 2}, 1});
  const View view = world_view({0, 0, 15}, {0, 0, 0});
  const std::vector<glm::dvec3> points =
      points_of(std::vector<CullLight>(lights.begin(), lights.begin() + std::ptrdiff_t(near)), 500, 3);
  for (const auto& [shape, cell, name] : world_grids) {
    const auto built = c.world_lists({shape, cell, 16}, lights, {glm::dvec3(-12), glm::dvec3(12)}, view);
    const HostWorldGrid& lists = built.grid;
    expect_listed(c, built, view, lights, points, name);
    c.that(lists.everywhere().empty(), "{}: {} parked lights in every list", name, lists.everywhere().size());
  }
}

// Sizes over six decades: small cells have the lights of the large ones around them.
void sizes_mixed(PassCheck& c) {
  Random random(23);
  std::vector<CullLight> lights;
  for (int i = 0; i < 300; ++i) {
    const double radius = std::pow(10.0, 6 * double(random.uniform()) - 3);
    lights.push_back({any_direction(random) * (100.0 * double(random.uniform())), radius});
  }
  hold(c, lights, world_view({0, 20, 150}, {0, 0, 0}), 2000);
}

void far_from_the_origin(PassCheck& c) {
  for (const double offset : {1e4, 1e7, 1e9}) {
    const glm::dvec3 middle(offset, -offset, offset / 2);
    hold(c, cloud(middle, 10, 1, 150, 29), world_view(middle + glm::dvec3(0, 3, 12), middle), 500);
  }
}

}  // namespace

std::vector<PassCase> world_cases() {
  return {
      CASE(on_a_corner, "balls whose centres and ends lie on corners and faces of cells",
           "floor on one side, ceil on the other", "every light that reaches is listed"),
      CASE(tangent_to_cells, "balls that end 1 nm past a cell's corner, edge or face",
           "a light's place and radius are rounded", "every light that reaches is listed"),
      CASE(eye_inside, "the eye in lights, and at their centres", "normalize(0)",
           "every light that reaches is listed"),
      CASE(larger_than_the_grid, "radii of 10² m to infinity among lights of 0.5 m",
           "a capacity of cells a light; inf - inf", "listed everywhere, once"),
      CASE(empty, "0 lights", "bounds of nothing; buffers of size 0", "every list empty"),
      CASE(many_in_one_cell, "10⁵ lights in one place (10⁶ with LIGHTGRID_LONG_TESTS)",
           "a limit a cell (PlayCanvas: 255) drops some", "all of them in the list"),
      CASE(eye_outside, "the eye 30 m to 10⁹ m from a cloud of lights",
           "positions rounded by more than slack", "every light that reaches is listed"),
      CASE(thin_spots, "half-angles of 1 to 10⁻⁷ radians, and 0", "the cone misses every cell's centre",
           "every light that reaches is listed"),
      CASE(moving_bounds, "builds one after the other whose bounds grow and shrink",
           "blocks or cells of the last build are read", "every light that reaches is listed"),
      CASE(invalid_numbers, "positions NaN and ±∞; radii NaN, negative, 0",
           "bounds of NaN; a cell number from NaN", "listed nowhere, others unharmed"),
      CASE(parked_far_away, "lights at 10⁶ to 1.8·10³⁰⁸ m, beside others and alone",
           "bounds that make one cell of everything else; cells that double until they are ∞",
           "others unharmed; no list is longer"),
      CASE(sizes_mixed, "radii of 10⁻³ to 10³ m", "a small cell lacks the large lights around it",
           "every light that reaches is listed"),
      CASE(far_from_the_origin, "the world moved by 10⁴, 10⁷, 10⁹ m", "cells from world positions in float",
           "every light that reaches is listed"),
  };
}

}  // namespace lightgrid
