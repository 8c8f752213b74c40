// Views with an oblique near plane: mirrors and portals. Positions are the oracle's, in double.
#include "culling/view_depth.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "base/error.h"
#include "culling/culled_grid.h"
#include "oracle/lit_set.h"
#include "oracle/position.h"
#include "scene/random.h"

namespace lightgrid {
using namespace lab;
namespace {

constexpr int width = 83, height = 51;

// A depth row whose near plane is dot(normal, p) = -distance, p in view space (Lengyel 2005): depth is one
// end there and grows to the other.
View mirror_view(double fov_deg, const glm::dvec3& normal, double distance, bool standard) {
  View view = view_of(width, height, fov_deg);
  const glm::dvec4 plane(-glm::normalize(normal), -distance);  // positive beyond the plane, seen from the eye
  glm::dmat4& clip = view.clip_from_view;
  // Standard depth is a multiple of the plane's distance over w; reversed is 1 less that. The multiple makes
  // the farthest corner's direction come to 1 at infinity.
  double steepest = 0;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      const glm::dvec3 ray(x / clip[0][0], y / clip[1][1], -1);
      steepest = std::max(steepest, glm::dot(glm::dvec3(plane), ray));
    }
  }
  for (int c = 0; c < 4; ++c) {
    const double value = plane[c] / steepest, w = c == 2 ? -1 : 0;
    clip[c][2] = standard ? value : w - value;
  }
  return view;
}

CullView culled(const View& view) {
  return {view.width, view.height, view.clip_from_view, glm::dmat4(1), glm::dvec3(0)};
}

struct Mirror {
  const char* name;
  View view;
  bool standard;
};

std::vector<Mirror> mirrors() {
  const glm::dvec3 slanted(0.3, -0.2, 1), steep(0.4, 0.25, 0.8);
  return {{"slanted, reversed", mirror_view(60, slanted, 0.7, false), false},
          {"slanted, standard", mirror_view(60, slanted, 0.7, true), true},
          {"steep, reversed", mirror_view(50, steep, 0.5, false), false},
          {"wide, standard", mirror_view(110, {0.1, 0.2, 1}, 2, true), true}};
}

// A surface at each pixel, with its depth in float. Distances between 1 and 30 times the plane's.
std::vector<float> random_surfaces(const Mirror& mirror, Random& random) {
  std::vector<float> depth;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double front = -position_from_depth(mirror.view, x, y, mirror.standard ? 0 : 1).z;
      const double distance = front * std::exp(3.4 * random.uniform());
      const glm::dvec3 at(view_x_of_pixel(mirror.view, x + 0.5) * distance,
                          view_y_of_pixel(mirror.view, y + 0.5) * distance, -distance);
      const glm::dvec4 clip = mirror.view.clip_from_view * glm::dvec4(at, 1);
      depth.push_back(float(clip.z / clip.w));
    }
  }
  return depth;
}

ListedLights lists_of(const CulledGrid& grid, int tile) {
  ListedLights lists;
  for (const glm::uvec2 cell : grid.cells) {
    lists.first.push_back(cell.x);
    lists.count.push_back(cell.y);
  }
  lists.indices = grid.indices;
  for (int i = 0; i < width * height; ++i) {
    lists.cell_of_pixel.push_back(uint32_t(i / width / tile * grid.grid.cells_x + i % width / tile));
  }
  return lists;
}

TEST(ObliqueView, TheTestsDepthsLieBetweenTheEnds) {
  for (const Mirror& mirror : mirrors()) {
    SCOPED_TRACE(mirror.name);
    EXPECT_TRUE(is_oblique(culled(mirror.view)));
    EXPECT_EQ(has_standard_depth(culled(mirror.view)), mirror.standard);
    Random random(1);
    for (const float depth : random_surfaces(mirror, random)) {
      ASSERT_GT(depth, 0);
      ASSERT_LT(depth, 1);
    }
  }
}

// Lights that barely reach a pixel's own position, and some that reach many.
TEST(ObliqueView, NoPixelLosesALight) {
  for (const Mirror& mirror : mirrors()) {
    Random random(2);
    const std::vector<float> depth = random_surfaces(mirror, random);
    std::vector<ViewLight> lights;
    for (int i = 0; i < 3000; ++i) {
      const int x = int(random.uniform() * width), y = int(random.uniform() * height);
      const glm::dvec3 at = position_from_depth(mirror.view, x, y, depth[size_t(y) * width + x]);
      const glm::dvec3 away = glm::dvec3(random.uniform(), random.uniform(), random.uniform()) - 0.5;
      const double reach = -at.z * std::pow(0.5, 10 * random.uniform());
      lights.push_back(point_light(at + glm::normalize(away) * reach, reach * (1 + 1e-6 * random.uniform())));
    }
    for (const DepthBoundsMode mode :
         {DepthBoundsMode::minmax, DepthBoundsMode::halfz_modified, DepthBoundsMode::mask32}) {
      for (const KernelShape shape : {KernelShape::lanes, KernelShape::group}) {
        SCOPED_TRACE(testing::Message() << mirror.name << " mode " << int(mode) << " shape " << int(shape));
        const CulledGrid grid =
            cull_depth(mirror.view, lights, depth, {.depth_bounds = mode, .shape = shape});
        const LitPairs pairs = count_pairs(mirror.view, depth, lights, lists_of(grid, 16));
        EXPECT_EQ(pairs.lost, 0u);
        EXPECT_GT(pairs.lit, 3000u);
        EXPECT_LT(pairs.listed, 100 * pairs.lit);
      }
    }
  }
}

