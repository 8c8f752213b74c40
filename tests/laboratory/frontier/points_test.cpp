#include "frontier/points.h"

#include <gmock/gmock.h>

#include <set>

#include "base/error.h"
#include "frontier/view_figures.h"
#include "scenes/builtin.h"

namespace lightgrid::lab {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> labels(const std::vector<ChosenPoint>& points) {
  std::vector<std::string> all;
  for (const ChosenPoint& p : points) all.push_back(p.label);
  return all;
}

std::string refusal_of(const std::vector<std::string>& techniques, const std::vector<std::string>& vary) {
  try {
    chosen_points(techniques, vary, {}, true);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

TEST(FrontierPoints, AreAStarOfDistinctPointsWithEveryTechniqueAsItIs) {
  const std::vector<ChosenPoint> points = chosen_points({}, {}, {}, true);
  EXPECT_GE(4 * points.size(), 150u);  // over the four built-in scenes
  const std::vector<std::string> names = labels(points);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  for (const Technique* t : techniques()) EXPECT_THAT(names, testing::Contains(t->name));
}

TEST(FrontierPoints, NeedNoOpenGlWithoutIt) {
  for (const ChosenPoint& p : chosen_points({}, {}, {}, false))
    EXPECT_FALSE(draws_with_opengl(p.contestant.technique->needs, p.contestant.settings)) << p.label;
  EXPECT_EQ(baseline_point({}, false).label, "visibility");
  EXPECT_EQ(baseline_point({}, true).label, "forward_plus");
}

TEST(FrontierPoints, OfFamiliesAreEachTechniqueWithTheSameRanges) {
  const std::vector<std::string> names = labels(family_points({}, true));
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  for (const std::string technique : {"forward_plus", "clustered", "deferred_tiled", "visibility"}) {
    for (const char* ranges : {"", ":range=cutoff,cutoff=0.005", ":range=infinite", ":far-light=4096"})
      EXPECT_THAT(names, testing::Contains(technique + ranges));
  }
  EXPECT_THAT(names, testing::Contains("world_grid:raster=opencl"));
  for (const ChosenPoint& p : family_points({}, false))
    EXPECT_FALSE(draws_with_opengl(p.contestant.technique->needs, p.contestant.settings)) << p.label;
}

TEST(FrontierPoints, AreTimedOverABaselineOfChoice) {
  EXPECT_EQ(baseline_point({}, true, "visibility").label, "visibility");
  EXPECT_EQ(baseline_point({}, true, "forward_plus:tile=8,z-bins=16").label, "forward_plus:tile=8,z-bins=16");
  EXPECT_THROW(baseline_point({}, true, "forward,visibility"), Error);
  EXPECT_THROW(baseline_point({}, true, "no_such_technique"), Error);
}

TEST(FrontierPoints, VaryOneKeyAtATimeInTechniquesThatReadIt) {
  EXPECT_THAT(labels(chosen_points({"forward", "forward_plus", "tile=8"},
                                   {"cull-test=sphere,aabb", "z-bins=16"}, {}, true)),
              ElementsAre("forward", "forward_plus:tile=8", "forward_plus:cull-test=sphere,tile=8",
                          "forward_plus:cull-test=aabb,tile=8", "forward_plus:tile=8,z-bins=16"));
}

TEST(FrontierPoints, VaryWhatShadowMapsHave) {
  EXPECT_THAT(
      labels(chosen_points({"visibility", "visibility:shadows=map"},
                           {"shadow-size=64,512", "shadow-filter=pcf3"}, {}, true)),
      ElementsAre("visibility", "visibility:shadows=map", "visibility:shadows=map,shadow-size=64",
                  "visibility:shadows=map,shadow-size=512", "visibility:shadows=map,shadow-filter=pcf3"));
}

TEST(FrontierPoints, AverageFramesOfRandomRanges) {
  const auto points = chosen_points({"visibility:range=stochastic"}, {"frames=1,16"}, {}, true);
  EXPECT_THAT(labels(points),
              ElementsAre("visibility:range=stochastic", "visibility:range=stochastic,frames=16"));
  EXPECT_EQ(points[1].frames, 16);
}

TEST(FrontierPoints, OfAnUnknownKeyOrValueAreRefusedByName) {
  EXPECT_THAT(refusal_of({}, {"tiles=8"}), HasSubstr("tiles"));
  EXPECT_THAT(refusal_of({}, {"tile=9"}), HasSubstr("\"9\""));
  EXPECT_THAT(refusal_of({}, {"tile"}), HasSubstr("vary tile"));
  EXPECT_THAT(refusal_of({"forward"}, {"z-bins=16"}), HasSubstr("no technique reads z-bins"));
  EXPECT_THAT(refusal_of({"forward:z-bins=16"}, {}), HasSubstr("forward does not read z-bins"));
  EXPECT_THAT(refusal_of({"visibility:range=stochastic"}, {"frames=0"}), HasSubstr("frames: 0"));
  EXPECT_THAT(refusal_of({"visibility"}, {"frames=4"}), HasSubstr("frames"));
  EXPECT_THAT(refusal_of({"quick"}, {}), HasSubstr("quick"));
}

// Fewer views are spread over the path too.
TEST(FrontierViews, OfAnyPrefixAreSpreadOverThePath) {
  const Scene scene = find_builtin_scene("spheres")->make();
  const View start = make_view(choose_camera(scene, ""), 32, 18);
  SceneChoice choice;
  choice.scene = "spheres.glb";
  const std::vector<View> views = frontier_views(scene, start, choice, 8);
  ASSERT_EQ(views.size(), 8u);
  const auto forward = [](const View& v) {
    return glm::transpose(glm::dmat3(v.view_from_world)) * glm::dvec3(0, 0, -1);
  };
  const auto flat = [&](const View& v) { return glm::normalize(glm::dvec2(forward(v).x, forward(v).z)); };
  EXPECT_NEAR(glm::dot(flat(views[0]), flat(views[1])), -1, 1e-6) << "the second looks back";
  EXPECT_NEAR(glm::dot(flat(views[0]), flat(views[2])), 0, 1e-6) << "the third aside";
}

// The same views for everybody, whatever their number: the first of them from several places.
TEST(FrontierViews, OfASceneWithAFileAreThoseOfIt) {
  for (const char* name : {"hall", "terrain", "spheres", "street", "gallery", "particles"}) {
    const Scene scene = find_builtin_scene(name)->make();
    const View start = make_view(choose_camera(scene, ""), 32, 18);
    SceneChoice choice;
    choice.scene = name;
    const std::vector<View> views = frontier_views(scene, start, choice, 16),
                            few = frontier_views(scene, start, choice, 4);
    ASSERT_EQ(views.size(), 16u) << name;
    std::set<std::vector<double>> eyes, of_few, turns;
    for (size_t i = 0; i < views.size(); ++i) {
      const View& v = views[i];
      const std::vector<double> eye = {v.eye.x, v.eye.y, v.eye.z};
      eyes.insert(eye);
      std::vector<double> turn = eye;
      for (int c = 0; c < 3; ++c) turn.push_back(v.view_from_world[c].z);
      turns.insert(turn);
      if (i >= few.size()) continue;
      EXPECT_EQ(v.view_from_world, few[i].view_from_world) << name << " " << i;
      of_few.insert(eye);
    }
    EXPECT_EQ(eyes.size(), 4u) << name;
    EXPECT_EQ(of_few.size(), 4u) << name;
    EXPECT_EQ(turns.size(), 16u) << name;
    choice.camera = "0";
    EXPECT_EQ(frontier_views(scene, start, choice, 16)[1].eye, start.eye) << "a turn about a chosen camera";
  }
}

}  // namespace
}  // namespace lightgrid::lab
