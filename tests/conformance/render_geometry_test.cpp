// Positions, sides and directions of geometry, in pictures of the conformance models.
#include "conformance/picture.h"

namespace lightgrid {
using namespace lab;
namespace {

#define NEEDS(model) LIGHTGRID_NEEDS_SHARED("scenes/conformance/" model)

TEST(RenderGeometry, OrientationTestPointsEachArrowAtItsTarget) {
  NEEDS("OrientationTest");
  const Scene scene = load_model("OrientationTest/OrientationTest.glb");
  struct Pair {
    glm::dvec3 side, target;
    Hue hue;
  };
  // Targets' centres are stored in the file; arrows are turned by their nodes.
  const Pair pairs[] = {
      {{5.4, 0, 0}, {5.4, 2.95, -2.13}, Hue::red},   {{-5.4, 0, 0}, {-5.4, 3.52, 0.34}, Hue::cyan},
      {{0, 5.4, 0}, {3.34, 5.4, -1.34}, Hue::green}, {{0, -5.4, 0}, {-0.82, -5.4, 3.47}, Hue::magenta},
      {{0, 0, 5.4}, {-1.01, 3.43, 5.4}, Hue::blue},  {{0, 0, -5.4}, {1.15, 3.39, -5.4}, Hue::yellow}};
  for (const Pair& pair : pairs) {
    const Picture p = picture_of(scene, look_at(3.0 * pair.side, glm::dvec3(0)));
    for (const double share : {0.2, 0.4, 0.6, 1.0}) {
      EXPECT_EQ(hue_of(p.at(pair.side + share * (pair.target - pair.side))), pair.hue)
          << "side " << pair.side.x << " " << pair.side.y << " " << pair.side.z << " at " << share;
    }
  }
}

TEST(RenderGeometry, NegativeScaleTestShowsOnlyChecksAndLightsBothScalesAlike) {
  NEEDS("NegativeScaleTest");
  const Picture p = picture_of(load_model("NegativeScaleTest/NegativeScaleTest.glb"), facing({2, -0.5}, 9));
  for (const double y : {1.07, 2.23}) {
    for (const double x : {-0.44, 1.44, 3.36}) {
      EXPECT_EQ(p.share(Hue::red, {x, y, 0}, {x + 0.9, y + 0.9, 0}), 0) << x << " " << y;
      EXPECT_GT(p.share(Hue::green, {x, y, 0}, {x + 0.9, y + 0.9, 0}), 0.05) << x << " " << y;
    }
  }
  for (const double y : {-1.0, -2.25}) {
    // As many pixels to the left and above as to the right and below, for spheres at equal distance from the
    // picture's centre.
    const auto sphere = [&](double x, double across, double up) {
      return p.at({x + across, y + up, 0.45}).b;
    };
    for (const double x : {1.0, 3.0})
      EXPECT_GT(sphere(x, -0.15, 0.15), 1.2f * sphere(x, 0.1, -0.25)) << x << " " << y;
    EXPECT_NEAR(sphere(1, 0, 0) / sphere(3, 0, 0), 1, 0.1) << y;
    EXPECT_NEAR(sphere(1, -0.15, 0.15) / sphere(3, -0.15, 0.15), 1, 0.1) << y;
  }
}

TEST(RenderGeometry, NodeHierarchyAddsUpTranslations) {
  NEEDS("02_node_hierarchy");
  const Picture p = picture_of(load_model("02_node_hierarchy/02_node_hierarchy.gltf"), facing({2, 2}, 10));
  EXPECT_FALSE(p.is_background({0, 0, 0}));
  EXPECT_FALSE(p.is_background({4, 4, 0}));
  EXPECT_TRUE(p.is_background({2, 2, 0}));
  EXPECT_TRUE(p.is_background({4, 0, 0}));
}

// Lit pixels of a row.
int width_of_row(const Picture& p, int y) {
  int lit = 0;
  for (int x = 0; x < p.view.width; ++x) lit += glm::vec3(p.image.at(x, y)) != glm::vec3(0);
  return lit;
}

TEST(RenderGeometry, CamerasOneIsPerspectiveAndTheOtherParallel) {
  NEEDS("Cameras");
  const Scene scene = load_model("Cameras/Cameras.gltf");
  const Picture perspective = picture_of(scene, "0"), parallel = picture_of(scene, "1");
  // ymag 1: two metres are 240 pixels high, the square of one metre is 120 wide at any tilt.
  const int top = parallel.pixel({0.5, 0.6, 0}).y, bottom = parallel.pixel({0.5, 0.1, 0}).y;
  EXPECT_NEAR(width_of_row(parallel, top), 120, 1);
  EXPECT_NEAR(width_of_row(parallel, bottom), 120, 1);
  // The square tilts away: in perspective its upper edge is narrower.
  EXPECT_GT(width_of_row(perspective, perspective.pixel({0.5, 0.1, 0}).y),
            width_of_row(perspective, perspective.pixel({0.5, 0.6, -0.6}).y) + 10);
}

TEST(RenderGeometry, MultipleScenesShowsTheDefaultOrTheOneAskedFor) {
  NEEDS("MultipleScenes");
  const Picture square =
      picture_of(load_model("MultipleScenes/MultipleScenes.gltf"), facing({0.5, 0.5}, 1.5));
  const Picture triangle =
      picture_of(load_model("MultipleScenes/MultipleScenes.gltf", 0), facing({0.5, 0.5}, 1.5));
  for (const Picture* p : {&square, &triangle}) EXPECT_FALSE(p->is_background({0.2, 0.2, 0}));
  EXPECT_FALSE(square.is_background({0.9, 0.9, 0}));
  EXPECT_TRUE(triangle.is_background({0.9, 0.9, 0}));
}

TEST(RenderGeometry, TriangleWithoutIndicesIsATriangle) {
  NEEDS("TriangleWithoutIndices");
  const Picture p =
      picture_of(load_model("TriangleWithoutIndices/TriangleWithoutIndices.gltf"), facing({0.5, 0.5}, 1.5));
  EXPECT_FALSE(p.is_background({0.3, 0.3, 0}));
  EXPECT_TRUE(p.is_background({0.6, 0.6, 0}));
}

TEST(RenderGeometry, SimpleSparseAccessorRaisesThreePeaks) {
  NEEDS("SimpleSparseAccessor");
  const Picture p =
      picture_of(load_model("SimpleSparseAccessor/SimpleSparseAccessor.gltf"), facing({3, 2}, 7));
  // The sparse values move three vertices of the upper row, y 1, up to 2, 3 and 4.
  for (const glm::dvec3& peak : {glm::dvec3(1, 1.8, 0), {3, 2.8, 0}, {5, 3.8, 0}})
    EXPECT_FALSE(p.is_background(peak));
  for (const double x : {2.0, 4.0}) EXPECT_TRUE(p.is_background({x, 1.5, 0})) << x;
  EXPECT_FALSE(p.is_background({3, 0.5, 0}));
}

TEST(RenderGeometry, InterpolationTestShowsNineCubes) {
  NEEDS("InterpolationTest");
  const Picture p =
      picture_of(load_model("InterpolationTest/InterpolationTest.glb"), look_at({0, 2.5, 20}, {0, 2.5, 0}));
  for (const double x : {-3.3, 0.0, 3.3}) {
    for (const double y : {0.0, 3.36, 6.7}) {
      EXPECT_FALSE(p.is_background({x, y, 1})) << x << " " << y;
      EXPECT_TRUE(p.is_background({x + 1.65, y, 1})) << x << " " << y;
    }
  }
}

TEST(RenderGeometry, BoxInterleavedIsARedBoxWithThreeShades) {
  NEEDS("BoxInterleaved");
  const Picture p = picture_of(load_model("BoxInterleaved/BoxInterleaved.glb"));
  const glm::vec3 top = p.at({0, 0.5, 0}), front = p.at({0, 0, 0.5}), right = p.at({0.5, 0, 0});
  for (const glm::vec3& face : {top, front, right}) EXPECT_EQ(hue_of(face), Hue::red);
  EXPECT_GT(top.r, 1.1f * front.r);
  EXPECT_GT(front.r, 1.1f * right.r);
}

TEST(RenderGeometry, SkinnedModelsStandInTheirRestPose) {
  NEEDS("SimpleSkin");
  const Picture strip = picture_of(load_model("SimpleSkin/SimpleSkin.gltf"), facing({0, 1}, 3));
  for (const double y : {0.1, 1.0, 1.9}) {
    EXPECT_FALSE(strip.is_background({0.4, y, 0})) << y;
    EXPECT_FALSE(strip.is_background({-0.4, y, 0})) << y;
    EXPECT_TRUE(strip.is_background({0.6, y, 0})) << y;
  }
  const Scene man = load_model("CesiumMan/CesiumMan.gltf");
  const WorldBox box = world_box(man);
  EXPECT_NEAR(box.max.y - box.min.y, 1.5, 0.1) << "upright, in metres";
  const Picture p = picture_of(man);
  EXPECT_GT(p.share(Hue::blue) + p.share(Hue::cyan), 0.005);
  EXPECT_GT(p.share(Hue::mixed), 0.02);
}

TEST(RenderGeometry, RecursiveSkeletonsStandAsFourColumns) {
  NEEDS("RecursiveSkeletons");
  const Scene scene = load_model("RecursiveSkeletons/RecursiveSkeletons.glb");
  EXPECT_GE(scene.instances.size(), 84u);
  const WorldBox box = world_box(scene);
  const glm::dvec3 center = (box.min + box.max) / 2.0;
  // From straight above: the middle is empty, the four quarters are not.
  const Picture p =
      picture_of(scene, look_at(center + glm::dvec3(0, 2 * (box.max.y - box.min.y), 0), center));
  EXPECT_TRUE(p.is_background(center));
  const int w = p.view.width, h = p.view.height;
  for (int quarter = 0; quarter < 4; ++quarter) {
    int lit = 0;
    for (int y = 0; y < h / 2; ++y) {
      for (int x = 0; x < w / 2; ++x) {
        lit += glm::vec3(p.image.at(x + (quarter & 1) * w / 2, y + (quarter >> 1) * h / 2)) != glm::vec3(0);
      }
    }
    EXPECT_GT(lit, 100) << quarter;
  }
}

TEST(RenderGeometry, MilkTruckStandsOnDarkWheelsUnderAWhiteBody) {
  NEEDS("CesiumMilkTruck");
  const Picture p =
      picture_of(load_model("CesiumMilkTruck/CesiumMilkTruck.glb"), look_at({7, 1.2, 0}, {0, 1.2, 0}));
  for (const double z : {-1.35, 1.43}) EXPECT_LT(p.at({1.06, 0.2, z}).g, 0.2f) << z;
  EXPECT_GT(p.at({1.4, 2.2, -2}).g, 0.3f) << "the body's upper corner";
  EXPECT_GT(p.share(Hue::blue) + p.share(Hue::cyan), 0.005) << "the logo's sky";
}

}  // namespace
}  // namespace lightgrid
