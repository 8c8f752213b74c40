// Masked triangles let light through where their alpha is below the cutoff, in double by the oracle.
#include <gmock/gmock.h>

#include "base/error.h"
#include "cl/buffers.h"
#include "cl/transfer.h"
#include "rays/ray_scenes.h"
#include "shared/surface_records.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

constexpr int side = 5;  // texels

// A repeated or clamped texture of 5 x 5 alphas; uv and the vertex alpha a corner.
struct MaskedSoup {
  std::vector<Corners> triangles = hard_soups()[0].triangles;
  std::vector<SurfaceVertex> vertices;
  int alphas[side][side];
  SurfaceMaterial material{};

  explicit MaskedSoup(uint32_t flags) {
    RandomNumbers random(flags + 1);
    for (auto& row : alphas) {
      for (int& a : row) a = random.below(256);
    }
    for (size_t i = 0; i < 3 * triangles.size(); ++i) {
      SurfaceVertex v{};
      v.u0 = float(random.between(-2, 2));
      v.v0 = float(random.between(-2, 2));
      v.u1 = float(random.between(0, 1));
      v.v1 = float(random.between(0, 1));
      v.alpha = float(random.between(0.7, 1));
      vertices.push_back(v);
    }
    material.base_color[3] = 0.9f;
    material.alpha_cutoff = 0.4f;
    material.flags = 1u << SURFACE_BASE_COLOR;
    material.alpha_base = 3;  // texels of others come first
    SurfaceMap& map = material.maps[SURFACE_BASE_COLOR];
    map.width = map.height = side;
    map.flags = flags;
    map.uv_linear[0] = 0.5f;
    map.uv_linear[1] = 0.25f;
    map.uv_linear[2] = -0.5f;
    map.uv_linear[3] = 1;
    map.uv_offset[0] = 0.125f;
    map.uv_offset[1] = -0.25f;
  }

  uint32_t flags() const { return material.maps[SURFACE_BASE_COLOR].flags; }
  int texel(int x, int y) const {
    const auto at = [](int i, bool clamped) {
      return clamped ? std::clamp(i, 0, side - 1) : ((i % side) + side) % side;
    };
    return alphas[at(y, flags() & MAP_CLAMP_V)][at(x, flags() & MAP_CLAMP_U)];
  }

  RayMasks on_device() const {
    std::vector<uint32_t> chain(3, 0xffffffffu);
    for (int y = 0; y <= side; ++y) {
      for (int x = 0; x <= side; ++x) {
        chain.push_back(
            uint32_t(texel(x, y) | texel(x + 1, y) << 8 | texel(x, y + 1) << 16 | texel(x + 1, y + 1) << 24));
      }
    }
    const auto put = [](const auto& values) {
      const size_t bytes = values.size() * sizeof(values[0]);
      const cl::Buffer buffer = device_buffer(rays_device(), bytes);
      write_buffer(rays_device(), "mask", buffer, values.data(), bytes);
      return buffer;
    };
    return {put(vertices), put(std::vector{SurfaceMaterial{}, material}), put(chain)};
  }

  // By areas, relative to where the segment crosses the plane.
  double alpha_at(size_t triangle, const RayLight& light, const RayPoint& point) const {
    using Vec = RayOracle::Vec;
    const Corners& c = triangles[triangle];
    const Vec p(point.position), d = light.w != 0 ? Vec(light) - p : Vec(light), a(c[0]), b(c[1]), e(c[2]);
    const Vec n = cross(b - a, e - a);
    const Vec x = p + d * (dot(n, a - p) / dot(n, d));
    const long double whole = dot(n, n);
    const long double weights[] = {dot(cross(b - x, e - x), n) / whole, dot(cross(e - x, a - x), n) / whole,
                                   dot(cross(a - x, b - x), n) / whole};
    double u = 0, v = 0, alpha = 0;
    for (int k = 0; k < 3; ++k) {
      const SurfaceVertex& s = vertices[3 * triangle + k];
      u += double(weights[k]) * (flags() & MAP_UV1 ? s.u1 : s.u0);
      v += double(weights[k]) * (flags() & MAP_UV1 ? s.v1 : s.v0);
      alpha += double(weights[k]) * s.alpha;
    }
    if (flags() & MAP_TRANSFORM) {
      const double given = u;
      u = 0.5 * given - 0.5 * v + 0.125;
      v = 0.25 * given + v - 0.25;
    }
    double x_texel = u * side - 0.5, y_texel = v * side - 0.5;
    if (flags() & MAP_CLAMP_U) x_texel = std::clamp(x_texel, 0.0, side - 1.0);
    if (flags() & MAP_CLAMP_V) y_texel = std::clamp(y_texel, 0.0, side - 1.0);
    const int left = int(std::floor(x_texel)), low = int(std::floor(y_texel));
    const double fx = x_texel - left, fy = y_texel - low;
    const double texels = (texel(left, low) * (1 - fx) + texel(left + 1, low) * fx) * (1 - fy) +
                          (texel(left, low + 1) * (1 - fx) + texel(left + 1, low + 1) * fx) * fy;
    return 0.9 * alpha * texels / 255;
  }

