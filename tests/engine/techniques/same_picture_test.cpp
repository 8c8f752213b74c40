// Changes that must not change the picture.
#include <stdlib.h>

#include <cmath>

#include "base/error.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

TEST(SamePicture, InEveryRun) {
  const Scene scene = find_builtin_scene("hall")->make();
  const View view = default_view(scene, 127, 73);
  TechniqueRun run(test_devices(), scene, view, {}, find_technique("forward_plus"));
  run.run_frame();
  const Image first = run.image();
  for (int frame = 0; frame < 3; ++frame) {
    run.run_frame();
    EXPECT_TRUE(identical(run.image(), first)) << "frame " << frame;
  }
  EXPECT_TRUE(identical(render(scene, view, "forward_plus"), first)) << "made anew";
}

// Multiples of 2^-20 m, so that adding 2^20 m is exact in double.
glm::dvec3 rounded(const glm::dvec3& p) { return glm::round(p * 0x1p20) * 0x1p-20; }

void move(Scene& scene, const glm::dvec3& by) {
  const auto moved = [&](glm::dmat4& matrix) {
    matrix[3] = glm::dvec4(rounded(glm::dvec3(matrix[3])) + by, 1);
  };
  for (Instance& instance : scene.instances) moved(instance.world_from_object);
  for (Camera& camera : scene.cameras) moved(camera.world_from_view);
  for (Light& light : scene.lights) light.position = rounded(light.position) + by;
}

TEST(SamePicture, AThousandKilometresAway) {
  for (const char* name : {"hall", "street"}) {
    Scene here = find_builtin_scene(name)->make(), there = here;
    move(here, glm::dvec3(0));
    move(there, {0x1p20, -0x1p20, 0x1p20});
    const Image image = render(here, default_view(here, 127, 73), "forward_plus");
    EXPECT_TRUE(identical(render(there, default_view(there, 127, 73), "forward_plus"), image)) << name;
  }
}

// In one memory; and in two, with pixels copied by the compute shaders that a GPU's imported memory uses.
TEST(SamePicture, WhicheverWayTheBuffersTravel) {
  const Scene scene = find_builtin_scene("hall")->make();
  const View view = default_view(scene, 127, 73);
  if (test_devices().bridge == BridgeKind::staged)
    GTEST_SKIP() << "this machine has no shared memory to compare with";
  setenv("LIGHTGRID_BRIDGE", "staged", 1);
  Renderer staged = Renderer("", GlBackend::automatic);
  unsetenv("LIGHTGRID_BRIDGE");
  ASSERT_EQ(staged.bridge, BridgeKind::staged);
  staged.pixel_copies = PixelCopies(true);
  for (const char* technique : {"forward_plus", "deferred_tiled"}) {
    const Image image = render(scene, view, technique);
    staged.gl->make_current();
    EXPECT_TRUE(identical(render(staged, scene, view, technique), image)) << technique;
  }
  EXPECT_EQ(staged.pixel_copies.programs(), 3)
      << "of depth, the geometry buffer, the image for blended surfaces";
}

// Two renderers may differ in depth's last places, at edges, and in how they filter textures: of the
// brightest channel, llvmpipe and softpipe have an rmse of 2.0e-4, llvmpipe with the filters of AVX and of
// SSE 2 one of 6.5e-4.
constexpr double two_renderers = 2e-3;

// The same renderer with two backends must give equal pictures.
TEST(SamePicture, ThroughOsmesaAndEgl) {
  const Scene scene = find_builtin_scene("hall")->make();
  const View view = default_view(scene, 127, 73);
  Image images[2];
  std::string renderers[2];
  for (const GlBackend backend : {GlBackend::osmesa, GlBackend::egl}) {
    const int i = backend == GlBackend::egl;
    try {
      Renderer devices("", backend);
      renderers[i] = devices.gl->renderer + devices.gl->version;
      images[i] = render(devices, scene, view, "forward_plus");
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::machine) throw;
      GTEST_SKIP() << error.what();
    }
  }
  if (renderers[0] == renderers[1]) {
    EXPECT_TRUE(identical(images[1], images[0])) << renderers[0];
  } else {
    EXPECT_LT(compare_images(images[1], images[0]).rmse, two_renderers * brightest_channel(images[0]))
        << renderers[0] << " and " << renderers[1];
  }
}

// One corner cut off a wall, so that its mirror image is another mesh.
Mesh flag(int material, bool mirrored, bool reversed) {
  Mesh mesh = wall_mesh({0.5f, 0, -4}, 1.5f, material, "flag");
  mesh.indices.resize(mesh.indices.size() - 3);
  for (glm::vec3& p : mesh.positions) p.x = mirrored ? -p.x : p.x;
  if (reversed) {
    for (glm::vec3& n : mesh.normals) n = -n;
  }
  if (mirrored != reversed) {
    for (size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  }
  mesh.bounds = Aabb();
  for (const glm::vec3& p : mesh.positions) mesh.bounds.add(p);
  return mesh;
}

Image picture_of(Mesh mesh, const glm::dmat4& world_from_object, bool double_sided) {
  SmallScene s = small_scene();
  s.scene.instances.clear();
  s.scene.materials[s.wall_material].double_sided = double_sided;
  add_instance(s.scene, "flag", add_mesh(s.scene, std::move(mesh)), world_from_object);
  return render(s.scene, small_view(127, 73), "forward_plus");
}

// Triangles of reversed winding are set up from other corners: depths differ in their last places.
constexpr double other_corners = 1e-5;

TEST(SamePicture, MirroredByItsMatrixOrByItsVertices) {
  const glm::dmat4 mirror = glm::scale(glm::dmat4(1), {-1, 1, 1});
  const Image by_vertices = picture_of(flag(0, true, false), glm::dmat4(1), false);
  EXPECT_LE(compare_images(picture_of(flag(0, false, false), mirror, false), by_vertices).max_rel,
            other_corners);
  // It differs from the unmirrored one, and is lit all the same.
  EXPECT_GT(compare_images(picture_of(flag(0, false, false), glm::dmat4(1), false), by_vertices).max_rel,
            0.1);
}

TEST(SamePicture, FromTheBackOfADoubleSidedSurface) {
  const Image front = picture_of(flag(0, false, false), glm::dmat4(1), false);
  EXPECT_LE(compare_images(picture_of(flag(0, false, true), glm::dmat4(1), true), front).max_rel,
            other_corners);
  // Single-sided, its back is invisible.
  const Image back = picture_of(flag(0, false, true), glm::dmat4(1), false);
  for (const glm::vec4& pixel : back.pixels) ASSERT_EQ(glm::vec3(pixel), glm::vec3(0.1f, 0.2f, 0.3f));
}

}  // namespace
}  // namespace lightgrid
