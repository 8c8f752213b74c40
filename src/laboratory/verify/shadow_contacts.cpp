// Hard cases of exact shadows: lights that touch casters or lie within 10 micrometres of their planes, edges
// and corners, in frames at rest and after motion, by light cells and by the tree.
#include <cmath>
#include <numeric>

#include "verify/shadow_check.h"

namespace lightgrid::lab::verify {
namespace {

using glm::dmat4;
using glm::dvec3;
using glm::vec3;

constexpr double beside_m[] = {0, 1e-5, -1e-5, 3e-6, -3e-6, 1e-6, -1e-6, 1e-7, -1e-7};
constexpr int frames_at_rest = 3;  // light cells serve the last, for scenes this small

struct NamedImage {
  std::string name;
  ShadowImage image;
};

std::vector<int> numbers_to(size_t count) {
  std::vector<int> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

// Adds images of `scene`, of which `displaced` differs by what `changes` names: as they arrive from there,
// and at rest. None if the engine draws no sequences.
void draw_arrival(CullEngine& engine, const Scene& scene, Scene displaced, const SceneChanges& changes,
                  const View& view, const std::string& setting, std::vector<NamedImage>& images) {
  Settings settings;
  apply_setting(settings, setting);
  const std::unique_ptr<FrameSequence> frames = engine.sequence(displaced, "visibility", view, settings);
  if (!frames) return;
  const std::string name =
      fmt::format("{}, {} moved", setting, changes.lights.empty() ? "casters" : "lights");
  frames->draw(view, {});
  displaced.lights = scene.lights;
  displaced.instances = scene.instances;
  images.push_back({name, frames->draw(view, changes).shadows});
  for (int i = 1; i < frames_at_rest; ++i) frames->draw(view, {});
  images.push_back({name + " and rest", frames->draw(view, {}).shadows});
}

std::vector<NamedImage> images_after_motion(CullEngine& engine, const Scene& scene, const View& view) {
  std::vector<NamedImage> images;
  const dvec3 aside(0.25, 0.125, -0.5);
  Scene lights_aside = scene, casters_aside = scene;
  for (Light& light : lights_aside.lights) light.position += aside;
  for (Instance& instance : casters_aside.instances) instance.world_from_object[3] += glm::dvec4(aside, 0);
  for (const char* setting : {"shadow-cells=on", "shadow-cells=off"}) {
    draw_arrival(engine, scene, lights_aside, {.lights = numbers_to(scene.lights.size())}, view, setting,
                 images);
    draw_arrival(engine, scene, casters_aside, {.instances = numbers_to(scene.instances.size())}, view,
                 setting, images);
  }
  return images;
}

// The oracle decides once for all images: they show one scene from one view.
void compare_after_motion(Check& c, const Scene& scene, const View& view) {
  const std::vector<NamedImage> images = images_after_motion(c.engine, scene, view);
  if (images.empty()) return;
  std::vector<const ShadowImage*> of_images;
  for (const NamedImage& named : images) {
    if (!c.that(same_surfaces_and_lights(images.front().image, named.image), "{}: other surfaces than {}",
                named.name, images.front().name))
      return;
    of_images.push_back(&named.image);
  }
  const std::vector<ShadowPairs> counted = count_shadow_pairs(scene, Occlusion(scene), view, of_images);
  for (size_t i = 0; i < counted.size(); ++i) {
    c.trials(counted[i].decided());
    if (counted[i].wrong())
      c.lost_pairs(counted[i].wrong(), "{}: {} leaked, {} acned of {}: {}", images[i].name, counted[i].leaked,
                   counted[i].acned, counted[i].decided(), counted[i].why);
  }
}

void contacts(Check& c, const Scene& scene, const std::vector<View>& views, const Shows& shows) {
  if (shadows(c, scene, views, shows).empty()) return;
  compare_after_motion(c, scene, views.front());
}

// A floor, and a wall through the origin that stands on it.
Scene wall_on_a_floor() {
  Scene scene = empty_shadow_scene();
  add_triangles(scene, quad_of({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}));
  add_triangles(scene, quad_of({0, 0, -1}, {0, 0, 2}, {0, 2, 0}));
  return scene;
}

// Through the wall's middle, its diagonal, its edges, and its plane beyond them.
void lights_beside_a_wall(Check& c) {
  Scene scene = wall_on_a_floor();
  for (const double x : beside_m) {
    for (const dvec3& at : {dvec3(0, 1, 0), dvec3(0, 0.7, 0.6), dvec3(0, 2, 0.3), dvec3(0, 1.5, 1),
                            dvec3(0, 2.5, 0.2), dvec3(0, 1, -1.75)})
      add_lamp(scene, at + dvec3(x, 0, 0));
  }
  std::vector<View> views = {shadow_view({0, 6, 0.01}, {0, 0, 0}, 48, 48, 1.05)};
  Scene in_the_middle = wall_on_a_floor();
  for (const double x : {1e-5, -1e-5}) add_lamp(in_the_middle, {x, 1, 0});
  contacts(c, in_the_middle, views, {.seen = 0.3, .hidden = 0.3});
  contacts(c, scene, views, {.seen = 0.3, .hidden = 0.1, .either = 0.4});
  turn(scene, views, glm::rotate(dmat4(1), 0.7, glm::normalize(dvec3(1, 2, 3))));
  contacts(c, scene, views, {.seen = 0.3, .hidden = 0.1, .either = 0.4});
}

dvec3 normal_of(const ShadowTriangle& t) {
  const dvec3 across = glm::cross(dvec3(t[1]) - dvec3(t[0]), dvec3(t[2]) - dvec3(t[0]));
  return glm::normalize(across);
}

// In the planes of tilted casters, beside them and on them.
void lights_beside_planes(Check& c) {
  Random random(109);
  const ShadowTriangles triangles = coplanar_soup(random, 8);
  Scene scene = soup_scene(triangles, random, 0);
  for (size_t i = 0; i < 5 * std::size(beside_m); ++i) {
    const ShadowTriangle& t = triangles[i % triangles.size()];
    const double u = random.uniform(-1, 2), v = random.uniform(-1, 2);
    const dvec3 a(t[0]), in_plane = a + (dvec3(t[1]) - a) * u + (dvec3(t[2]) - a) * v;
    add_lamp(scene, in_plane + normal_of(t) * beside_m[i % std::size(beside_m)]);
  }
  contacts(c, scene, of_the_soup(), {.seen = 0.1, .hidden = 0.1, .either = 0.5});
}

// At the edges and corners of closed boxes, inside and outside, and of squares beside smaller ones.
void lights_beside_edges(Check& c) {
  Random random(113);
  ShadowTriangles triangles = junction_soup(random, 3);
  add_box(triangles, {-1, -1, -0.5f}, {-0.3f, 0.4f, 0.6f});
  add_box(triangles, {0.2f, -0.7f, -1}, {0.9f, 0.1f, -0.2f});
  Scene scene = soup_scene(triangles, random, 0);
  for (size_t i = 0; i < 6 * std::size(beside_m); ++i) {
    const ShadowTriangle& t = triangles[(7 * i) % triangles.size()];
    const dvec3 corner(t[i % 3]), along = dvec3(t[(i + 1) % 3]) - corner;
    const double share = i % 2 ? double(random.uniform()) : 0;
    add_lamp(scene, corner + along * share + any_direction(random) * beside_m[i % std::size(beside_m)]);
  }
  contacts(c, scene, of_the_soup(), {.seen = 0.1, .hidden = 0.1, .either = 0.5});
}

// On needles 1e-4 to 0.1 m wide, and beside them.
void lights_inside_slivers(Check& c) {
  Random random(127);
  ShadowTriangles slivers;
  for (int i = 0; i < 80; ++i) {
    const vec3 a(in_cube(random, 1.8)), along(in_cube(random, 1.5)), across(any_direction(random));
    slivers.push_back(
        {a, a + along, a + along * random.uniform() + across * std::pow(10.0f, random.uniform(-4, -1))});
  }
  Scene scene = soup_scene(slivers, random, 0);
  for (size_t i = 0; i < 50; ++i) {
    const ShadowTriangle& t = slivers[i % slivers.size()];
    const double u = random.uniform(), v = (1 - u) * double(random.uniform());
    const dvec3 on = dvec3(t[0]) * (1 - u - v) + dvec3(t[1]) * u + dvec3(t[2]) * v;
    add_lamp(scene, on + normal_of(t) * beside_m[i % 5]);
  }
  contacts(c, scene, of_the_soup(), {.seen = 0.1, .hidden = 0.1, .either = 0.7});
}

}  // namespace

std::vector<CaseRun> shadow_cases_of_contacts() {
  return CASES(lights_beside_a_wall, lights_beside_planes, lights_beside_edges, lights_inside_slivers);
}

}  // namespace lightgrid::lab::verify
