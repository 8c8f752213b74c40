// Each engine's limit on a scene made for it: full it holds, one light more is dropped, and it is the one
// that the engine's order says. Counts are those of the scene's making, or brute force over points.
#include "check/light_limits.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <functional>
#include <set>

#include "base/error.h"
#include "check/light_cells.h"
#include "check/limit_words.h"
#include "plan/frame_plan.h"
#include "plan/settings/grid.h"
#include "plan/visibility.h"
#include "scene/light_groups.h"
#include "scene/random.h"
#include "scenes/compose.h"
#include "scenes/shapes.h"
#include "support/paths.h"
#include "support/read_files.h"
#include "techniques/technique.h"

namespace lightgrid::lab {
namespace {

using testing::ElementsAre;

// An eye at the origin that looks along -z with a field of 90 degrees, and a wall 12 m before it.
struct Level {
  Scene scene;
  View view;

  explicit Level(int size_px = 640, double near_m = 1) {
    add_material(scene, "plaster", {0.5f, 0.5f, 0.5f}, 0, 1);
    add_wall("wall", {-12, -12, -12}, 24);
    Camera camera = look_at({0, 0, 0}, {0, 0, -1});
    camera.fov_y_rad = 2 * std::atan(1.0);
    camera.near_m = near_m;
    view = make_view(camera, size_px, size_px);
  }
  void add_wall(const char* name, glm::vec3 corner, float side) {
    Mesh mesh;
    shapes::add_quad(mesh, corner, {side, 0, 0}, {0, side, 0});
    add_instance(scene, name, add_mesh(scene, shapes::finished(std::move(mesh), name, 0)));
  }
  void point(glm::vec3 at, float range = 0.01f) { add_point(scene, "point", at, {1, 1, 1}, 1, range); }
  void spot(glm::vec3 at, glm::vec3 target, float range = 0.01f) {
    add_spot(scene, "spot", at, target, {1, 1, 1}, 1, range, 10, 20);
  }
};

LimitResult result_of(const Level& level, const std::string& id) {
  const std::string engine = id.substr(0, id.find('/'));
  LightCheck check(limits_of(engine), {});
  check.count(level.scene, level.view);
  for (const LimitResult& result : check.results())
    if (id_of(*result.limit) == id) return result;
  throw input_error("no limit {}", id);
}

std::vector<int> dropped(const LimitResult& result) {
  std::vector<int> lights;
  for (const DroppedLight& light : result.dropped) lights.push_back(light.light);
  return lights;
}

TEST(LightLimits, AreNamedOnceWithASource) {
  std::set<std::string> ids;
  for (const EngineLimit& limit : engine_limits()) {
    EXPECT_TRUE(ids.insert(id_of(limit)).second) << id_of(limit);
    EXPECT_TRUE(std::string(limit.source).starts_with("https://")) << id_of(limit);
    EXPECT_GT(limit.most, 0);
    EXPECT_FALSE(std::string(limit.change).empty());
    // An order that is not known is among what is not verified.
    EXPECT_TRUE(limit.order != LimitOrder::unknown || *limit.not_verified) << id_of(limit);
  }
  const std::vector<std::string> names = engine_names();
  EXPECT_EQ(std::set(names.begin(), names.end()).size(), names.size());
  EXPECT_THROW(limits_of("quake"), Error);
  EXPECT_TRUE(limits_of("bevy").empty());
}

TEST(LightLimits, StandInTheManual) {
  const std::string page = file_bytes(std::filesystem::path(source_folder) / "docs" / "check.md");
  for (const EngineLimit& limit : engine_limits()) {
    EXPECT_THAT(page, testing::HasSubstr(fmt::format("\n| `{}` | {} ", id_of(limit), limit.most)));
    EXPECT_THAT(page, testing::HasSubstr(fmt::format("| {} | [source]({}) |", limit.versions, limit.source)));
  }
  for (const UnlimitedEngine& engine : unlimited_engines())
    EXPECT_THAT(page, testing::HasSubstr(engine.source));
}

// Lights at growing distances within the view; the first is the farthest. Others are beside it and behind.
TEST(LightLimits, AViewTakesSoManyOfTheLightsThatItSees) {
  for (const EngineLimit& limit : engine_limits()) {
    if (limit.scope != LimitScope::view) continue;
    const bool spots_too = limit.kinds == LimitKinds::each || limit.order == LimitOrder::points_first;
    for (const bool more : {false, true}) {
      Level level;
      if (spots_too) level.spot({0, 0, -2}, {0, 0, -3});
      const int points = limit.most - (limit.order == LimitOrder::points_first) + more;
      for (int i = 0; i < points; ++i) level.point({0.01f * float(i % 7), 0, -11 + 0.015f * float(i)});
      for (int i = 0; i < 40; ++i) {
        level.point({0, 0, 5});
        level.point({30, 0, -20});
      }
      const LimitResult result = result_of(level, id_of(limit));
      EXPECT_EQ(result.holds(), !more) << id_of(limit);
      EXPECT_EQ(result.worst.counted, size_t(limit.most) + more) << id_of(limit);
      if (!more) continue;
      const int first = spots_too;  // index of the first point light
      switch (limit.order) {
        case LimitOrder::nearest:
          EXPECT_THAT(dropped(result), ElementsAre(first));
          break;
        case LimitOrder::points_first:
          EXPECT_THAT(dropped(result), ElementsAre(0));
          break;
        default:
          EXPECT_THAT(dropped(result), ElementsAre(first + points - 1)) << id_of(limit);
      }
    }
  }
}

TEST(LightLimits, ALightIsSeenIfAPointOfItsRangeAndConeMayBe) {
  const auto counts = [](const std::function<void(Level&)>& add) {
    Level level;
    add(level);
    return result_of(level, "filament/view").worst.counted;
  };
  EXPECT_EQ(counts([](Level& l) { l.point({5, 0, -4}, 0.5f); }), 0u);  // 0.71 m beside the view
  EXPECT_EQ(counts([](Level& l) { l.point({5, 0, -4}, 0.8f); }), 1u);
  EXPECT_EQ(counts([](Level& l) { l.spot({5, 0, -4}, {0, 0, -4}, 5); }), 1u);
  EXPECT_EQ(counts([](Level& l) { l.spot({5, 0, -4}, {9, 0, 0}, 5); }), 0u);  // points away
  EXPECT_EQ(counts([](Level& l) { l.spot({3, 0, -4}, {9, 0, 0}, 5); }), 1u);  // from within
}

TEST(LightLimits, AMeshTakesSoManyOfTheLightsThatReachIt) {
  for (const EngineLimit& limit : engine_limits()) {
    if (limit.scope != LimitScope::mesh) continue;
    for (const bool more : {false, true}) {
      Level level;
      const int first = limit.kinds == LimitKinds::each ? limit.most : 0;
      for (int i = 0; i < first; ++i) level.spot({0, 0, -11.9f}, {0, 0, -13}, 1);
      for (int i = 0; i < limit.most + more; ++i) level.point({0.1f * float(i), 0, -11.9f}, 1);
      if (limit.reach != LimitReach::always)
        for (int i = 0; i < 20; ++i) level.point({0, 0, -5}, 1);
      const LimitResult result = result_of(level, id_of(limit));
      EXPECT_EQ(result.holds(), !more) << id_of(limit);
      EXPECT_EQ(result.worst.counted, size_t(limit.most) + more) << id_of(limit);
      if (!more) continue;
      EXPECT_THAT(dropped(result), ElementsAre(first + limit.most)) << id_of(limit);
      EXPECT_EQ(words_of(result.worst, level.scene), "frame 0, mesh 0 \"wall\"");
    }
  }
}

TEST(LightLimits, AMeshWithTooManyPointsAndTooManySpotsIsOnePlace) {
  Level level;
  for (int i = 0; i < 9; ++i) {
    level.spot({0, 0, -11.9f}, {0, 0, -13}, 1);
    level.point({0, 0, -11.9f}, 1);
  }
  const LimitResult result = result_of(level, "godot-mobile/mesh");
  EXPECT_EQ(result.places_over, 1u);
  EXPECT_EQ(result.dropped.size(), 2u);
}

TEST(LightLimits, ALightReachesAMeshAsTheEngineSays) {
  Level level;
  // 1 m from the wall's corner along each axis: out of a range of 1.5 m, but their boxes meet.
  for (int i = 0; i < 9; ++i) level.point({13, 13, -11}, 1.5f);
  EXPECT_EQ(result_of(level, "urp-forward/mesh").worst.counted, 0u);
  EXPECT_EQ(result_of(level, "godot-mobile/mesh").worst.counted, 9u);
  EXPECT_EQ(result_of(level, "babylon/mesh").worst.counted, 9u);
  level.scene.lights.clear();
  for (int i = 0; i < 9; ++i) level.spot({0, 0, -5}, {0, 1, -5}, 10);  // along the wall, 7 m before it
  EXPECT_EQ(result_of(level, "urp-forward/mesh").worst.counted, 9u);   // its range would reach it
  EXPECT_EQ(result_of(level, "godot-mobile/mesh").worst.counted, 0u);
  for (Light& light : level.scene.lights) set_groups(light, 2);
  set_groups(level.scene.instances[0], 1);
  EXPECT_EQ(result_of(level, "urp-forward/mesh").worst.counted, 0u);
}

TEST(LightLimits, PrimitivesOfANodeAreOneMesh) {
  Level level;
  level.add_wall("floor", {-10, -10, -11}, 5);
  level.add_wall("floor", {5, 5, -11}, 5);
  for (int i = 0; i < 5; ++i) {
    level.point({-8, -8, -11}, 0.5f);
    level.point({8, 8, -11}, 0.5f);
  }
  EXPECT_THAT(objects_of(level.scene), ElementsAre(0, 1, 1));
  EXPECT_EQ(result_of(level, "urp-forward/mesh").worst.counted, 10u);
  level.scene.instances[2].name = "ceiling";
  EXPECT_EQ(result_of(level, "urp-forward/mesh").worst.counted, 5u);
}

TEST(LightLimits, FilamentLightsNothingPastItsLastSlice) {
  Level level;
  level.point({0, 0, -150}, 60);
  EXPECT_TRUE(result_of(level, "filament/distance").holds());
  level.point({0, 0, -150}, 40);
  const LimitResult result = result_of(level, "filament/distance");
  EXPECT_THAT(dropped(result), ElementsAre(1));
  EXPECT_EQ(result.worst.counted, 1u);
}

// The cell of a place, by the formulas with which the engines' shaders look cells up.
glm::ivec3 looked_up(LimitCells layout, const View& view, double furthest_m, glm::dvec3 at) {
  const glm::dvec4 clip = view.clip_from_view * glm::dvec4(at, 1);
  const double x = (clip.x / clip.w + 1) / 2 * view.width, y = (clip.y / clip.w + 1) / 2 * view.height;
  if (layout == LimitCells::three)
    return {int(x / 32), int(y / 32), int(std::log(-at.z / view.near_m) / std::log(2000 / view.near_m) * 24)};
  const double n = view.near_m * 100 + 9.5, f = std::max(10.0, furthest_m) * 100 + 10;
  const double o = (f - n * std::exp2(31 / 4.05)) / (f - n), b = (1 - o) / n;
  const int slice = int(std::max(0.0, std::log2(std::max(1e-9, -at.z * 100 * b + o)) * 4.05));
  const int rows = (view.height + 63) / 64;
  return {int(x / 64), rows - 1 - int((view.height - y) / 64), std::min(slice, 31)};
}

TEST(LightLimits, ACellTakesSoManyLights) {
  for (const EngineLimit& limit : engine_limits()) {
    if (limit.scope != LimitScope::cell) continue;
    for (const bool more : {false, true}) {
      Level level;
      // One place, a little apart in depth: the first is the farthest.
      for (int i = 0; i < limit.most + more; ++i) level.point({1.5f, 1.5f, -12 + 1e-4f * float(i)}, 1e-3f);
      const LimitResult result = result_of(level, id_of(limit));
      EXPECT_EQ(result.holds(), !more) << id_of(limit);
      if (!more) continue;
      EXPECT_THAT(dropped(result), ElementsAre(limit.most)) << id_of(limit);
      EXPECT_EQ(result.places_over, 1u);
      EXPECT_EQ(result.worst.cell, looked_up(limit.cells, level.view, 12.001, {1.5, 1.5, -12}))
          << id_of(limit);
    }
  }
}

TEST(LightLimits, ACellDropsTheLightThatItsOrderSays) {
  Level level;
  const auto add_points = [&](int first, int end) {
    for (int i = first; i < end; ++i) level.point({1.5f, 1.5f, -12 - 1e-4f * float(i)}, 1e-3f);
  };
  add_points(0, 33);
  EXPECT_THAT(dropped(result_of(level, "unreal-fixed/cell")), ElementsAre(32));  // the last
  add_points(33, 65);
  EXPECT_THAT(dropped(result_of(level, "three-clustered/cell")), ElementsAre(0));  // the nearest
}

TEST(LightLimits, ThreeListsTheBallAroundASpotsCone) {
  Level level;
  for (int i = 0; i < 64; ++i) level.point({1.5f, 1.5f, -12}, 1e-3f);
  level.spot({1.5f, 1.5f, -20}, {1.5f, 1.5f, -21}, 9);  // away from the cell, which its range reaches
  EXPECT_TRUE(result_of(level, "three-clustered/cell").holds());
  level.spot({1.5f, 1.5f, -20}, {1.5f, 1.5f, -19}, 9);
  EXPECT_FALSE(result_of(level, "three-clustered/cell").holds());
}

TEST(LightLimits, CellsInEmptySpaceCountNot) {
  Level level;
  for (int i = 0; i < 70; ++i) level.point({0.1f, 0.1f, -3}, 1e-3f);
  EXPECT_TRUE(result_of(level, "three-clustered/cell").holds());
  EXPECT_TRUE(result_of(level, "unreal-fixed/cell").holds());
  level.add_wall("sign", {0, 0, -3}, 1);
  EXPECT_FALSE(result_of(level, "three-clustered/cell").holds());
  EXPECT_FALSE(result_of(level, "unreal-fixed/cell").holds());
}

TEST(LightLimits, UnrealsCellsShareARoom) {
  Level level;
  const int room = 32 * 10 * 10 * 32;
  for (int i = 0; i < room; ++i) level.point({1.5f, 1.5f, -12}, 1e-3f);  // in one cell each
  LimitResult result = result_of(level, "unreal/pool");
  EXPECT_TRUE(result.holds());
  EXPECT_EQ(result.worst.counted, size_t(room));
  EXPECT_EQ(result.most, size_t(room));
  level.point({1.5f, 1.5f, -12}, 1e-3f);
  result = result_of(level, "unreal/pool");
  EXPECT_FALSE(result.holds());
  EXPECT_EQ(result.dropped.size(), size_t(room) + 1);  // any of them
}

// Points within lights' ranges and cones, in any frame: the cell in which the engine's shader looks a point
// up lists its light.
TEST(LightLimits, ListsHoldTheLightsOfThePointsOfTheirCells) {
  Random random(7);
  Level level(512);
  for (int i = 0; i < 60; ++i) {
    const glm::vec3 at(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-20, 1));
    const float range = random.uniform(0.2f, 6);
    if (i % 2)
      level.spot(at, at + glm::vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)),
                 range);
    else
      level.point(at, range);
  }
  const std::vector<ViewLight> lights = lights_in_view(level.scene, level.view);
  std::vector<int> all;
  double furthest = 0;
  for (int i = 0; i < int(lights.size()); ++i) {
    all.push_back(i);
    furthest = std::max(furthest, lights[size_t(i)].radius_m - lights[size_t(i)].position.z);
  }
  for (const LimitCells layout : {LimitCells::three, LimitCells::unreal}) {
    std::vector<std::vector<int>> lists;
    size_t entries = 0;
    const glm::ivec3 cells =
        each_cell(layout, level.view, lights, all, [&](const glm::ivec3&, const LightBox&, const auto& list) {
          lists.push_back(list);
          entries += list.size();
        });
    int held = 0;
    for (int n = 0; n < 200000; ++n) {
      const size_t i = size_t(n) % lights.size();
      const ViewLight& light = lights[i];
      const glm::dvec3 away(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const glm::dvec3 at = light.position + away * light.radius_m;
      const double length = glm::length(away);
      if (length > 1 || -at.z < level.view.near_m || std::abs(at.x) > -at.z || std::abs(at.y) > -at.z)
        continue;
      if (has_cone(light) && glm::dot(away, light.direction) < light.cos_outer * length) continue;
      const glm::ivec3 cell = looked_up(layout, level.view, furthest, at);
      ASSERT_TRUE(glm::all(glm::lessThan(cell, cells)));
      const auto& list = lists[size_t(cell.x + cells.x * (cell.y + cells.y * cell.z))];
      EXPECT_THAT(list, testing::Contains(int(i)))
          << int(layout) << " at " << at.x << "," << at.y << "," << at.z;
      ++held;
    }
    EXPECT_GT(held, 5000);
    EXPECT_LT(entries, lights.size() * lists.size() / 4);  // not all in all
  }
}

