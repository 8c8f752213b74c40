// The properties that culling derives from a view's matrices, compared with the numbers that they were made
// from.
#include "culling/cull_view.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "culling/projections.h"
#include "support/error_of.h"

namespace lightgrid {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(SliceEdges, AreTheInnerOnesOnly) {
  EXPECT_THAT(slice_edges(SliceSpacing::linear, 4, 0, 8), ElementsAre(2, 4, 6));
  EXPECT_THAT(slice_edges(SliceSpacing::exponential, 4, 1, 16), ElementsAre(2, 4, 8));
  EXPECT_TRUE(slice_edges(SliceSpacing::exponential, 1, 1, 16).empty());
}

TEST(SliceEdges, ThatGrowFromNothingBeginAtAThousandthOfFar) {
  for (const double near_m : {0.0, -5.0}) {
    EXPECT_THAT(slice_edges(SliceSpacing::exponential, 3, near_m, 1000),
                ElementsAre(testing::FloatEq(10), testing::FloatEq(100)));
  }
}

TEST(SliceEdges, Ascend) {
  for (const SliceSpacing spacing : {SliceSpacing::exponential, SliceSpacing::linear}) {
    const std::vector<float> edges = slice_edges(spacing, 64, 0.1, 1000);
    ASSERT_EQ(edges.size(), 63u);
    EXPECT_TRUE(std::adjacent_find(edges.begin(), edges.end(), std::greater_equal<>()) == edges.end());
    EXPECT_GT(edges.front(), 0.1f);
    EXPECT_LT(edges.back(), 1000);
  }
}

TEST(CullViewOf, EveryProjectionIsReadOffItsMatrix) {
  for (const Projection& made : projections()) {
    SCOPED_TRACE(made.name);
    const CullView view = view_through(made, 127, 73);
    EXPECT_NO_THROW(check_view(view, 16));
    EXPECT_EQ(is_orthographic(view), made.orthographic);
    EXPECT_EQ(has_standard_depth(view), made.standard);
    EXPECT_NEAR(near_distance(view), made.near_m, 1e-12);
    EXPECT_NEAR(made.depth_at(made.near_m), made.standard ? 0 : 1, 1e-12);  // the test's own matrices
  }
}

TEST(CullViewOf, PixelsAndDepthsLeadBackToThePlaceTheyWereMadeFrom) {
  for (const Projection& made : projections()) {
    SCOPED_TRACE(made.name);
    const CullView view = view_through(made, 127, 73);
    const ViewParams v = view_params(view, 16);
    const CullParams p = cull_params(view, 16);
    for (const glm::dvec3 place :
         {glm::dvec3(0, 0, -2), glm::dvec3(0.7, -0.4, -3), glm::dvec3(-2, 1.5, -40)}) {
      const glm::dvec4 clip = made.clip_from_view * glm::dvec4(place, 1);
      const glm::dvec2 pixel = (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(view.width, view.height);
      const double d = -place.z, tip = made.orthographic ? 1 : d, depth = clip.z / clip.w;
      EXPECT_NEAR(pixel.x * v.slope_x_scale + v.slope_x_offset, place.x / tip, 1e-5);
      EXPECT_NEAR(pixel.y * v.slope_y_scale + v.slope_y_offset, place.y / tip, 1e-5);
      EXPECT_NEAR(place.x / tip * p.tile_x_scale + p.tile_x_offset, pixel.x / 16, 1e-5);
      EXPECT_NEAR(place.y / tip * p.tile_y_scale + p.tile_y_offset, pixel.y / 16, 1e-5);
      // depth_b and the second part of depth_a are float: relative to d, and to the whole range in standard
      // depth.
      const double distance = made.orthographic ? (p.depth_b - depth) * p.depth_a
                                                : p.depth_b / (depth + p.depth_a + p.depth_a_rest);
      EXPECT_NEAR(distance, d, 1e-5 * std::max(d, 10.0));
    }
    EXPECT_EQ(p.orthographic, made.orthographic ? 1u : 0u);
    EXPECT_EQ(p.standard_depth, made.standard ? 1u : 0u);
    EXPECT_FLOAT_EQ(v.near_distance, float(made.near_m));
  }
}

TEST(CullViewOf, TilesAndBinsCoverTheImage) {
  const auto counts = [](int width, int height, int tile) {
    const CullParams p = cull_params(view_through(projections()[0], width, height), tile);
    return std::vector<uint>{p.tiles_x, p.tiles_y, p.bins_x, p.bins_y, p.slices};
  };
  EXPECT_THAT(counts(1, 1, 16), ElementsAre(1, 1, 1, 1, 1));
  EXPECT_THAT(counts(17, 9, 8), ElementsAre(3, 2, 1, 1, 1));
  EXPECT_THAT(counts(128, 129, 16), ElementsAre(8, 9, 1, 2, 1));
  EXPECT_THAT(counts(1279, 721, 16), ElementsAre(80, 46, 10, 6, 1));
}

// d points away from the viewer: the reversed third axis.
TEST(CullViewOf, AxesAreTheRowsOfTheRotation) {
  CullView view = view_through(projections()[0], 64, 64);
  view.view_from_world = glm::rotate(glm::dmat4(1), 0.6, glm::normalize(glm::dvec3(1, 2, 3)));
  view.slice_edges = {1, 2, 3};
  const CullParams p = cull_params(view, 16);
  const glm::dvec3 world(3, -7, 2);
  const glm::dvec3 seen = glm::dmat3(view.view_from_world) * world;
  EXPECT_NEAR(p.x_axis_x * world.x + p.x_axis_y * world.y + p.x_axis_z * world.z, seen.x, 1e-5);
  EXPECT_NEAR(p.y_axis_x * world.x + p.y_axis_y * world.y + p.y_axis_z * world.z, seen.y, 1e-5);
  EXPECT_NEAR(p.d_axis_x * world.x + p.d_axis_y * world.y + p.d_axis_z * world.z, -seen.z, 1e-5);
  EXPECT_EQ(p.slices, 4u);
}

struct WrongView {
  std::function<void(CullView&)> spoil;
  const char* message;
};

TEST(CheckView, NamesWhatMakesNoView) {
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  const std::vector<WrongView> wrong = {
      {[](CullView& v) { v.width = 0; }, "0 x 73 pixels"},
      {[](CullView& v) { v.height = -1; }, "127 x -1 pixels"},
      {[](CullView& v) { v.width = 32000 * 16 + 1; }, "512001 x 73 pixels"},
      {[&](CullView& v) { v.clip_from_view[3][2] = nan; }, "clip_from_view[2][3] is nan"},
      {[&](CullView& v) { v.view_from_world[1][0] = infinity; }, "view_from_world[0][1] is inf"},
      {[](CullView& v) { v.clip_from_view[2][3] = 1; }, "last row is [0 0 1 0], neither"},  // looks along +z
      {[](CullView& v) { v.clip_from_view[0][0] = 0; }, "clip_from_view[0][0] is 0, not above 0"},
      {[](CullView& v) { v.clip_from_view[1][1] = -1; },
       "clip_from_view[1][1] is -1, not above 0"},                                             // upside down
      {[](CullView& v) { v.clip_from_view[3][2] = 0; }, "depth does not depend on distance"},  // near 0
      {[](CullView& v) { v.clip_from_view = glm::dmat4(0); }, "last row is [0 0 0 0], neither"},
      {[](CullView& v) { v.view_from_world[0][0] = 2; }, "view_from_world is not rigid"},
      {[](CullView& v) { v.view_from_world[2] = v.view_from_world[1]; }, "view_from_world is not rigid"},
  };
  for (const WrongView& w : wrong) {
    CullView view = view_through(projections()[0], 127, 73);
    w.spoil(view);
    EXPECT_THAT(error_of([&] { check_view(view, 16); }), HasSubstr(w.message));
  }
}

TEST(CheckView, TakesTheLargestSize) {
  EXPECT_NO_THROW(check_view(view_through(projections()[0], 32000 * 16, 1), 16));
  EXPECT_THROW(check_view(view_through(projections()[0], 32000 * 16, 1), 8), Error);
}

}  // namespace
}  // namespace lightgrid
