// The image of normals, decoded here by the formulas of docs/details/light_prepass.md#normals.
#include "passes/depth_prepass.h"

#include <cmath>

#include <gtest/gtest.h>

#include "passes/common/prepass_settings.h"
#include "passes/read_outs.h"
#include "renderer/render_view.h"
#include "support/devices.h"
#include "support/small_scene.h"
#include "support/wall_of_normals.h"

namespace lightgrid {
namespace {

glm::dvec3 decoded(NormalFormat format, glm::dvec3 t) {
  if (format == NormalFormat::floats) return t;
  if (format == NormalFormat::xyz8) return glm::normalize((glm::round(t * 255.0) - 128.0) / 127.0);
  const glm::dvec2 uv = (glm::round(glm::dvec2(t) * 65535.0) - 32768.0) / 32767.0;
  if (format == NormalFormat::spheremap) {
    const double r = std::min(glm::length(uv), 1.0), angle = 2 * std::asin(r);
    return r == 0 ? glm::dvec3(0, 0, 1) : glm::dvec3(uv / glm::length(uv) * std::sin(angle), std::cos(angle));
  }
  glm::dvec3 n(uv, 1 - std::abs(uv.x) - std::abs(uv.y));
  if (n.z < 0) n = {std::copysign(1 - std::abs(uv.y), uv.x), std::copysign(1 - std::abs(uv.x), uv.y), n.z};
  return glm::normalize(n);
}

double angle_deg(glm::dvec3 a, glm::dvec3 b) {
  return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

// Half a step in each channel, seen as an angle. The sphere map's steps are 2 of its radius near +z, and grow
// without bound towards -z, where few visible surfaces face.
TEST(FillNormals, KeepsEveryDirectionWithinItsSteps) {
  const Scene scene = wall_of_normals(80, 4);
  Camera camera = look_at({0, 0, 0}, {0, 0, -1});
  camera.fov_y_rad = glm::radians(120.0);
  const View view = make_view(camera, 160, 160);
  GpuScene gpu(test_devices(), scene);
  for (const auto& [format, front_deg, all_deg] :
       {std::tuple(NormalFormat::floats, 0.0, 0.0), std::tuple(NormalFormat::octahedral, 0.0038, 0.0038),
        std::tuple(NormalFormat::spheremap, 0.0036, 0.8), std::tuple(NormalFormat::xyz8, 0.4, 0.4)}) {
    RenderView v(test_devices(), gpu, view, {{setting::normals, format}}, {});
    const NormalImage normals = fill_normals(v);
    std::vector<glm::vec4> stored(v.grid().values());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, normals.framebuffer);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, view.width, view.height, GL_RGBA, GL_FLOAT, stored.data());
    const Image drawn = read_surfaces(v).normal_roughness;
    double front = 0, all = 0;
    for (size_t i = 0; i < stored.size(); ++i) {
      const glm::dvec3 normal(glm::vec3(drawn.pixels[i]));
      ASSERT_GT(glm::length(normal), 0.9);
      const double apart = angle_deg(decoded(format, glm::vec3(stored[i])), normal);
      (normal.z > 0 ? front : all) = std::max(normal.z > 0 ? front : all, apart);
    }
    EXPECT_LE(front, front_deg + 1e-5) << int(format);
    EXPECT_LE(all, all_deg + 1e-5) << int(format);
    EXPECT_GE(front, 0.5 * front_deg) << int(format) << ": the bound is the format's own";
  }
}

}  // namespace
}  // namespace lightgrid
