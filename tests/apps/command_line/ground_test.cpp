// The near plane of a camera that the command line places: the ground under an eye, and how exact its depth
// is.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include <glm/glm.hpp>

#include "support/gltf_builder.h"
#include "support/read_files.h"
#include "support/run_program.h"

namespace lightgrid::app {
namespace {

constexpr int across_px = 48, up_px = 36;
constexpr double eye_height_m = 1.7, fov_y_rad = std::numbers::pi / 3;

// Corners, also those that the near plane cuts, are snapped to 1/256 pixel: each edge of what a pixel sees
// turns by less than that, and two edges by less than twice that.
const double snapping_rad = 2 * std::tan(fov_y_rad / 2) / up_px / 128;

// A square on the ground, around the origin, of two triangles.
std::string ground(const ModelFolder& folder, float half_side_m) {
  GltfBuilder made = GltfBuilder::triangle();
  const float h = half_side_m;
  made.attribute("POSITION", std::vector<float>{-h, 0, -h, -h, 0, h, h, 0, h, h, 0, -h}, "VEC3", f32, 4);
  made.indices(std::vector<uint16_t>{0, 1, 2, 0, 2, 3}, u16);
  return folder.write("ground.gltf", made.text());
}

// The distance along the view axis at which the pixel's centre sees the endless ground; negative: nowhere.
double ground_distance(const glm::dvec3& forward, int x, int y) {
  const double slope = std::tan(fov_y_rad / 2);
  const double right = ((x + 0.5) / across_px * 2 - 1) * slope * across_px / up_px,
               up = ((y + 0.5) / up_px * 2 - 1) * slope;
  const glm::dvec3 across = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)));
  return -eye_height_m / (forward + right * across + up * glm::cross(across, forward)).y;
}

// Looks at the pixels that see the ground within 600 m. Returns the greatest relative error of a distance
// over what snapping the ground's corners explains, or infinity if one shows no surface.
double worst_error(const std::string& scene, const std::string& technique, const glm::dvec3& target) {
  const TempFolder folder;
  const std::string camera =
      fmt::format("eye:0,{},0,target:{},{},{}", eye_height_m, target.x, target.y, target.z);
  const ProgramRun run =
      run_program({"capture", scene, "--quiet", "--size", fmt::format("{}x{}", across_px, up_px), "--camera",
                   camera, "--lights", "1", "-t", technique, "-o", folder.path});
  EXPECT_EQ(run.status, 0) << run.err;
  const std::string bytes = file_bytes(folder.path / "depth.f32");
  std::vector<float> depth(size_t(across_px) * up_px);
  EXPECT_EQ(bytes.size(), depth.size() * sizeof(float));
  std::memcpy(depth.data(), bytes.data(), std::min(bytes.size(), depth.size() * sizeof(float)));
  const auto view = nlohmann::json::parse(file_bytes(folder.path / "view.json"));
  const double near = view["near"];
  const glm::dvec3 forward = glm::normalize(target - glm::dvec3(0, eye_height_m, 0));
  double worst = 0;
  int seen = 0;
  for (int y = 0; y < up_px; ++y) {
    for (int x = 0; x < across_px; ++x) {
      const double expected = ground_distance(forward, x, y);
      if (expected < 0 || expected > 600) continue;
      ++seen;
      const double error = std::abs(near / depth[size_t(y) * across_px + x] / expected - 1);
      worst = std::max(worst, error / (1e-5 + snapping_rad * expected / eye_height_m));
    }
  }
  EXPECT_GT(seen, across_px * up_px / 4);
  std::printf("%s: %d pixels, near %g m, worst error over its bound %.2g\n", technique.c_str(), seen, near,
              worst);
  return worst;
}

TEST(Ground, UnderAnEyeIsSeenInASceneOfTwoKilometres) {
  const ModelFolder folder;
  const std::string scene = ground(folder, 700);  // its diagonal is 1980 m
  for (const char* technique : {"forward_plus", "visibility"}) {
    EXPECT_LT(worst_error(scene, technique, {0, 0, -1}), 1);
    EXPECT_LT(worst_error(scene, technique, {0, eye_height_m, -1}), 1);
  }
}

}  // namespace
}  // namespace lightgrid::app
