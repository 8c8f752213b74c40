// Edges that two triangles share: of shadow rays and of the rasteriser.
#include <gmock/gmock.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "certify/theorem.h"

#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-value"  // (int2)(x, y)
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wparentheses"

namespace lightgrid::certify {
namespace {

using uint = std::uint32_t;
template <typename T>
T min(T a, T b) {
  return b < a ? b : a;
}
template <typename T>
T max(T a, T b) {
  return a < b ? b : a;
}
template <typename T>
T clamp(T x, T low, T high) {
  return min(max(x, low), high);
}
int convert_int(Real) { return 0; }
Real convert_float(int x) { return x; }
uint clz(uint x) { return uint(std::countl_zero(x)); }
int as_int(Real) { return 0; }
Real as_float(int x) { return x; }
// Rounded once, but odd in the same way as a product and a sum.
Real fma(Real a, Real b, Real c) { return a * b + c; }

struct int2 {
  int x, y;
};
struct float4 {
  Real x, y, z, w;
};

#define __OPENCL_VERSION__ 120
#define global
#define constant const
#define LANES 1
#define float Real
#define double Real
#define SAMPLES 4
#define SAMPLE_PLACES -32, -96, 96, -32, -96, 32, 32, 96
#include "kernels/rays/ray_packet.h"
#undef double
#undef float
#include "kernels/raster/raster_tiles.h"
#undef constant
#undef global

// An expression up to its sign: equal keys are equal numbers, or opposite ones if the signs differ. Only laws that
// hold for rounded numbers are used: a b = b a, a + b = b + a, a - b = a + (-b), and each operation is odd.
struct Signed {
  int sign;
  std::string key;
};
Signed canonical(const Path& path, int id) {
  const Node& n = path.nodes[size_t(id)];
  if (n.op == 'i') return {1, n.name};
  if (n.op == 'c') return {n.value < 0 ? -1 : 1, std::to_string(std::abs(n.value))};
  Signed a = canonical(path, n.a);
  if (n.op == 'n') return {-a.sign, a.key};
  Signed b = canonical(path, n.b);
  if (n.op == '-') b.sign = -b.sign;
  if (a.key > b.key) std::swap(a, b);
  if (n.op == '*') return {a.sign * b.sign, "(" + a.key + "*" + b.key + ")"};
  return {a.sign, "(" + a.key + (a.sign == b.sign ? "+" : "-") + b.key + ")"};
}

// The side of a point of the segment, for the edge from one corner to the other.
Kernel side_kernel(bool point, double turn, const char* from, const char* to) {
  return [=] {
    const RaySource light{input("lx"), input("ly"), input("lz"), point ? 1 : 0};
    const auto in = [](const std::string& corner, const char* axis) { return input(corner + axis); };
    const RayPlane plane = edge_plane(light, point, in(from, "x"), in(from, "y"), in(from, "z"), in(to, "x"),
                                      in(to, "y"), in(to, "z"));
    return std::vector{plane_side({input("x"), input("y"), input("z")}, plane, turn)};
  };
}

// at . (b x c) for a light at a point; else (at - (b + c) / 2) . (l x (b - c)).
Meaning meaning_of_side(bool point, double turn) {
  using V = std::array<long double, 3>;
  Meaning m{{"lx", "ly", "lz", "bx", "by", "bz", "cx", "cy", "cz", "x", "y", "z"}, {}};
  m.values = [=](const Inputs& in) {
    const auto vector = [&](const std::string& name) {
      return V{in.at(name + "x"), in.at(name + "y"), in.at(name + "z")};
    };
    const V b = vector("b"), c = vector("c"), l = vector("l"), at = vector("");
    V edge = b, with = c, from{};
    for (size_t i = 0; i < 3 && !point; ++i)
      edge[i] = l[i], with[i] = b[i] - c[i], from[i] = (b[i] + c[i]) / 2;
    long double side = 0;
    for (size_t i = 0; i < 3; ++i) {
      const size_t j = (i + 1) % 3, k = (i + 2) % 3;
      side += (at[i] - from[i]) * (edge[j] * with[k] - edge[k] * with[j]);
    }
    return Values{side * turn};
  };
  m.tolerance = 1e-9L;
  return m;
}

// Two triangles that share an edge never both miss a segment that crosses it. The planes of the edge, made with its ends
// in either order, are one expression with opposite signs. Rounding to nearest is odd, so the sides of a point are
// opposite numbers, and one of them is >= 0.
std::string prove_opposite(bool point, const Fault& fault) {
  for (const double turn : {1.0, -1.0}) {
    const std::vector<Path> there = paths_of(side_kernel(point, turn, "b", "c"), fault);
    const std::vector<Path> back = paths_of(side_kernel(point, turn, "c", "b"), fault);
    const bool planted = recorder.planted;
    const Signed one = canonical(there[0], there[0].results[0]),
                 other = canonical(back[0], back[0].results[0]);
    if (one.key != other.key || one.sign != -other.sign) return one.key + " and " + other.key;
    if (const std::string e = meaning_differs(there, meaning_of_side(point, turn)); !e.empty()) return e;
    recorder.planted = planted;
  }
  return "";
}

TEST(CertifyEdges, LightsAtPoints) { EXPECT_EQ(prove_opposite(true, {}), ""); }
TEST(CertifyEdges, Directions) { EXPECT_EQ(prove_opposite(false, {}), ""); }
TEST(CertifyEdges, Faults) {
  for (const bool point : {true, false}) {
    const Faults f = planted_faults([point](const Fault& fault) { return prove_opposite(point, fault); });
    EXPECT_GT(f.planted, 30);
    EXPECT_THAT(f.survived, testing::IsEmpty());
  }
}

// The rasteriser's edges are whole numbers. Of an edge's two directions exactly one lets in a place, also a place on
// the edge. All edges within 1/16 of a pixel around its centre and around a sample; longer ones have the same signs.
TEST(CertifyEdges, PixelsAndSamplesBelongToOneSide) {
  size_t wrong = 0;
  constexpr int n = 17;
  const auto check = [&](int x, int y) {
    for (int code = 0; code < n * n * n * n; ++code) {
      const int x0 = x + code % n - 8, y0 = y + code / n % n - 8, x1 = x + code / n / n % n - 8,
                y1 = y + code / n / n / n - 8;
      if (x0 == x1 && y0 == y1) continue;
      const Edge there = edge_at(x0, y0, x1, y1, 0, 0), back = edge_at(x1, y1, x0, y0, 0, 0);
      wrong += (there.c >= 0) == (back.c >= 0);
      for (int s = 0; s < SAMPLES; ++s)
        wrong += (edge_of_sample(there, s) >= 0) == (edge_of_sample(back, s) >= 0);
    }
  };
  check(128, 128);
  check(128 + SAMPLE_UNITS_X(1), 128 + SAMPLE_UNITS_Y(1));
  EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace lightgrid::certify
