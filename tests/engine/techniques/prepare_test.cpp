// After prepare() no view of the scene compiles anything, whichever lights and surfaces it sees.
#include <gmock/gmock.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>

#include "scenes/compose.h"
#include "scenes/shapes.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

// Light of each kind reaches one side of the floor, where a box of its own material stands.
Scene scene_of_sides() {
  Scene scene;
  const auto add = [&](const char* name, int material, auto&& shape) {
    Mesh mesh;
    shape(mesh);
    add_instance(scene, name, add_mesh(scene, shapes::finished(std::move(mesh), name, material)));
  };
  const int plain = add_material(scene, "plain", {0.8f, 0.8f, 0.8f}, 0, 0.7f);
  add("floor", plain, [](Mesh& m) { shapes::add_quad(m, {-20, -1, 20}, {40, 0, 0}, {0, 0, -40}); });
  const glm::vec3 sides[] = {{8, 0, 0}, {-8, 0, 0}, {0, 0, 8}, {0, 0, -8}};
  for (int i = 0; i < 4; ++i) {
    const int material = add_material(scene, "box", {0.7f, 0.5f, 0.3f}, 0, 0.5f);
    if (i == 0) scene.materials[material].clearcoat = 0.5f;
    if (i == 1) scene.materials[material].emissive = {0.1f, 0.2f, 0.1f};
    if (i == 2) {
      scene.materials[material].alpha_mode = AlphaMode::blend;
      scene.materials[material].base_color.a = 0.5f;
    }
    if (i == 3) scene.materials[material].alpha_mode = AlphaMode::mask;
    const glm::vec3 at = sides[i];
    add("box", material, [&](Mesh& m) { shapes::add_sphere(m, at, 0.7f, 8); });
  }
  for (int i = 0; i < 3; ++i) add_point(scene, "lamp", {8, 1, 2.0f * float(i) - 2}, {1, 0.9f, 0.8f}, 5, 3);
  for (int i = 0; i < 3; ++i)
    add_spot(scene, "torch", {-8, 2, 2.0f * float(i) - 2}, {-8, -1, 0}, {1, 1, 1}, 5, 4, 20, 40);
  add_point(scene, "caster", {0, 2, 8}, {1, 1, 1}, 5, 4).casts_shadow = true;
  add_spot(scene, "caster", {0, 2, 9}, {0, -1, 8}, {1, 1, 1}, 5, 5, 20, 40).casts_shadow = true;
  return scene;
}

// Each side, from near and from above; nothing but sky; and everything.
std::vector<View> views_of_sides() {
  std::vector<View> views;
  for (const glm::dvec3 side : {glm::dvec3(1, 0, 0), {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}}) {
    views.push_back(make_view(look_at(4.0 * side + glm::dvec3(0, 1, 0), 8.0 * side), 48, 32));
    views.push_back(make_view(look_at(8.0 * side + glm::dvec3(0.1, 4, 0), 8.0 * side), 48, 32));
  }
  views.push_back(make_view(look_at({0, 1, 0}, {0.1, 9, 0}), 48, 32));
  views.push_back(make_view(look_at({0, 18, 18}, {0, 0, 0}), 48, 32));
  return views;
}

// Programs and kernels, by name and defines, that views ask for and prepare() did not.
std::set<std::string> compiled_late(const Scene& scene, const Technique& technique, const Settings& settings,
                                    size_t first) {
  const std::vector<View> views = views_of_sides();
  std::set<std::string> prepared, asked, late;
  TechniqueRun run(test_devices(), scene, views[first], settings, technique);
  test_devices().note_programs(&prepared);
  run.prepare();
  test_devices().note_programs(&asked);
  for (const View& view : views) {
    run.look(view);
    run.run_frame();
  }
  test_devices().note_programs(nullptr);
  std::ranges::set_difference(asked, prepared, std::inserter(late, late.end()));
  return late;
}

// From the sky, and from views of one kind of light.
constexpr size_t starts[] = {8, 0, 2};

struct Prepared : testing::TestWithParam<const Technique*> {};

TEST_P(Prepared, CompileNothingForOtherLightsInView) {
  const Scene scene = scene_of_sides();
  for (const size_t first : starts)
    EXPECT_THAT(compiled_late(scene, *GetParam(), {}, first), testing::IsEmpty()) << "from view " << first;
}

TEST_P(Prepared, CompileNothingForADirectionalLight) {
  Scene scene = scene_of_sides();
  scene.lights.resize(4);
  Light& sun = scene.lights.emplace_back(Light{.name = "sun", .type = LightType::directional});
  sun.direction = {0, -1, 0};
  sun.casts_shadow = true;
  EXPECT_THAT(compiled_late(scene, *GetParam(), {}, 8), testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Techniques, Prepared, testing::ValuesIn(techniques()),
                         [](const auto& info) { return std::string(info.param->name); });

struct PreparedSettings : testing::TestWithParam<const char*> {};

TEST_P(PreparedSettings, CompileNothingForOtherLightsInView) {
  const std::string given = GetParam();
  const size_t space = given.find(' ');
  Settings settings;
  std::istringstream words(given.substr(space + 1));
  for (std::string word; words >> word;) apply_setting(settings, word);
  for (const size_t first : starts)
    EXPECT_THAT(compiled_late(scene_of_sides(), find_technique(given.substr(0, space)), settings, first),
                testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Of, PreparedSettings,
                         testing::Values("lidr lidr-types=passes", "lidr lidr-packing=sort",
                                         "deferred volume-culling=stencil", "deferred volume-culling=scissor",
                                         "visibility shadows=map", "visibility shadow-rays=4",
                                         "forward_plus list-cap=1 list-cap-order=sampled",
                                         "visibility far-light=4096", "visibility view-cap=1",
                                         "forward raster=opencl"));

}  // namespace
}  // namespace lightgrid
