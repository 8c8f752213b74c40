// The resolve pass against the same surfaces in double: attributes, textures and light of every pixel that
// has the triangle that the double rasteriser finds there.
#include "passes/resolve.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cl/transfer.h"
#include "measures/metrics.h"
#include "passes/cull_lights.h"
#include "passes/depth_bounds.h"
#include "passes/read_back.h"
#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"
#include "plan/settings/model.h"
#include "plan/settings/surfaces.h"
#include "renderer/render_view.h"
#include "scenes/builtin.h"
#include "support/devices.h"
#include "support/double_surfaces.h"
#include "support/small_scene.h"

namespace lightgrid {
using namespace lab;
namespace {

constexpr TechniqueNeeds needs{.lists = {.light_grid = true, .z_bins = true, .no_masks = true},
                               .adapt = [](TechniqueNeeds& needs, Settings& settings) {
                                 needs.lists.slices = settings.given(setting::slices);
                                 needs.lists.light_grid = settings[setting::lights] == ShadedLights::grid;
                               }};

struct Resolved {
  Image image;
  std::vector<float> depth;
  std::vector<double_surfaces::Hit> hits;  // decoded triangle numbers
};

std::vector<double_surfaces::Hit> hits_of(const RenderView& v, const std::vector<uint32_t>& triangles) {
  std::vector<double_surfaces::Hit> hits;
  for (uint32_t triangle : triangles) {
    double_surfaces::Hit& hit = hits.emplace_back();
    if (triangle == no_triangle) continue;
    for (const int instance : v.plan.surfaces.opaque) {
      const uint32_t count = uint32_t(v.scene.meshes[v.scene.instances[instance].mesh].indices.size() / 3);
      if (triangle < count) {
        hit.instance = instance;
        hit.triangle = triangle;
        break;
      }
      triangle -= count;
    }
  }
  return hits;
}

Resolved resolved(const Scene& scene, const View& view, const Settings& settings = {}) {
  GpuScene gpu(test_devices(), scene);
  RenderView v(test_devices(), gpu, view, settings, needs);
  const VisibilityBuffer visible = rasterize(v, v.caches);
  std::optional<ViewGrid> grid;
  if (v.plan.lists.light_grid)
    grid = cull_lights(v, v.culler(), v.opaque_grid(), depth_bounds(v, v.culler(), visible.depth()));
  Resolved r;
  read_back(v, resolve(v, v.caches.resolver, visible, grid ? from_grid(v, *grid) : every_light(v)), r.image);
  std::vector<uint32_t> triangles(v.grid().values());
  r.depth.resize(v.grid().values());
  read_buffer(*v.renderer.cl, "reading triangles", visible.image.triangle, triangles.data(),
              triangles.size() * 4);
  read_buffer(*v.renderer.cl, "reading depth", visible.image.depth, r.depth.data(), r.depth.size() * 4);
  r.hits = hits_of(v, triangles);
  return r;
}

bool same_triangle(const double_surfaces::Hit& a, const double_surfaces::Hit& b) {
  return a.instance == b.instance && (a.instance < 0 || a.triangle == b.triangle);
}

struct Errors {
  size_t pixels = 0, compared = 0, elsewhere = 0;  // elsewhere: another triangle than in double
  double largest = 0, mean = 0;                    // errors of the brightest channel
  double share_apart = 0;                          // share of pixels that differ by more than 1/1000
};

Errors errors_of(const Scene& scene, const View& view, const Settings& settings = {}) {
  const Resolved r = resolved(scene, view, settings);
  const FramePlan plan = plan_frame(scene, view, settings, needs);
  double_surfaces::Surfaces oracle(scene, view, plan.surfaces.opaque);
  std::vector<uint32_t> pixels;
  Errors e{.pixels = r.hits.size()};
  for (uint32_t i = 0; i < r.hits.size(); ++i) {
    if (!same_triangle(r.hits[i], oracle.hits()[i])) {
      ++e.elsewhere;
    } else if (r.hits[i].instance >= 0) {
      pixels.push_back(i);
    } else {
      EXPECT_EQ(glm::vec3(r.image.pixels[i]), scene.background);
    }
  }
  std::vector<Surface> surfaces;
  std::map<uint32_t, size_t> place;
  for (const uint32_t pixel : pixels) {
    place[pixel] = surfaces.size();
    surfaces.push_back(oracle.surface_at(pixel));
  }
  const auto radiance = shade_pixels(
      view, r.depth, [&](uint32_t pixel) { return surfaces[place.at(pixel)]; }, lights_in_view(scene, view),
      {.brdf = settings[setting::brdf], .ambient = scene.ambient}, pixels);
  double brightest = 0;
  for (const glm::dvec3& c : radiance) brightest = std::max({brightest, c.r, c.g, c.b});
  for (size_t i = 0; i < pixels.size(); ++i) {
    double apart = 0;
    for (int c = 0; c < 3; ++c)
      apart = std::max(apart, std::abs(double(r.image.pixels[pixels[i]][c]) - radiance[i][c]));
    if (!(apart <= e.largest)) e.largest = apart;
    e.mean += apart;
    e.share_apart += apart > 1e-3 * brightest ? 1.0 / double(pixels.size()) : 0;
  }
  e.compared = pixels.size();
  e.largest /= brightest;
  e.mean /= brightest * double(pixels.size());
  return e;
}

struct Resolve : testing::TestWithParam<std::string> {};

// Magnified textures, where levels of detail play no part: float's rounding alone.
TEST_P(Resolve, HasTheRadianceOfTheSurfacesInDouble) {
  SmallScene s = small_scene();
  effect(GetParam()).add(s);
  for (const TexelLayout layout : {TexelLayout::packed, TexelLayout::separate}) {
    const Errors e = errors_of(s.scene, small_view(79, 45), {{setting::texels, layout}});
    EXPECT_GT(e.compared, e.pixels / 4);
    EXPECT_LT(double(e.elsewhere), 0.005 * double(e.pixels));
    EXPECT_LT(e.mean, 1e-6);
    EXPECT_LT(e.largest, 2e-5);
  }
}

// The ball is a metal: black if glTF's diffuse part were what remains.
TEST(ResolveLambert, HasTheRadianceOfTheSurfacesInDouble) {
  const Errors e = errors_of(small_scene().scene, small_view(79, 45), {{setting::brdf, Brdf::lambert}});
  EXPECT_GT(e.compared, e.pixels / 4);
  EXPECT_LT(e.mean, 1e-6);
  EXPECT_LT(e.largest, 2e-5);
}

std::vector<std::string> drawn_effects() {
  std::vector<std::string> names = effect_names();
  std::erase(names, "blend");
  std::erase(names, "skin");  // "minnaert" has it too
  return names;
}

INSTANTIATE_TEST_SUITE_P(Effects, Resolve, testing::ValuesIn(drawn_effects()),
                         [](const auto& info) { return info.param; });

int add_noise(Scene& scene, int width, int height, bool srgb, uint32_t seed) {
  Bitmap bitmap{.name = "noise", .width = width, .height = height};
  for (int i = 0; i < 4 * width * height; ++i) {
    seed = seed * 1664525u + 1013904223u;
    bitmap.rgba.push_back(uint8_t(80 + (seed >> 24) / 2));
  }
  return add_texture(scene, std::move(bitmap), srgb);
}

// A floor that goes on to the horizon, and past the eye: a texture is magnified near by and less than a texel
// far off.
Scene floor_scene(const Texture& sampler, glm::ivec2 size, bool maps_alike = true) {
  Scene scene;
  const int material = add_material(scene, "floor", {1, 1, 1}, 1, 1);
  Material& m = scene.materials[material];
  const auto map = [&](TextureSlot& slot, int width, int height, bool srgb) {
    slot.texture = add_noise(scene, width, height, srgb, uint32_t(width * height) + scene.textures.size());
    Texture& t = scene.textures[slot.texture];
    t.wrap_u = sampler.wrap_u;
    t.wrap_v = sampler.wrap_v;
    t.min_filter = sampler.min_filter;
    t.mag_linear = sampler.mag_linear;
  };
  map(m.base_color_map, size.x, size.y, true);
  map(m.metallic_roughness_map, maps_alike ? size.x : 8, maps_alike ? size.y : 32, false);
  map(m.normal_map, size.x, size.y, false);
  Mesh mesh;
  shapes::add_quad(mesh, {-30, -1, 4}, {60, 0, 0}, {0, 0, -60});
  for (glm::vec2& uv : mesh.uv0) uv = uv * glm::vec2(17, 13) - glm::vec2(3.3f, 5.2f);
  mesh = shapes::finished(std::move(mesh), "floor", material);
  mesh.tangents.assign(mesh.positions.size(), {1, 0, 0, 1});
  add_instance(scene, "floor", add_mesh(scene, std::move(mesh)));
  add_point(scene, "lamp", {0, 3, -6}, {1, 0.9f, 0.8f}, 50, 100);
  return scene;
}

View floor_view() { return make_view(look_at({0, 0, 0}, {0.2, -0.35, -1}), 96, 54); }

// A level of detail is within 1.6e-4 of an octave. A texel's colour is within 7.6e-6, of base colours from
// 0.1 on.
void expect_floor(const Texture& sampler, glm::ivec2 size, bool maps_alike = true, bool steps = false) {
  const Scene scene = floor_scene(sampler, size, maps_alike);
  for (const TexelLayout layout : {TexelLayout::packed, TexelLayout::separate}) {
    const Errors e = errors_of(scene, floor_view(), {{setting::texels, layout}});
    EXPECT_GT(e.compared, e.pixels / 2);
    EXPECT_LT(double(e.elsewhere), 0.005 * double(e.pixels));
    EXPECT_LT(e.mean, steps ? 1e-4 : 5e-5);
    // Where a filter has steps, or texels far smaller than a pixel, some pixel's rounding meets another
    // texel. Elsewhere it is grazing light that magnifies it.
    EXPECT_LT(e.share_apart, steps ? 0.005 : 0.0005);
  }
}

TEST(ResolveTextures, OfEverySizeAndWrapMode) {
  for (const Wrap u : {Wrap::repeat, Wrap::clamp, Wrap::mirror}) {
    for (const Wrap v : {Wrap::repeat, Wrap::clamp, Wrap::mirror}) {
      for (const glm::ivec2 size : {glm::ivec2(16, 16), {1, 1}, {64, 8}, {5, 7}, {31, 1}}) {
        SCOPED_TRACE(fmt::format("wrap {} {}, {} x {}", int(u), int(v), size.x, size.y));
        expect_floor({.wrap_u = u, .wrap_v = v}, size);
      }
    }
  }
}

TEST(ResolveTextures, OfMapsThatDiffer) { expect_floor({}, {16, 64}, false); }

TEST(ResolveTextures, ThroughEveryFilter) {
  for (const Filter filter :
       {Filter::nearest, Filter::linear, Filter::nearest_mipmap_nearest, Filter::linear_mipmap_nearest,
        Filter::nearest_mipmap_linear, Filter::linear_mipmap_linear}) {
    for (const bool magnified_linear : {true, false}) {
      SCOPED_TRACE(fmt::format("filter {}, {}", int(filter), magnified_linear));
      const bool steps = !magnified_linear || filter != Filter::linear_mipmap_linear;
      expect_floor({.wrap_v = Wrap::mirror, .min_filter = filter, .mag_linear = magnified_linear}, {32, 16},
                   true, steps);
    }
  }
}

// Every effect at once, some tiles cut by the image's edges.
Scene all_effects() {
  SmallScene s = small_scene();
  for (const std::string& name : drawn_effects()) effect(name).add(s);
  return s.scene;
}

TEST(ResolveKernels, HaveTheSameBytesInEveryShape) {
  const Scene scene = all_effects();
  const View view = small_view(71, 37);
  GpuScene gpu(test_devices(), scene);
  RenderView drawn(test_devices(), gpu, view, {}, needs);
  const VisibilityBuffer visible = rasterize(drawn, drawn.caches);
  std::vector<Image> images;
  for (const Settings& settings :
       {Settings{}, Settings{{setting::portable, true}}, Settings{{setting::tile, 8}},
        Settings{{setting::kernel_shape, KernelShape::lanes}},
        Settings{{setting::kernel_shape, KernelShape::group}},
        Settings{{setting::slices, 8}, {setting::z_bins, 64}}.give(setting::slices),
        Settings{{setting::slices, 8}, {setting::kernel_shape, KernelShape::group}}.give(setting::slices),
        Settings{{setting::tile, 64}, {setting::lights, ShadedLights::all}}}) {
    RenderView v(test_devices(), gpu, view, settings, needs);
    std::optional<ViewGrid> grid;
    if (v.plan.lists.light_grid)
      grid = cull_lights(v, v.culler(), v.opaque_grid(), depth_bounds(v, v.culler(), visible.depth()));
    read_back(v, resolve(v, v.caches.resolver, visible, grid ? from_grid(v, *grid) : every_light(v)),
              images.emplace_back());
    EXPECT_TRUE(compare_images(images.back(), images.front()).bit_identical) << images.size();
  }
  EXPECT_GT(brightest_channel(images.front()), 0.1f);
}

}  // namespace
}  // namespace lightgrid
