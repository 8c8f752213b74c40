// The world grid: the position in cells, and the distance of a light from a block of cells.
#include <gmock/gmock.h>

#include <climits>
#include <cmath>
#include <cstdint>

#include "certify/theorem.h"

namespace lightgrid::certify {
namespace {

using uint = std::uint32_t;
Real fmax(Real a, Real b) { return a > b ? a : b; }
int convert_int(Real) { return 0; }  // a whole number is no result here

#define float Real
#include "certify/world_text.h"
#undef float

const std::vector<std::string> axes{"x", "y", "z"};

// ---- world_position ----

std::vector<Real> position_kernel() {
  WorldViewParams v;
  Real* rows[] = {&v.x_x, &v.x_y, &v.x_z, &v.y_x, &v.y_y, &v.y_z, &v.z_x, &v.z_y, &v.z_z};
  Real* offsets[] = {&v.x_offset, &v.y_offset, &v.z_offset};
  for (size_t row = 0; row < 3; ++row) {
    for (size_t i = 0; i < 3; ++i) {
      *rows[3 * row + i] = input(axes[row] + axes[i]);
      give(*rows[3 * row + i], sized(axes[row] + axes[i], u));  // a double, rounded
    }
    *offsets[row] = input("o" + axes[row]);
    give(*offsets[row], sized("o" + axes[row], u));
  }
  Real3 p{input("px"), input("py"), input("pz")};
  for (const Real at : {p.x, p.y, p.z}) give(at, sized(recorder.node(at.id).name));
  const Real3 at = world_position(p, &v);
  return {at.x, at.y, at.z};
}

// Each coordinate is within 5u |row| |p| + 2u |offset|.
std::string prove_position(const Fault& fault) {
  const std::vector<Path> paths = paths_of(position_kernel, fault);
  Meaning m{{"px", "py", "pz"}, {}};
  for (size_t row = 0; row < 3; ++row) {
    Polynomial bound("o" + axes[row], 2.00001 * u);
    m.inputs.push_back("o" + axes[row]);
    for (const std::string& i : axes) {
      bound = bound + Polynomial("p" + i, 5.00001 * u) * Polynomial(axes[row] + i);
      m.inputs.push_back(axes[row] + i);
    }
    const Form f = form_of(paths[0], paths[0].results[row]);
    if (const std::string e = exceeds(axes[row], f.error, bound); !e.empty()) return e;
  }
  m.values = [](const Inputs& in) {
    Values v;
    for (const std::string& row : axes) {
      v.push_back(in.at("o" + row));
      for (const std::string& i : axes) v.back() += in.at(row + i) * in.at("p" + i);
    }
    return v;
  };
  return meaning_differs(paths, m);
}

// ---- world_meets_block ----

// The block from 8 to 16 along each axis, counted from the grid's end.
std::vector<Real> block_kernel() {
  WorldGridParams p;
  p.shift_x = p.shift_y = p.shift_z = 2;
  p.cells_x = p.cells_y = p.cells_z = 64;
  p.min_x = input("minx"), p.min_y = input("miny"), p.min_z = input("minz");
  const float4 light{input("x"), input("y"), input("z"), input("r")};
  world_meets_block(light, 1, 1, 1, 1, &p);
  const Choice& last = recorder.path().choices.back();
  return {of(last.a), of(last.b)};
}

// The squared distance is within 5u of itself and the squared radius within u, for the sides as rounded; the light is
// kept where the first is not above the second.
std::string prove_block(const Fault& fault) {
  const std::vector<Path> paths = paths_of(block_kernel, fault);
  for (const Path& path : paths) {
    const auto& nodes = path.nodes;
    std::map<int, double> given;  // a side minus the light, or the reverse: one rounding
    for (size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].op != '-') continue;
      const Node &a = nodes[size_t(nodes[i].a)], &b = nodes[size_t(nodes[i].b)];
      if ((a.op == '+' && b.op == 'i') || (a.op == 'i' && b.op == '+')) given[int(i)] = u;
    }
    if (path.choices.back().op != 'l') return "not compared with <=";
    for (const int result : {0, 1}) {
      const double error = relative_error(path, path.results[size_t(result)], given);
      if (const std::string e = exceeds("a square", error, (result == 0 ? 5.00001 : 1.00001) * u); !e.empty())
        return e;
    }
  }
  Meaning m{{"x", "y", "z", "r", "minx", "miny", "minz"}, {}};
  m.low = -20, m.high = 20;
  m.values = [](const Inputs& in) {
    long double sum = 0;
    for (const std::string& axis : axes) {
      const long double low = in.at("min" + axis) + 8, x = in.at(axis);
      const long double away = std::max({low - x, x - low - 8, 0.0L});
      sum += away * away;
    }
    return Values{sum, in.at("r") * in.at("r")};
  };
  return meaning_differs(paths, m);
}

// The sum of docs/details/world_grid.md#slack, with |p| at most reach + |L| + r.
TEST(CertifyWorld, SlackCoversTheSum) {
  const double root3 = std::sqrt(3.0), position = 5.00001 * root3, shaded = 8;  // of |p|
  const double reach = root3 + position + 2.00001 + shaded;
  const double light = root3 + position + shaded + 3 + 4, radius = 6 + position + shaded + 3 + 4;
  EXPECT_LT(std::max({reach, light, radius}), 32);
}

TEST(CertifyWorld, Position) { EXPECT_EQ(prove_position({}), ""); }
TEST(CertifyWorld, Block) { EXPECT_EQ(prove_block({}), ""); }
TEST(CertifyWorld, Faults) {
  for (const auto& proof : {prove_position, prove_block}) {
    const Faults f = planted_faults(proof);
    EXPECT_GT(f.planted, 30);
    EXPECT_THAT(f.survived, testing::IsEmpty());
  }
}

}  // namespace
}  // namespace lightgrid::certify
