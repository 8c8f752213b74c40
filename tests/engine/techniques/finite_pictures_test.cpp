// No pixel is NaN, infinite or negative, in any technique, of planes that contain the eye and of other
// triangles without area on the screen: some pixels are covered that lie far outside of the triangle in its
// own coordinates. Nor of vertices whose attributes have no direction and no place.
#include "plan/settings/kernels.h"
#include "plan/settings/surfaces.h"
#include "scene/random.h"
#include "support/small_scene.h"
#include "support/technique_tiers.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

void add_corner(Mesh& mesh, Random& random, const glm::dvec3& position, const glm::dvec3& normal,
                const glm::dvec3& along) {
  mesh.positions.emplace_back(position);
  mesh.normals.emplace_back(normal);
  mesh.tangents.emplace_back(glm::vec3(along), 1);
  mesh.uv0.emplace_back(random.uniform(-3, 3), random.uniform(-3, 3));
  mesh.uv1.push_back(glm::vec2(mesh.uv0.back().y, -mesh.uv0.back().x));
  // Some black ones: what lies beyond them is negative.
  const auto channel = [&] { return random.next() % 3 ? random.uniform() : 0.0f; };
  const float red = channel(), green = channel(), blue = channel();
  mesh.colors.emplace_back(red, green, blue, 0.3f + 0.7f * random.uniform());
}

// Two triangles in a plane that passes by the eye at a distance of 0 or of some roundings.
void add_plane(Mesh& mesh, Random& random) {
  const glm::dvec3 normal = any_direction(random);
  const glm::dvec3 along = glm::normalize(glm::cross(normal, any_direction(random))),
                   across = glm::cross(normal, along);
  const double off = random.next() % 2 ? 0 : 1e-6 * random.uniform(-1, 1), size = random.uniform(1, 30);
  const uint32_t first = uint32_t(mesh.positions.size());
  const glm::dvec3 centre = along * double(random.uniform(-1, 1)) + across * double(random.uniform(-1, 1));
  for (const auto& [s, t] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
    const glm::dvec3 at = normal * off + size * (centre * 0.7 + along * double(s) + across * double(t));
    // Smooth normals that turn over within the triangle.
    add_corner(mesh, random, at, glm::normalize(normal + 2.0 * any_direction(random)), along);
  }
  for (const uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + corner);
}

// Three corners nearly on one line before the eye.
void add_sliver(Mesh& mesh, Random& random) {
  const glm::dvec3 a(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-4, -1));
  const glm::dvec3 b(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-4, -1));
  const glm::dvec3 c = a + (b - a) * double(random.uniform()) + 1e-6 * any_direction(random);
  for (const glm::dvec3& corner : {a, b, c}) {
    mesh.indices.push_back(uint32_t(mesh.positions.size()));
    add_corner(mesh, random, corner, any_direction(random), glm::normalize(b - a));
  }
}

using Dress = void (*)(SmallScene&);

Scene sliver_scene(uint64_t seed, Dress dress) {
  SmallScene s = small_scene();
  Random random(seed);
  s.scene.instances.pop_back();  // the wall stays, behind all
  dress(s);
  const int first = s.wall_material, count = int(s.scene.materials.size());
  for (int m = first; m < count; ++m) s.scene.materials[m].double_sided = true;
  for (int i = 0; i < 8; ++i) {
    Mesh mesh;
    for (int k = 0; k < 3; ++k) add_plane(mesh, random);
    for (int k = 0; k < 40; ++k) add_sliver(mesh, random);
    add_instance(
        s.scene, "slivers",
        add_mesh(s.scene, shapes::finished(std::move(mesh), "slivers", first + i % (count - first))));
  }
  return s.scene;
}

void colours_alone(SmallScene& s) { s.ball_material = s.wall_material; }

void every_effect(SmallScene& s) {
  for (const SceneEffect& each : effects()) each.add(s);
}

// An image's pixels that no light makes.
size_t impossible_pixels(const Image& image) {
  return size_t(std::count_if(image.pixels.begin(), image.pixels.end(), [](const glm::vec4& p) {
    return !(p.r >= 0 && p.g >= 0 && p.b >= 0 && std::max({p.r, p.g, p.b}) <= 3e38f);
  }));
}

struct FinitePictures : testing::TestWithParam<const Technique*> {
  static void expect_slivers(const char* technique, Dress dress, int seeds, const Settings& settings) {
    size_t pixels = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
      const Scene scene = sliver_scene(uint64_t(seed), dress);
      for (const auto& [width, height] : {std::pair(63, 63), {81, 17}}) {
        const Image image = render(scene, small_view(width, height), technique, settings);
        pixels += impossible_pixels(image);
      }
    }
    EXPECT_EQ(pixels, 0u) << technique;
  }
};

TEST_P(FinitePictures, OfSliversWithVertexColours) { expect_slivers(GetParam()->name, colours_alone, 6, {}); }

TEST_P(FinitePictures, OfSliversWithEveryEffect) { expect_slivers(GetParam()->name, every_effect, 3, {}); }

TEST_P(FinitePictures, OfSliversDrawnByOpenCl) {
  expect_slivers(GetParam()->name, colours_alone, 3, {{setting::raster, RasterApi::opencl}});
  expect_slivers(GetParam()->name, every_effect, 2,
                 {{setting::kernel_shape, KernelShape::group}, {setting::raster, RasterApi::opencl}});
}

TEST_P(FinitePictures, OfAttributesWithoutDirectionOrPlace) {
  SmallScene s = small_scene();
  every_effect(s);
  Bitmap grey;  // half-way between its texels a normal map holds no direction
  grey.name = "grey";
  grey.width = grey.height = 2;
  for (const uint8_t byte : {127, 128, 128, 127}) grey.rgba.insert(grey.rgba.end(), {byte, byte, byte, 255});
  const int map = add_texture(s.scene, std::move(grey), false);
  for (Material& m : s.scene.materials) {
    m.normal_map.texture = map;
    m.normal_scale = 0;
  }
  for (Mesh& mesh : s.scene.meshes) {
    mesh.tangents.resize(mesh.positions.size(), glm::vec4(1, 0, 0, 1));
    mesh.uv0.resize(mesh.positions.size());
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
      const float lengths[] = {0, 1, 1e-30f, 3e38f, -1};
      mesh.normals[i] *= lengths[i % 5];
      mesh.tangents[i] *= glm::vec4(glm::vec3(lengths[i % 3]), 1);
      const float far = i % 2 ? 3e38f : -3e38f;  // their differences overflow
      mesh.uv0[i] = glm::vec2(i % 4 ? 0.5f : far, i % 7 ? far : 0.5f);
    }
  }
  for (const KernelShape shape : {KernelShape::lanes, KernelShape::group}) {
    const Settings settings{{setting::kernel_shape, shape}, {setting::raster, RasterApi::opencl}};
    EXPECT_EQ(impossible_pixels(render(s.scene, small_view(63, 37), GetParam()->name, settings)), 0u);
  }
  EXPECT_EQ(impossible_pixels(render(s.scene, small_view(63, 37), GetParam()->name)), 0u);
}

LIGHTGRID_TECHNIQUES_OF_BOTH_TIERS(FinitePictures);

}  // namespace
}  // namespace lightgrid
