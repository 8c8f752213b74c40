// The surfaces read back from the geometry buffer.
#include "passes/fill_gbuffer.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "passes/read_outs.h"
#include "passes/surfaces.h"
#include "plan/settings/surfaces.h"
#include "shared/model_records.h"
#include "support/devices.h"
#include "support/small_scene.h"
#include "support/wall_of_normals.h"

namespace lightgrid {
namespace {

// The wall fills it.
View wide_view(int width, int height) {
  Camera camera = look_at({0, 0, 0}, {0, 0, -1});
  camera.fov_y_rad = glm::radians(90.0);
  return make_view(camera, width, height);
}

struct Surfaces {
  SurfaceImages drawn, kept;
  size_t gbuffer_bytes;
};

Surfaces surfaces_of(const Scene& scene, const View& view, int bits, bool after_prepass = false) {
  GpuScene gpu(test_devices(), scene);
  RenderView v(test_devices(), gpu, view, {{setting::buffer_bits, bits}}, {});
  if (after_prepass) {
    fill_gbuffer(v, find_surfaces(v).drawn);
  } else {
    fill_gbuffer(v);
  }
  return {read_surfaces(v), read_gbuffer_surfaces(v), v.targets.bytes(TargetUse::gbuffer)};
}

double angle_deg(const glm::vec4& a, const glm::vec4& b) {
  const glm::dvec3 u(a), v(b);
  return glm::degrees(std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)));
}

// Cigolle et al. (2014) give 0.95 degrees for 16 bits in all and 0.0037 for 32. Float stores normals
// directly.
TEST(FillGbuffer, KeepsNormalsOfAllDirectionsWithinTheirSteps) {
  const Scene scene = wall_of_normals(200, 2);
  for (const auto& [bits, bound_deg] : {std::pair(8, 0.96), std::pair(16, 0.0038), std::pair(32, 0.0)}) {
    const Surfaces s = surfaces_of(scene, wide_view(400, 400), bits);
    double largest = 0;
    for (size_t i = 0; i < s.drawn.normal_roughness.pixels.size(); ++i) {
      largest =
          std::max(largest, angle_deg(s.kept.normal_roughness.pixels[i], s.drawn.normal_roughness.pixels[i]));
    }
    EXPECT_LE(largest, bound_deg) << bits;
    EXPECT_GE(largest, 0.5 * bound_deg) << bits << ": the bound is the encoding's own";
    RecordProperty("largest_deg_" + std::to_string(bits), std::to_string(largest));
  }
}

// Where a normal map bends the base but not its coat. Float stores the octahedral coordinates of the coat's
// normal, 24 bits each.
TEST(FillGbuffer, KeepsNormalsOfCoats) {
  Scene scene = wall_of_normals(100, 2);
  scene.materials[0].clearcoat = 1;
  for (const bool bent : {false, true}) {
    if (bent) scene.materials[0].normal_map.texture = add_speckles(scene, false);
    for (const auto& [bits, bound_deg] :
         {std::pair(8, 0.96), std::pair(16, 0.0038), std::pair(32, bent ? 3e-5 : 0.0)}) {
      const Surfaces s = surfaces_of(scene, wide_view(200, 200), bits);
      double largest = 0, apart = 0;
      for (size_t i = 0; i < s.drawn.coat_factor.pixels.size(); ++i) {
        ASSERT_EQ(s.drawn.coat_factor.pixels[i].r, 1);
        ASSERT_EQ(s.kept.coat_factor.pixels[i].r, 1);
        const glm::vec4& drawn = s.drawn.coat_normal_roughness.pixels[i];
        largest = std::max(largest, angle_deg(s.kept.coat_normal_roughness.pixels[i], drawn));
        apart = std::max(apart, angle_deg(s.drawn.normal_roughness.pixels[i], drawn));
      }
      EXPECT_LE(largest, bound_deg) << bits;
      EXPECT_GE(largest, 0.1 * bound_deg) << bits;
      if (bent) {
        EXPECT_GT(apart, 1);
      } else {
        EXPECT_EQ(apart, 0);
      }
    }
  }
}