  Answer answer(const RayLight& light, const RayPoint& point) const {
    Answer all = Answer::no;
    for (size_t i = 0; i < triangles.size(); ++i) {
      if (int(i) == point.own) continue;
      Answer one = RayOracle::one(triangles[i], light, point);
      if (one == Answer::yes) {
        const double over = alpha_at(i, light, point) - 0.4;
        if (std::abs(over) < 2e-4)
          one = Answer::either;
        else if (over < 0)
          one = Answer::no;
      }
      all = std::max(all, one);
    }
    return all;
  }
};

class RaysMasks : public testing::TestWithParam<uint32_t> {};

TEST_P(RaysMasks, AreTheOraclesInBothShapes) {
  const MaskedSoup soup(GetParam());
  const Placed p = placed(soup.triangles);
  const RayMesh mesh{p.positions, p.indices};
  const RayInstance instance{.alpha_material = 1};
  const Queries q = queries_of(soup.triangles, 12, 24, 31);
  std::vector<uint32_t> bits[2];
  for (const KernelShape shape : {KernelShape::lanes, KernelShape::group}) {
    RayScene scene(rays_device(), rays_programs(), {.shape = shape, .origin = glm::dvec3(0)});
    scene.set_meshes({&mesh, 1});
    scene.set_instances({&instance, 1});
    const std::vector<uint32_t> whole = scene.occlusion(q.points, q.lights, q.packets);
    scene.set_masks(soup.on_device());
    bits[shape == KernelShape::group] = scene.occlusion(q.points, q.lights, q.packets);
    size_t let_through = 0;
    for (size_t i = 0; i < whole.size(); ++i) {
      EXPECT_EQ(bits[shape == KernelShape::group][i] & ~whole[i], 0u);
      let_through += bits[shape == KernelShape::group][i] != whole[i];
    }
    EXPECT_GT(let_through, whole.size() / 10);
  }
  EXPECT_EQ(bits[0], bits[1]);
  size_t wrong = 0, either = 0;
  for (size_t i = 0; i < q.packets.size(); ++i) {
    for (int lane = 0; lane < 16; ++lane) {
      if (!(q.packets[i].lanes >> lane & 1)) continue;
      const Answer answer =
          soup.answer(q.lights[q.packets[i].light], q.points[q.packets[i].block * 16 + lane]);
      either += answer == Answer::either;
      wrong += answer != Answer::either && (answer == Answer::yes) != bool(bits[0][i] >> lane & 1);
    }
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_LT(either, q.packets.size() * 16 / 8);
}

INSTANTIATE_TEST_SUITE_P(Maps, RaysMasks,
                         testing::Values(0u, MAP_CLAMP_U | MAP_CLAMP_V, MAP_UV1, MAP_TRANSFORM));

TEST(RaysMaskArguments, TooFewAreRefused) {
  const MaskedSoup soup(0);
  const Placed p = placed(soup.triangles);
  const RayMesh mesh{p.positions, p.indices};
  RayScene scene(rays_device(), rays_programs());
  scene.set_meshes({&mesh, 1});
  const auto refusal = [](auto&& call) -> std::string {
    try {
      call();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  RayMasks masks = soup.on_device();
  masks.alphas = {};
  EXPECT_THAT(refusal([&] { scene.set_masks(masks); }), HasSubstr("no alphas"));
  scene.set_masks(soup.on_device());
  const RayInstance past{.alpha_material = 2};
  scene.set_instances({&past, 1});
  EXPECT_THAT(refusal([&] { scene.occlusion({}, {}, {}); }), HasSubstr("materials"));
  masks = soup.on_device();
  masks.vertices = device_buffer(rays_device(), 64);
  scene.set_masks(masks);
  EXPECT_THAT(refusal([&] { scene.occlusion({}, {}, {}); }), HasSubstr("vertices"));
}

}  // namespace
}  // namespace lightgrid
