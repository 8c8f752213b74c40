// The world grid's cones: a cell whose ball a light's cone meets is kept.
#include <gmock/gmock.h>

#include <climits>
#include <cmath>
#include <cstdint>

#include "certify/theorem.h"

#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-value"
#pragma GCC diagnostic ignored "-Wparentheses"

namespace lightgrid::certify {
namespace {

using uint = std::uint32_t;
using ulong = std::uint64_t;
using ushort = std::uint16_t;
uint min(uint a, uint b) { return b < a ? b : a; }
Real fmax(Real a, Real b) { return a > b ? a : b; }
uint clz(uint x) { return uint(__builtin_clz(x)); }
int popcount(uint x) { return __builtin_popcount(x); }
uint atomic_add(volatile uint*, uint) { return 0; }

// The kernel's vectors have lanes for each axis, of which one is recorded: 0 x, 1 y, 2 z. `spread` repeats one.
struct float16 {
  float16() = default;
  float16(Real all) : lane{all, all, all} {}
  float16(float all) : float16(Real(all)) {}
  float16(Real x, Real y, Real z) : lane{x, y, z} {}
  float16 spread(int i) const { return lane[i]; }
  Real lane[3];
};
#define EACH(operation) \
  { return {a.lane[0] operation b.lane[0], a.lane[1] operation b.lane[1], a.lane[2] operation b.lane[2]}; }
float16 operator+(float16 a, float16 b) EACH(+) float16 operator-(float16 a, float16 b) EACH(-) float16
operator*(float16 a, float16 b) EACH(*)
#undef EACH
    // Masks: of one lane, for a cell.
    struct int16 {
  int16() = default;
  int16(int x) : value(x) {}
  explicit operator bool() const { return value != 0; }
  int16 spread(int) const { return *this; }
  int value = 0;
  struct Half {
    int value;
  };
};
int16 operator&(int16 a, int16 b) { return a.value & b.value; }
int16 operator|(int16 a, int16 b) { return a.value | b.value; }
int16 operator+(int16 a, int16 b) { return a.value + b.value; }
int16 operator<<(int16 a, int16 b) { return a.value << b.value; }
int16 operator<(int16 a, int16 b) { return a.value < b.value; }
int16 operator>=(int16 a, int16 b) { return a.value >= b.value; }
int16 operator==(int16 a, int16 b) { return a.value == b.value; }
int16 operator<(float16 a, float16 b) { return a.lane[0] < b.lane[0]; }
int16 operator>(float16 a, float16 b) { return a.lane[0] > b.lane[0]; }
int16 operator>=(float16 a, float16 b) { return a.lane[0] >= b.lane[0]; }
int16 operator<=(float16 a, float16 b) { return a.lane[0] <= b.lane[0]; }
float16 convert_float16(int16) { return 0.0f; }
int16 convert_int16(float16) { return 0; }
int16 as_int16(float16) { return 0; }
float16 as_float16(int16) { return 0.0f; }
int as_int(Real) { return 0; }
int convert_int(Real) { return 0; }

// (real)(light.xxxx, light.yyyy, ...)
struct Four {
  Real x;
};
struct Fours {
  Real x, y, z;
  operator float16() const { return {x, y, z}; }
};
Fours operator,(Four a, Four b) { return {a.x, b.x, {}}; }
Fours operator,(Fours a, Four b) { return {a.x, a.y, b.x}; }
struct float4 {
  float4(Real a, Real b, Real c, Real d) : x(a), y(b), z(c), w(d), xxxx{a}, yyyy{b}, zzzz{c} {}
  Real x, y, z, w;
  Four xxxx, yyyy, zzzz;
};
struct uint2 {
  uint2(uint only) : x(only), y(0) {}
  uint x, y;
};

#define __OPENCL_VERSION__ 120
#define global
#define constant const
#define LANES 1
#define float Real
#include "kernels/common/pack.h"
#include "shared/world_grid.h"
// From here on vectors.
#undef LANES
#undef TO_REAL
#define LANES 16
#define LANE_INDEX int16(0)
#define TO_REAL convert_float16
#define real float16
#define whole int16
#define mask_t int16
float16 lane_max(float16 a, float16) { return a; }
uint mask_bits(int16 m) { return uint(m.value); }
#define s0123012301230123 spread(0)
#define s4444555566667777 spread(1)
#define s8 spread(2)
#define s9 spread(2)
#define sa spread(2)
#define sb spread(2)
#include "kernels/world_grid/world_block.h"
#undef s0123012301230123
#undef s4444555566667777
#undef s8
#undef s9
#undef sa
#undef sb
#undef mask_t
#undef whole
#undef real
#undef float
#undef constant
#undef global

const std::vector<std::string> axes{"x", "y", "z"};

// Bounds: of a + R s, a the light's distance along its axis, in parts of the distance D and of the ball's radius R; of the
// left side, in parts of D^2; of the right side.
constexpr double along_distance = 6.0001 * u, along_radius = 11.0001 * u, left_error = 8.001 * u;
constexpr double right_distance2 = 14.01 * u, right_both = 38.01 * u, right_radius2 = 28.01 * u;
constexpr double lowered = 0x1p-16;      // of the left side's square of the cosine
constexpr Device weakest{5 * u, 6 * u};  // OpenCL's limits

Polynomial radius_and_distance(double of_distance, double of_radius) {
  Polynomial p("R", of_radius);
  for (const std::string& k : axes) p = p + Polynomial("a" + k) * Polynomial("d" + k, of_distance);
  return p;
}

// results: a + R s, its least value, and both sides.
std::vector<Real> cone_kernel() {
  WorldGridParams world;
  world.slack = input("slack");
  world.reach = input("reach");
  BlockSides sides;
  sides.edge = input("edge");
  sides.centre = {input("cx"), input("cy"), input("cz")};
  sides.outer[0] = 0;
  const float4 light(input("lx"), input("ly"), input("lz"), input("r")),
      cone(input("ax"), input("ay"), input("az"), input("cos"));
  const ConeTest test = cone_test(light, cone, &sides, &world);
  meets_cone(&test, &sides, 0);
  const Naming naming;
  for (const std::string& k : axes) {
    give(input("c" + k) - input("l" + k), sized("d" + k, u));
    give(input("a" + k), sized("a" + k, u));  // a double, rounded
  }
  std::vector<Real> results;
  for (const char op : {'g', 'l'})
    for (const Choice& c : recorder.path().choices)
      if (c.op == op) results.insert(results.end(), {of(c.a), of(c.b)});
  return results;
}

// The choice between the sine and 1e-18: the sine.
std::optional<bool> narrow(const Choice&) { return true; }

// d, R, s: from the definitions; the cosine lowered.
Meaning meaning_of_cone() {
  Meaning m{{"slack", "reach", "edge", "cx", "cy", "cz", "lx", "ly", "lz", "r", "ax", "ay", "az", "cos"}, {}};
  m.adjust = [](Inputs& in) {
    for (const char* name : {"slack", "reach", "edge", "r"}) in[name] = std::fabs(in[name]);
    in["cos"] = std::fabs(in["cos"]) / 2.01L;
    return true;
  };
  m.values = [](const Inputs& in) {
    long double far = in.at("reach") + in.at("r"), along = 0, squared = 0;
    for (const std::string& k : axes) {
      const long double d = in.at("c" + k) - in.at("l" + k);
      far += std::fabs(in.at("l" + k));
      along += d * in.at("a" + k);
      squared += d * d;
    }
    const long double c = in.at("cos"), s = std::sqrt(1 - c * c),
                      radius = double(0.86603f) * in.at("edge") + 2 * in.at("slack") * far,
                      sum = along + radius * s;
    return Values{sum, radius * s - radius / s, (c * c - lowered) * squared,
                  sum * sum + radius * radius * c * c};
  };
  m.tolerance = 1e-10L;
  return m;
}

std::string prove_cone(const Fault& fault) {
  Path path = paths_of(cone_kernel, fault, narrow)[0];
  if (path.results.size() != 4) return "there are other comparisons";
  const auto find = [&](auto&& is) {
    for (int i = 0; i < int(path.nodes.size()); ++i)
      if (is(path.nodes[size_t(i)])) return i;
    throw std::runtime_error("a number is missing");
  };
  // The sine: at most 1. The ball's radius is what it is. The squared cosine is at most 1, also when it is lowered.
  const int sine = find([](const Node&n) { return n.op == 's'; }),
            square = find([&](const Node&n) {
              return n.op == '*' && n.a == n.b && path.nodes[size_t(n.a)].name == "cos";
            });
  const int quotient = find([](const Node&n) { return n.op == '/'; }),
            radius = path.nodes[size_t(quotient)].a;
  path.forms[sine] = {1, relative_error(path, sine, {}, weakest)};
  path.forms[radius] = sized("R");
  path.forms[square] = {1, u};
  path.forms[quotient] = {Polynomial("R") + Polynomial("R/s"), Polynomial()};
  const int along = path.results[0], left = path.results[2], right = path.results[3];
  const Form sum = form_of(path, along);
  if (const std::string e = exceeds("a + R s", sum.error, radius_and_distance(along_distance, along_radius));
      !e.empty())
    return e;
  Polynomial squares;
  for (const std::string& k : axes) squares = squares + Polynomial("d" + k) * Polynomial("d" + k);
  if (const std::string e =
          exceeds("the left side", form_of(path, left).error, squares * Polynomial(left_error));
      !e.empty())
    return e;
  // The products of coordinates add up to at most D.
  path.forms[along] = {Polynomial("D") + Polynomial("R"),
                       Polynomial("D", along_distance) + Polynomial("R", along_radius)};
  const Polynomial bound = Polynomial("D", right_distance2) * Polynomial("D") +
                           Polynomial("D", right_both) * Polynomial("R") +
                           Polynomial("R", right_radius2) * Polynomial("R");
  if (const std::string e = exceeds("the right side", form_of(path, right).error, bound); !e.empty())
    return e;
  // R / s: the least value times s.
  const double least = relative_error(path, quotient, {{radius, 0}}, weakest);
  if (const std::string e = exceeds("R / s", least, 15 * u); !e.empty()) return e;
  const bool planted = recorder.planted;
  const std::string e = meaning_differs(cone_kernel, fault, meaning_of_cone());
  recorder.planted |= planted;
  return e;
}

TEST(CertifyWorldCones, Cone) { EXPECT_EQ(prove_cone({}), ""); }
TEST(CertifyWorldCones, Faults) {
  const Faults f = planted_faults(prove_cone);
  EXPECT_GT(f.planted, 50);
  EXPECT_THAT(f.survived, testing::IsEmpty());
}

// Where D >= R / 2 the lowered square covers the right side's error. Where it is less, the right side exceeds the left
// one by at least 0.2 R^2, for each sine; its error is then at most 56u R^2.
TEST(CertifyWorldCones, LoweredSquareCoversTheSum) {
  EXPECT_LT(right_distance2 + 2 * right_both + 4 * right_radius2 + left_error, lowered);
  for (int i = 0; i <= 1000; ++i) {
    const double s = i / 1000.0, rest = std::max(s - 0.5, 0.0);  // a >= -D > -R / 2
    EXPECT_GT(0.75 * (1 - s * s) + rest * rest, 0.2 + right_distance2 / 4 + right_both / 2 + right_radius2);
  }
}

}  // namespace
}  // namespace lightgrid::certify