TEST(LightLimits, FramesOfAPathAddUp) {
  Level level;
  for (int i = 0; i < 9; ++i) level.point({0.1f * float(i), 0, -11.9f}, 1);
  LightCheck check(limits_of("urp-forward"), {});
  check.count(level.scene, level.view);
  Camera back = look_at({0, 0, 0}, {0, 0, 1});
  check.count(level.scene, make_view(back, 64, 64));
  level.point({0, 0, -11.9f}, 1);
  check.count(level.scene, level.view);
  const LimitResult result = check.results()[1];
  EXPECT_EQ(id_of(*result.limit), "urp-forward/mesh");
  EXPECT_EQ(result.frames, 3u);
  EXPECT_EQ(result.frames_over, 2u);
  EXPECT_EQ(result.worst.frame, 2u);
  EXPECT_EQ(result.worst.counted, 10u);
  ASSERT_EQ(result.dropped.size(), 2u);
  EXPECT_EQ(result.dropped[0].light, 8);
  EXPECT_EQ(result.dropped[0].first.frame, 0u);
  EXPECT_EQ(result.dropped[0].places, 2u);
  EXPECT_EQ(result.dropped[1].first.frame, 2u);
}

TEST(LightLimits, ShorterRangesReachFewerMeshes) {
  Level level;
  for (int i = 0; i < 9; ++i)
    level.point({0.1f * float(i), 0, -10}, i == 8 ? 3.f : 9.f);  // 2 m before the wall
  for (const double factor : {1.0, 0.7, 0.6}) {
    LightCheck check(limits_of("urp-forward"), {}, factor);
    check.count(level.scene, level.view);
    EXPECT_EQ(check.results()[1].holds(), factor == 0.6) << factor;  // 1.8 m
  }
}

