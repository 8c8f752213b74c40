// Distances on large and on thin triangles, as visibility and forward draw them, against double precision.
#include "oracle/position.h"
#include "scene/random.h"
#include "scenes/compose.h"
#include "scenes/shapes.h"
#include "support/double_surfaces.h"
#include "techniques/rendering.h"

namespace lightgrid {
using namespace lab;
namespace {

using glm::vec3, glm::dvec3;

class LargeTriangleMesh {
 public:
  void add(const vec3& a, const vec3& b, const vec3& c) {
    for (const vec3& p : {a, b, c}) {
      mesh_.indices.push_back(uint32_t(mesh_.positions.size()));
      mesh_.positions.push_back(p);
      mesh_.normals.push_back({0, 1, 0});
      mesh_.uv0.push_back({0, 0});
    }
  }
  void add_quad(const vec3& from, const vec3& u, const vec3& v) {
    add(from, from + u, from + u + v);
    add(from, from + u + v, from + v);
  }
  Scene scene() {
    Scene scene;
    const int material = add_material(scene, "plaster", {0.7f, 0.7f, 0.7f}, 0, 0.8f);
    scene.materials[size_t(material)].double_sided = true;
    add_instance(scene, "triangles",
                 add_mesh(scene, shapes::finished(std::move(mesh_), "triangles", material)), glm::dmat4(1));
    return scene;
  }

 private:
  Mesh mesh_;
};

Scene three_quads(float size) {
  LargeTriangleMesh t;
  const float h = size / 2;
  t.add_quad({-h, 0, h}, {size, 0, 0}, {0, 0, -size});
  t.add_quad({-h, 0, -h}, {size, 0, 0}, {0, 6, 0});
  t.add_quad({-h, 0, h}, {0, 0, -size}, {0, 6, 0});
  return t.scene();
}

// Walls and floors that begin behind the eye and pass it closely.
Scene through_the_near_plane() {
  LargeTriangleMesh t;
  for (int i = 0; i < 8; ++i) {
    const float turn = 0.7853982f * (float(i) + 0.3f), x = std::cos(turn), y = std::sin(turn);
    t.add_quad({x, 1.7f + y, 8}, {4 * y, -4 * x, 0.5f}, {x / 2, y / 2, -50});
  }
  return t.scene();
}

// 45 m long, up to 2 mm wide at one end.
Scene long_slivers() {
  LargeTriangleMesh t;
  Random random(5);
  for (int i = 0; i < 400; ++i) {
    const float x = -5 + 0.025f * float(i), end = x + 3 * float(random.uniform(-0.5, 0.5));
    t.add({x, 0, 5}, {x + 0.002f * float(random.uniform(0.2, 1)), 0, 5}, {end, 0, -40});
  }
  return t.scene();
}

// RMSE and greatest error of the distances at `pixels`, relative to those in double.
struct DistanceErrors {
  double rmse = 0, most = 0;
};

struct LargeCase {
  const char* name;
  Scene scene;
  double near_m, far_m;
};

std::vector<float> depth_drawn_by(const Scene& scene, const View& view, const char* technique) {
  TechniqueRun run(test_devices(), scene, view, {}, find_technique(technique));
  run.run_frame();
  return read_depth(run);
}

double distance_from(const View& view, uint32_t pixel, double depth) {
  return -position_from_depth(view, int(pixel % uint32_t(view.width)), int(pixel / uint32_t(view.width)),
                              depth)
              .z;
}

DistanceErrors errors_of(const View& view, const std::vector<float>& depth,
                         const std::vector<double_surfaces::Hit>& hits, const std::vector<uint32_t>& pixels) {
  DistanceErrors e;
  for (const uint32_t pixel : pixels) {
    const double off = std::abs(
        distance_from(view, pixel, depth[pixel]) / distance_from(view, pixel, hits[pixel].depth) - 1);
    e.rmse += off * off;
    e.most = std::max(e.most, off);
  }
  e.rmse = std::sqrt(e.rmse / double(pixels.size()));
  return e;
}

// Vertices in view space are rounded to 2^-24 of their distance. Relative to the distance of the eye from the
// plane this is what a pixel's distance errs by; there are some of these roundings.
double bound_of(const Scene& scene, const dvec3& eye) {
  double most = 0;
  const std::vector<vec3>& at = scene.meshes[0].positions;
  const std::vector<uint32_t>& index = scene.meshes[0].indices;
  for (size_t i = 0; i < index.size(); i += 3) {
    const dvec3 a = dvec3(at[index[i]]) - eye, b = dvec3(at[index[i + 1]]) - eye,
                c = dvec3(at[index[i + 2]]) - eye;
    const double from_eye = std::abs(glm::dot(a, glm::normalize(glm::cross(b - a, c - a))));
    most = std::max(most, std::max({glm::length(a), glm::length(b), glm::length(c)}) / from_eye);
  }
  return 4 * 0x1p-24 * most;
}

void expect_no_worse_than_forward(const LargeCase& c) {
  SCOPED_TRACE(c.name);
  Camera camera = look_at({1.5, 1.7, 6}, {0, 1, -2});
  camera.near_m = c.near_m;
  camera.far_m = c.far_m;
  const View view = make_view(camera, 203, 117);
  const std::vector<float> forward = depth_drawn_by(c.scene, view, "forward"),
                           visibility = depth_drawn_by(c.scene, view, "visibility");
  const double_surfaces::Surfaces surfaces(c.scene, view, {0});
  const auto& hits = surfaces.hits();
  // Where both show the triangle that double precision sees: others differ by more than 1e-3.
  std::vector<uint32_t> pixels;
  const auto same = [&](float depth, double exact) { return std::abs(depth / exact - 1) < 1e-3; };
  for (uint32_t i = 0; i < hits.size(); ++i) {
    if (hits[i].instance >= 0 && same(forward[i], hits[i].depth) && same(visibility[i], hits[i].depth))
      pixels.push_back(i);
  }
  ASSERT_GT(pixels.size(), 300u);
  const DistanceErrors of_forward = errors_of(view, forward, hits, pixels),
                       of_visibility = errors_of(view, visibility, hits, pixels);
  EXPECT_LE(of_visibility.rmse, of_forward.rmse);
  EXPECT_LT(of_visibility.most, bound_of(c.scene, view.eye));
  fmt::print("{}: RMSE {:.2g}, at most {:.2g}; forward's {:.2g}, {:.2g}; {} pixels\n", c.name,
             of_visibility.rmse, of_visibility.most, of_forward.rmse, of_forward.most, pixels.size());
}

TEST(LargeTriangles, DistancesAreNoFurtherFromDoubleThanForwards) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  LargeTriangleMesh plane;
  plane.add_quad({-5000, 0, 5000}, {10000, 0, 0}, {0, 0, -10000});
  for (const LargeCase& c : {LargeCase{"room of three quads", three_quads(16), 0.1, infinite},
                             LargeCase{"room with a far plane", three_quads(16), 0.1, 40},
                             LargeCase{"room of 100 m", three_quads(100), 0.1, infinite},
                             LargeCase{"plane of 10 km", plane.scene(), 0.1, infinite},
                             LargeCase{"through the near plane", through_the_near_plane(), 0.5, infinite},
                             LargeCase{"slivers", long_slivers(), 0.1, infinite}}) {
    expect_no_worse_than_forward(c);
  }
}

}  // namespace
}  // namespace lightgrid