TEST(FillGbuffer, KeepsNormalsAlongAxesAsTheyAre) {
  SmallScene s = small_scene();
  s.scene.instances.pop_back();  // the wall alone
  for (const int bits : {8, 16, 32}) {
    const Surfaces surfaces = surfaces_of(s.scene, wide_view(33, 17), bits);
    const auto &drawn = surfaces.drawn.normal_roughness.pixels, &kept = surfaces.kept.normal_roughness.pixels;
    for (size_t i = 0; i < drawn.size(); ++i) {
      if (glm::vec3(drawn[i]) != glm::vec3(0)) {
        ASSERT_EQ(glm::vec3(kept[i]), glm::vec3(0, 0, 1)) << bits;
      }
    }
  }
}

// A model's number is stored exactly, in every layout and up to the last: its parameters are those of the
// material.
TEST(FillGbuffer, KeepsTheNumbersOfModels) {
  Scene scene = wall_of_normals(16, 2);
  for (int i = 0; i < MOST_MODELS; ++i) {
    Material& m = scene.materials.emplace_back(scene.materials[0]);
    m.model.minnaert_k = 0.003f * float(i + 1);
  }
  for (const int number : {1, 2, 127, MOST_MODELS}) {
    scene.meshes[0].material = number;
    for (const int bits : {8, 16, 32}) {
      const Surfaces s = surfaces_of(scene, wide_view(9, 9), bits);
      for (size_t i = 0; i < s.kept.model.pixels.size(); ++i) {
        ASSERT_EQ(s.drawn.model.pixels[i].r, number);
        ASSERT_EQ(s.kept.model.pixels[i].r, number) << bits;
        ASSERT_NEAR(s.kept.base_color_metallic.pixels[i].a, 0.6, bits == 8 ? 0.51 / 255 : 2e-5)
            << bits << ": beside it";
        ASSERT_GT(s.kept.emissive_occlusion.pixels[i].a, 0) << "lit";
      }
    }
  }
  scene.materials.emplace_back(scene.materials[0]).model.minnaert_k = 1.5f;
  const auto refusal = [&] {
    try {
      surfaces_of(scene, wide_view(9, 9), 8);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_NE(refusal().find("255 models of skin and Minnaert; a geometry buffer numbers at most 254"),
            std::string::npos)
      << refusal();
}

// Half a step of the stored value, in 8 bits of a square root, whose slope is at most 2; plus float's
// rounding of texture coordinates, times the texture's slope, if the two programs compute them differently.
TEST(FillGbuffer, KeepsMaterialsWithinHalfAStep) {
  SmallScene s = small_scene();
  for (const SceneEffect& effect : effects()) {
    if (effect.name != "blend" && effect.name != "mask") effect.add(s);
  }
  for (const auto& [bits, color_bound, bound] :
       {std::tuple(8, 1.01f / 255, 0.51f / 255), std::tuple(16, 0.51f / 65535, 0.51f / 65535),
        std::tuple(32, 1e-6f, 1e-6f)}) {
    const Surfaces surfaces = surfaces_of(s.scene, wide_view(127, 73), bits);
    int lit = 0, unlit = 0, coated = 0, reflective = 0;
    for (size_t i = 0; i < surfaces.drawn.normal_roughness.pixels.size(); ++i) {
      const glm::vec4 drawn = surfaces.drawn.base_color_metallic.pixels[i],
                      kept = surfaces.kept.base_color_metallic.pixels[i];
      for (int c = 0; c < 3; ++c)
        ASSERT_LE(std::abs(kept[c] - drawn[c]), color_bound) << bits << " bits, pixel " << i;
      ASSERT_LE(std::abs(kept.a - drawn.a), bound);
      ASSERT_LE(
          std::abs(surfaces.kept.normal_roughness.pixels[i].a - surfaces.drawn.normal_roughness.pixels[i].a),
          bound);
      ASSERT_LE(std::abs(surfaces.kept.coat_factor.pixels[i].r - surfaces.drawn.coat_factor.pixels[i].r),
                bound);
      if (surfaces.drawn.coat_factor.pixels[i].r > 0) {
        ASSERT_LE(std::abs(surfaces.kept.coat_normal_roughness.pixels[i].a -
                           surfaces.drawn.coat_normal_roughness.pixels[i].a),
                  bound);
        ++coated;
      }
      const glm::vec4 reflectance = surfaces.drawn.specular.pixels[i],
                      kept_reflectance = surfaces.kept.specular.pixels[i];
      for (int c = 0; c < 3; ++c)
        ASSERT_LE(std::abs(kept_reflectance[c] - reflectance[c]), bits == 32 ? bound : 2 * bound);
      ASSERT_LE(std::abs(kept_reflectance.a - reflectance.a), bound);
      reflective += glm::vec3(reflectance) != glm::vec3(0.04f) && reflectance.a > 0;
      // Background is not reached by lights: as if unlit.
      const bool nothing = glm::vec3(surfaces.drawn.normal_roughness.pixels[i]) == glm::vec3(0);
      const bool is_unlit = surfaces.drawn.emissive_occlusion.pixels[i].a < 0;
      ASSERT_EQ(surfaces.kept.emissive_occlusion.pixels[i].a < 0, nothing || is_unlit);
      ++(is_unlit ? unlit : lit);
    }
    EXPECT_GT(lit, 100);
    EXPECT_GT(unlit, 100);
    EXPECT_GT(coated, 100);
    EXPECT_GT(reflective, 100);
  }
}

TEST(FillGbuffer, IsTheSameAfterADepthPrepass) {
  SmallScene s = small_scene();
  for (const SceneEffect& effect : effects()) effect.add(s);
  const Surfaces alone = surfaces_of(s.scene, wide_view(127, 73), 32);
  const Surfaces after = surfaces_of(s.scene, wide_view(127, 73), 32, true);
  EXPECT_EQ(alone.kept.normal_roughness.pixels, after.kept.normal_roughness.pixels);
  EXPECT_EQ(alone.kept.base_color_metallic.pixels, after.kept.base_color_metallic.pixels);
  EXPECT_EQ(alone.kept.emissive_occlusion.pixels, after.kept.emissive_occlusion.pixels);
}

TEST(FillGbuffer, TakesTheBytesThatItsTableSays) {
  SmallScene coated = small_scene(), specular = small_scene();
  effect("clearcoat").add(coated);
  effect("specular").add(specular);
  const Scene scene = small_scene().scene;
  for (const auto& [bits, bytes] : {std::pair(8, 8), std::pair(16, 16), std::pair(32, 32)}) {
    EXPECT_EQ(surfaces_of(scene, wide_view(17, 9), bits).gbuffer_bytes, size_t(17 * 9 * bytes));
    for (const GBufferLayout& layout : gbuffer_layouts) {
      if (layout.bits == bits) {
        EXPECT_EQ(layout.bytes({0, 1}), size_t(bytes));
        EXPECT_EQ(surfaces_of(coated.scene, wide_view(17, 9), bits).gbuffer_bytes,
                  size_t(17 * 9 * bytes * 3 / 2));
        EXPECT_EQ(surfaces_of(specular.scene, wide_view(17, 9), bits).gbuffer_bytes,
                  size_t(17 * 9 * bytes * 3 / 2));
      }
    }
  }
}

// OpenCL's input: the stored integers, as described in gbuffer.h.
TEST(FillGbuffer, ReadsAsThePlainBytesThatItsTableExplains) {
  const Scene scene = wall_of_normals(16, 2);
  const View view = wide_view(32, 32);
  GpuScene gpu(test_devices(), scene);
  RenderView v(test_devices(), gpu, view, {{setting::buffer_bits, 16}}, {});
  const GBuffer g = fill_gbuffer(v);
  std::vector<glm::u16vec4> stored(32 * 32);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, g.framebuffer);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glReadPixels(0, 0, 32, 32, GL_RGBA, g.layout->images[0].type, stored.data());
  const SurfaceImages kept = read_gbuffer_surfaces(v);
  for (size_t i = 0; i < stored.size(); ++i) {
    const glm::dvec2 uv = (glm::dvec2(stored[i]) - 32768.0) / 32767.0;
    glm::dvec3 n(uv, 1 - std::abs(uv.x) - std::abs(uv.y));
    if (n.z < 0) n = {std::copysign(1 - std::abs(uv.y), uv.x), std::copysign(1 - std::abs(uv.x), uv.y), n.z};
    ASSERT_LT(angle_deg(glm::vec4(glm::normalize(n), 0), kept.normal_roughness.pixels[i]), 2e-5) << i;
    ASSERT_EQ(stored[i].b, std::lround(0.4f * 65535)) << "roughness";
    ASSERT_EQ(stored[i].a, std::lround(0.6f * 65535)) << "metallic";
  }
}

}  // namespace
}  // namespace lightgrid