TEST(ObliqueView, BoundsHoldSurfacesAndLittleMoreAndSkyIsNone) {
  for (const Mirror& mirror : mirrors()) {
    SCOPED_TRACE(mirror.name);
    const float sky = mirror.standard ? 1.0f : 0.0f;
    Random random(3);
    std::vector<float> depth = random_surfaces(mirror, random);
    for (int i = 0; i < width * height; ++i) {
      if (i % width < 16 || i % 7 == 0) depth[i] = sky;
    }
    LightCuller culler(test_device(), test_programs(), {});
    culler.set_view(culled(mirror.view));
    const std::vector<DepthInterval> bounds =
        culler.read_bounds(culler.depth_bounds({buffer_of(depth)}).opaque);
    for (size_t tile = 0; tile < bounds.size(); ++tile) {
      const int tiles_x = (width + 15) / 16, tx = int(tile) % tiles_x * 16, ty = int(tile) / tiles_x * 16;
      double near = 1e300, far = 0;
      for (int y = ty; y < std::min(ty + 16, height); ++y) {
        for (int x = tx; x < std::min(tx + 16, width); ++x) {
          const float value = depth[size_t(y) * width + x];
          if (value == sky) continue;
          const double distance = -position_from_depth(mirror.view, x, y, value).z;
          near = std::min(near, distance);
          far = std::max(far, distance);
        }
      }
      if (near > far) {
        EXPECT_GT(bounds[tile].near, bounds[tile].far);
        continue;
      }
      EXPECT_LE(bounds[tile].near, near);
      EXPECT_GE(bounds[tile].far, far);
      EXPECT_GE(bounds[tile].near, near * (1 - 1e-3));
      EXPECT_LE(bounds[tile].far, far * (1 + 1e-3));
    }
  }
}

std::string refusal_of(CullView view) {
  try {
    check_view(view, 16);
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
}

// Their edges are compared with stored depths, which here depend on the pixel's position.
TEST(ObliqueView, RefusesSlicesAndZBins) {
  CullView view = culled(mirrors()[0].view);
  EXPECT_EQ(refusal_of(view), "");
  view.slice_edges = {2, 4};
  EXPECT_THAT(refusal_of(view), testing::HasSubstr("slice_edges"));
  view.slice_edges.clear();
  view.z_bin_edges = {3};
  EXPECT_THAT(refusal_of(view), testing::HasSubstr("z_bin_edges"));
}

TEST(CheckView, RefusesByNameWhatCullingCannotDo) {
  const View straight = view_of(64, 48, 60), flat = orthographic_view_of(64, 48, 5, 0.1, 50);
  const auto with = [](const View& view, int row, int column, double value) {
    CullView changed = culled(view);
    changed.clip_from_view[column][row] = value;
    return refusal_of(changed);
  };
  using testing::HasSubstr;
  EXPECT_THAT(with(straight, 1, 0, 0.2), HasSubstr("clip_from_view[1][0] is 0.2, not 0: a shear"));
  EXPECT_THAT(with(straight, 0, 1, 0.2), HasSubstr("clip_from_view[0][1] is 0.2, not 0: a shear"));
  EXPECT_THAT(with(straight, 3, 0, 0.3), HasSubstr("tilted w row"));
  EXPECT_THAT(with(straight, 3, 1, 0.3), HasSubstr("tilted w row"));
  EXPECT_THAT(with(straight, 0, 3, 0.1), HasSubstr("a translation"));
  EXPECT_THAT(with(flat, 0, 2, 0.1), HasSubstr("a shear: clip x depends on z"));
  EXPECT_THAT(with(flat, 2, 1, 0.1), HasSubstr("an oblique near plane"));
  EXPECT_THAT(with(straight, 3, 3, 0.5), HasSubstr("last row"));
  CullView lost = culled(straight);
  lost.eye.y = NAN;
  EXPECT_THAT(refusal_of(lost), HasSubstr("eye[1] is nan"));
  EXPECT_THAT(refusal_of(culled(view_of(64, 48, 60, 1e16))), HasSubstr("near plane is at 1e+16 m"));
  EXPECT_THAT(refusal_of(culled(view_of(64, 48, 60, 3e-53))), HasSubstr("near plane is at 3e-53 m"));
  EXPECT_THAT(refusal_of(culled(orthographic_view_of(64, 48, 1e16, 0.1, 50))), HasSubstr("past 10^15 m"));
}

}  // namespace
}  // namespace lightgrid
