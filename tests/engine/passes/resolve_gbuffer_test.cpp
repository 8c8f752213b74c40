// The geometry buffer that OpenCL fills: surfaces in double, the same bytes in every shape, and what fewer
// bits round.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cl/transfer.h"
#include "measures/metrics.h"
#include "passes/read_back.h"
#include "passes/resolve.h"
#include "plan/settings/kernels.h"
#include "plan/settings/surfaces.h"
#include "renderer/render_view.h"
#include "support/devices.h"
#include "support/double_surfaces.h"
#include "support/small_scene.h"

namespace lightgrid {
using namespace lab;
namespace {

constexpr TechniqueNeeds gbuffer_needs{.surfaces = {.opengl = false},
                                       .lists = {.light_grid = true, .z_bins = true, .no_masks = true}};

struct Filled {
  std::vector<uint8_t> bytes[gbuffer_most_images];
  Image image;
  std::vector<float> depth;
  std::vector<int> opaque;  // instances in drawing order

  template <typename Channel>
  glm::dvec4 texel(int which, size_t pixel) const {
    Channel c[4];
    std::memcpy(c, bytes[which].data() + pixel * sizeof c, sizeof c);
    return {c[0], c[1], c[2], c[3]};
  }
};

Filled filled(const Scene& scene, const View& view, const Settings& settings) {
  GpuScene gpu(test_devices(), scene);
  RenderView v(test_devices(), gpu, view, settings, gbuffer_needs);
  const VisibilityBuffer visible = rasterize(v, v.caches);
  const GBufferInCl g = resolve_gbuffer(v, v.caches.resolver, visible, BaseLighting::in_image);
  EXPECT_EQ(g.layout->bits, settings[setting::buffer_bits]);
  Filled f;
  for (const size_t i : g.images) {
    f.bytes[i].resize(v.grid().values() * g.layout->images[i].bytes);
    read_buffer(*v.renderer.cl, "reading surfaces", g.surfaces[i]->cl_buffer(), f.bytes[i].data(),
                f.bytes[i].size());
  }
  read_back(v, {0, g.image}, f.image);
  f.depth.resize(v.grid().values());
  read_buffer(*v.renderer.cl, "reading depth", visible.image.depth, f.depth.data(), f.depth.size() * 4);
  f.opaque = v.plan.surfaces.opaque;
  return f;
}

// Every effect at once; tiles and blocks cut by the image's edges.
Scene scene_of_all_effects() {
  SmallScene s = small_scene();
  for (const SceneEffect& effect : effects()) effect.add(s);
  return s.scene;
}
const View& odd_view() {
  static const View view = small_view(71, 37);
  return view;
}

double largest_of(const glm::dvec3& v) {
  const glm::dvec3 a = glm::abs(v);
  return std::max({a.x, a.y, a.z});
}

// As the layout's table says (passes/common/gbuffer.h): x, y and z of a normal from its stored integers.
glm::dvec3 normal_of(const glm::dvec4& stored, double steps) {
  const glm::dvec2 uv = (glm::dvec2(stored) - (steps + 1)) / steps;
  glm::dvec3 n(uv, 1 - std::abs(uv.x) - std::abs(uv.y));
  if (n.z < 0) n = {std::copysign(1 - std::abs(uv.y), uv.x), std::copysign(1 - std::abs(uv.x), uv.y), n.z};
  return glm::normalize(n);
}

// The model's number in the last channel of 32 bits, and the metalness.
double number_of(double model_metallic) { return std::floor((model_metallic - 1) / 2); }
double metallic_of(double w) { return w < 0 ? -w - 1 : w - 1 - 2 * number_of(w); }

// Textures are magnified: float's rounding of attributes and filters alone, as in resolve_test.
TEST(ResolveGbuffer, HoldsTheSurfacesInDouble) {
  const Scene scene = scene_of_all_effects();
  const Filled f = filled(scene, odd_view(), {});
  double_surfaces::Surfaces oracle(scene, odd_view(), f.opaque);
  std::vector<uint32_t> pixels;
  std::vector<Surface> surfaces(f.depth.size());
  size_t unlit = 0, background = 0, modelled = 0, reflective = 0;
  double normal = 0, material = 0, base = 0;
  for (uint32_t i = 0; i < f.depth.size(); ++i) {
    const glm::dvec4 a = f.texel<float>(0, i), b = f.texel<float>(1, i);
    if (oracle.hits()[i].instance < 0 && f.depth[i] == 0) {
      EXPECT_EQ(a, glm::dvec4(0));
      EXPECT_EQ(b, glm::dvec4(0));
      EXPECT_EQ(glm::vec3(f.image.pixels[i]), scene.background);
      ++background;
    }
    if (oracle.hits()[i].instance < 0 || std::abs(oracle.hits()[i].depth - f.depth[i]) > 1e-6) continue;
    const Surface& s = surfaces[i] = oracle.surface_at(i);
    pixels.push_back(i);
    unlit += s.unlit;
    EXPECT_EQ(b.w < 0, s.unlit);
    material = std::max(material, largest_of(glm::dvec3(b) - s.base_color));
    if (s.unlit) continue;  // the oracle computes nothing else of it
    normal = std::max(normal, largest_of(glm::dvec3(a) - s.normal));
    material = std::max({material, std::abs(a.w - s.roughness), std::abs(metallic_of(b.w) - s.metallic)});
    EXPECT_EQ(number_of(b.w), s.roll_off > 0 ? 1 : 0);  // the wall's
    const glm::dvec4 reflectance = f.texel<float>(gbuffer_specular, i);
    material =
        std::max({material, largest_of(glm::dvec3(reflectance) - s.f0), std::abs(reflectance.w - s.f90)});
    reflective += s.f90 > 0 && s.f90 != 1;
    modelled += number_of(b.w) > 0;
  }
  EXPECT_GT(pixels.size(), f.depth.size() / 4);
  EXPECT_GT(unlit, 100u);
  EXPECT_GT(background, 100u);
  EXPECT_GT(modelled, 100u);
  EXPECT_GT(reflective, 100u);
  std::vector<ViewLight> directional = lights_in_view(scene, odd_view());
  std::erase_if(directional, [](const ViewLight& light) { return light.type != LightType::directional; });
  ASSERT_EQ(directional.size(), 1u);
  const auto radiance = shade_pixels(
      odd_view(), f.depth, [&](uint32_t pixel) { return surfaces[pixel]; }, directional,
      {.ambient = scene.ambient}, pixels);
  for (size_t i = 0; i < pixels.size(); ++i) {
    base = std::max(base, largest_of(glm::dvec3(f.image.pixels[pixels[i]]) - radiance[i]));
  }
  fmt::print("largest errors: normal {:.2g}, material {:.2g}, base lighting {:.2g}\n", normal, material,
             base);
  EXPECT_LT(normal, 1e-5);
  EXPECT_LT(material, 1e-5);
  EXPECT_LT(base, 2e-5 * brightest_channel(f.image));
}

TEST(ResolveGbuffer, HasTheSameBytesInBothShapes) {
  const Scene scene = scene_of_all_effects();
  for (const int bits : {32, 16, 8}) {
    const Filled lanes = filled(scene, odd_view(),
                                {{setting::buffer_bits, bits}, {setting::kernel_shape, KernelShape::lanes}});
    const Filled group = filled(scene, odd_view(),
                                {{setting::buffer_bits, bits}, {setting::kernel_shape, KernelShape::group}});
    for (size_t i = 0; i < gbuffer_most_images; ++i)
      EXPECT_TRUE(lanes.bytes[i] == group.bytes[i]) << bits << ' ' << i;
    EXPECT_TRUE(compare_images(lanes.image, group.image).bit_identical) << bits;
  }
}

// Half a step of the stored value, and float's rounding of it; of a color in 8 bits half a step of its square
// root, whose slope is at most 2. Angles: Cigolle et al. (2014), as in fill_gbuffer_test.
template <typename Channel>
void expect_rounded(const Scene& scene, int bits, double steps, double one, double angle_deg) {
  const Filled exact = filled(scene, odd_view(), {}),
               rounded = filled(scene, odd_view(), {{setting::buffer_bits, bits}});
  const double half = 0.502 / one;
  double largest = 0;
  for (size_t i = 0; i < exact.depth.size(); ++i) {
    const glm::dvec4 a = exact.texel<float>(0, i), b = exact.texel<float>(1, i);
    const glm::dvec4 p = rounded.texel<Channel>(0, i), q = rounded.texel<Channel>(1, i);
    ASSERT_EQ(q.w, b.w <= 0 ? 0 : number_of(b.w) > 0 ? number_of(b.w) : one) << i;
    if (b.w == 0) {
      ASSERT_EQ(p, glm::dvec4(0)) << i;
      continue;
    }
    const glm::dvec3 n = normal_of(p, steps);
    largest = std::max(largest, glm::degrees(std::atan2(glm::length(glm::cross(n, glm::dvec3(a))),
                                                        glm::dot(n, glm::dvec3(a)))));
    ASSERT_NEAR(p.z / one, a.w, half) << i;
    const glm::dvec4 reflectance = exact.texel<float>(gbuffer_specular, i),
                     kept = rounded.texel<Channel>(gbuffer_specular, i);
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(kept[c] / one, std::sqrt(reflectance[c]), half) << i;
    ASSERT_NEAR(kept.w / one, reflectance.w, half) << i;
    // In 32 bits a metalness beside number n is rounded itself.
    ASSERT_NEAR(p.w / one, metallic_of(b.w), half + 0x1p-23 * (number_of(b.w) + 1)) << i;
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(q[c] / one, bits == 8 ? std::sqrt(b[c]) : b[c], half) << i;
  }
  EXPECT_LE(largest, angle_deg);
  EXPECT_GE(largest, 0.5 * angle_deg) << "the bound is the encoding's own";
}

TEST(ResolveGbuffer, RoundsTo16And8BitsAsTheLayoutSays) {
  const Scene scene = scene_of_all_effects();
  expect_rounded<uint16_t>(scene, 16, 32767, 65535, 0.0038);
  expect_rounded<uint8_t>(scene, 8, 127, 255, 0.96);
}

// Half a step of a square root whose slope is at most 2; what is no color has the source's own bytes,
// magnified.
TEST(ResolveGbuffer, TexelsOf8BytesAreOffByHalfAStepOfAColorsRoot) {
  SmallScene s = small_scene();
  for (const char* name : {"base_color_map", "metallic_roughness_map", "normal_map"}) effect(name).add(s);
  const Filled exact = filled(s.scene, odd_view(), {{setting::texels, TexelLayout::separate}});
  const Filled small = filled(s.scene, odd_view(), {{setting::texels, TexelLayout::packed_8}});
  double largest = 0;
  for (size_t i = 0; i < exact.depth.size(); ++i) {
    const glm::dvec4 a = exact.texel<float>(1, i), b = small.texel<float>(1, i);
    for (int c = 0; c < 3; ++c) {
      ASSERT_LE(std::abs(a[c] - b[c]), std::sqrt(a[c]) / 255 + 0.25 / (255 * 255) + 1e-6) << i;
      largest = std::max(largest, std::abs(a[c] - b[c]));
    }
    ASSERT_NEAR(a.w, b.w, 1e-6) << i;
    const glm::dvec4 apart = glm::abs(exact.texel<float>(0, i) - small.texel<float>(0, i));
    ASSERT_LE(std::max({apart.x, apart.y, apart.z, apart.w}), 2e-6) << i;
  }
  EXPECT_GT(largest, 1e-4) << "else texels were not packed";
}

}  // namespace
}  // namespace lightgrid