TEST(LightLimits, DirectionalAndDarkLightsTakeNoRoom) {
  Level level;
  for (int i = 0; i < 4; ++i) level.point({0, 0, -11.9f}, 1);
  level.scene.lights[1].type = LightType::directional;
  level.scene.lights[2].intensity = 0;
  EXPECT_EQ(result_of(level, "urp-forward/mesh").worst.counted, 2u);
  EXPECT_EQ(result_of(level, "babylon/mesh").worst.counted, 3u);  // a directional light too
}

TEST(LightLimits, PicturesAreOfSettingsOrScenesThatAreLikeTheLimit) {
  Level level;
  level.point({0, 0, -5}, 1);
  std::string why;
  const auto picture = [&](const char* id) {
    why.clear();
    for (const EngineLimit& limit : engine_limits())
      if (id_of(limit) == id) return limit_picture(limit, level.scene, why);
    return std::optional<LimitPicture>();
  };
  EXPECT_EQ(picture("filament/view")->limited, "visibility:view-cap=256");
  EXPECT_TRUE(picture("playcanvas/view")->without_lost);
  EXPECT_EQ(picture("godot-mobile/mesh")->limited, "forward_zprepass:list-cap=8");
  EXPECT_EQ(picture("godot-mobile/mesh")->note, "");
  level.add_wall("wall", {-1, -1, -5}, 1);
  EXPECT_THAT(picture("godot-mobile/mesh")->note, testing::HasSubstr("all primitives of a node together"));
  level.spot({0, 0, -5}, {0, 0, -6}, 1);
  EXPECT_FALSE(picture("godot-mobile/mesh"));  // one of each kind
  EXPECT_FALSE(picture("three-clustered/cell"));
  EXPECT_THAT(why, testing::HasSubstr("farthest"));
}

// view-cap of plans, which draws the same limit, leaves the same lights out.
TEST(LightLimits, TheNearestOfAViewAreThoseOfViewCap) {
  Random random(3);
  Level level;
  for (int i = 0; i < 700; ++i) {
    const glm::vec3 at(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-30, 5));
    level.point(at, random.uniform(0.5f, 3));
  }
  Settings settings;
  settings.set(setting::view_cap, 256);
  const FramePlan plan = plan_frame(level.scene, level.view, settings, find_technique("visibility").needs);
  ASSERT_EQ(plan.lights.left_out.size(), plan.lights.local.size());
  const LimitResult result = result_of(level, "filament/view");
  ASSERT_FALSE(result.holds());
  std::vector<int> left_out;
  const std::vector<ViewLight> lights = lights_in_view(level.scene, level.view);
  const Frustum frustum = frustum_of(level.view);
  for (size_t i = 0; i < plan.lights.local.size(); ++i) {
    const ViewLight& light = lights[size_t(plan.lights.local[i])];
    if (plan.lights.left_out[i] && may_see_sphere(frustum, light.position, light.radius_m))
      left_out.push_back(plan.lights.local[i]);
  }
  EXPECT_EQ(dropped(result), left_out);
  EXPECT_EQ(result.lost.size(), left_out.size());
}

}  // namespace
}  // namespace lightgrid::lab
