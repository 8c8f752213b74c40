// Cells: tile sides, boxes, the distance of a box.
#include <gmock/gmock.h>

#include <cmath>

#include "certify/gappa.h"
#include "certify/kernel_text.h"
#include "certify/theorem.h"

namespace lightgrid::certify {
namespace {

// ---- tile_sides and box_between ----

// A pixel coordinate is a whole number, or half of one, below 2^21: exact.
std::vector<Real> sides_kernel() {
  CullParams p;
  p.tile_size = 16, p.width = p.height = 1280;
  p.inset = input("inset");
  p.slope_x_scale = input("scale0"), p.slope_y_scale = input("scale1");
  p.slope_x_offset = input("offset0"), p.slope_y_offset = input("offset1");
  const Real tx = input("tx"), ty = input("ty");
  const TileSides s = tile_sides(tx, ty, &p);
  const Naming naming;
  for (const Real scale : {p.slope_x_scale, p.slope_y_scale}) give(scale, sized("scale", u));
  for (const Real offset : {p.slope_x_offset, p.slope_y_offset}) give(offset, sized("offset", u));
  for (const Real t : {tx, ty})
    for (const Real pixel : {t * 16 + p.inset, t * 16 + 16 - p.inset, 1280 - p.inset})
      give(pixel, sized("p"));
  return {s.x0, s.x1, s.y0, s.y1};
}

// A side is within 3u |slope| + 5u |offset|, as |p scale| <= |slope| + |offset|.
Polynomial side_error() { return Polynomial("slope", 3.00001 * u) + Polynomial("offset", 5.00001 * u); }

std::string prove_sides(const Fault& fault) {
  const std::vector<Path> paths = paths_of(sides_kernel, fault);
  for (const Path& path : paths)
    for (const int side : path.results) {
      const Polynomial error =
          form_of(path, side).error.with("p*scale", Polynomial("slope") + Polynomial("offset"));
      if (const std::string e = exceeds("a side", error, side_error()); !e.empty()) return e;
    }
  Meaning m{{"scale0", "offset0", "scale1", "offset1", "tx", "ty", "inset"}, {}};
  m.adjust = [](Inputs& in) {
    for (const char* tile : {"tx", "ty"}) in[tile] = std::floor(std::fabs(in[tile]) * 50);
    return in["tx"] < 80 && in["ty"] < 80;
  };
  m.values = [](const Inputs& in) {
    Values v;
    for (const int axis : {0, 1}) {
      const long double first = in.at(axis ? "ty" : "tx") * 16, inset = in.at("inset");
      for (const long double pixel : {first + inset, std::min(first + 16, 1280.0L) - inset})
        v.push_back(pixel * in.at(axis ? "scale1" : "scale0") + in.at(axis ? "offset1" : "offset0"));
    }
    return v;
  };
  return meaning_differs(paths, m);
}

// A box's side where the cell has the distance t is within 4u |slope t| + 5u |offset t|. That it holds for every t of
// the cell, not only at its ends, is the order of rounding: t between them has its product between theirs.
std::string prove_box(const Fault& fault) {
  const std::vector<Path> paths = paths_of(
      [] {
        CullParams p;
        p.orthographic = 0;
        const TileSides s{input("x0"), input("x1"), input("y0"), input("y1")};
        const Box b = box_between(s, input("near"), input("far"), &p);
        for (const Real side : {s.x0, s.x1, s.y0, s.y1}) give(side, {Polynomial("slope"), side_error()});
        for (const char* end : {"near", "far"}) give(input(end), sized("t"));
        return std::vector{b.x0, b.x1, b.y0, b.y1};
      },
      fault);
  const Polynomial bound =
      (Polynomial("slope", box_slope_error) + Polynomial("offset", box_offset_error)) * Polynomial("t");
  for (const Path& path : paths)
    for (const int side : path.results)
      if (const std::string e = exceeds("a box", form_of(path, side).error, bound); !e.empty()) return e;
  Meaning m{{"x0", "x1", "y0", "y1", "near", "far"}, {}};
  m.values = [](const Inputs& in) {
    const auto end = [&](const char* side, bool most) {
      const long double n = in.at(side) * in.at("near"), f = in.at(side) * in.at("far");
      return most ? std::max(n, f) : std::min(n, f);
    };
    return Values{end("x0", false), end("x1", true), end("y0", false), end("y1", true)};
  };
  return meaning_differs(paths, m);
}

// ---- box_distance2 ----

std::vector<Real> distance_kernel() {
  const ViewSphere s{input("x"), input("y"), input("d"), input("r")};
  Cell c;
  c.near = input("near"), c.far = input("far");
  c.box_x0 = input("x0"), c.box_x1 = input("x1"), c.box_y0 = input("y0"), c.box_y1 = input("y1");
  const Real distance2 = box_distance2(s, &c);
  may_touch(s, &c, nullptr);
  return {distance2};
}

// The squared distance is within 5u of itself, the squared radius within u; and the light is dropped by the comparison
// of these two only.
std::string prove_distance(const Fault& fault) {
  const std::vector<Path> paths = paths_of(distance_kernel, fault);
  for (const Path& path : paths) {
    const int b2 = path.results[0];
    if (const std::string e = exceeds("a distance", relative_error(path, b2), distance_error); !e.empty())
      return e;
    int compared = 0;
    for (const Choice& c : path.choices) {
      const Node& r2 = path.nodes[size_t(c.b)];
      compared +=
          c.a == b2 && c.op == '>' && r2.op == '*' && r2.a == r2.b && path.nodes[size_t(r2.a)].name == "r";
    }
    if (compared != 1) return "the distance is not compared with the radius";
  }
  Meaning m{{"x", "y", "d", "r", "x0", "x1", "y0", "y1", "near", "far"}, {}};
  m.adjust = [](Inputs& in) {
    return in["x0"] < in["x1"] && in["y0"] < in["y1"] && in["near"] < in["far"] && in["r"] > 0;
  };
  m.values = [](const Inputs& in) {
    const auto beyond = [&](const char* x, const char* low, const char* high) {
      return std::max({in.at(low) - in.at(x), in.at(x) - in.at(high), 0.0L});
    };
    const long double x = beyond("x", "x0", "x1"), y = beyond("y", "y0", "y1"),
                      d = beyond("d", "near", "far");
    return Values{x * x + y * y + d * d};
  };
  return meaning_differs(paths, m);
}

// A larger box is no farther away, rounding included: each coordinate's distance is one rounded difference or 0, and the
// rounded sum of squares grows with each of them. Orders of six numbers are all there is to a coordinate.
std::string prove_larger_boxes_nearer(const Fault& fault) {
  const std::vector<Path> paths = paths_of(distance_kernel, fault);
  for (const Path& path : paths) {
    for (size_t i = 0; i < path.nodes.size(); ++i) {
      const Node& n = path.nodes[i];
      if (n.op != '-') continue;
      if (path.nodes[size_t(n.a)].op != 'i' || path.nodes[size_t(n.b)].op != 'i')
        return "a coordinate is rounded twice";
      for (const int sign : {-1, 1}) {
        Path there = path;
        there.signs[int(i)] = sign;
        if (direction_of(there, path.results[0], int(i)) != sign) return "not monotone";
      }
    }
  }
  const auto distance2 = [&](int x, int low, int high) {
    const Inputs in{{"x", x},  {"x0", low}, {"x1", high}, {"y", 0},   {"y0", 0},
                    {"y1", 0}, {"d", 0},    {"near", 0},  {"far", 0}, {"r", 1}};
    for (const Path& path : paths)
      if (const Values v = exact_values(path, in); is_taken(path, v)) return v[size_t(path.results[0])];
    return -1.0L;
  };
  for (int code = 0; code < 3125; ++code) {
    const int x = code % 5, low = code / 5 % 5, high = code / 25 % 5, less = code / 125 % 5,
              more = code / 625;
    if (less > low || low > high || high > more) continue;
    if (distance2(x, less, more) > distance2(x, low, high)) return "a larger box is farther";
  }
  return "";
}

TEST(CertifyCells, Sides) { EXPECT_EQ(prove_sides({}), ""); }
TEST(CertifyCells, Box) { EXPECT_EQ(prove_box({}), ""); }
TEST(CertifyCells, Distance) { EXPECT_EQ(prove_distance({}), ""); }
TEST(CertifyCells, DistanceByGappa) {
  if (!has_gappa()) GTEST_SKIP() << "there is no gappa (Debian: gappa)";
  const Proved proved = prove_by_gappa(paths_of(distance_kernel), [](const Path&) { return false; });
  EXPECT_GE(proved.scripts, 20u);
  EXPECT_LT(proved.largest / u, 5.0001);
}
TEST(CertifyCells, LargerBoxesAreNearer) { EXPECT_EQ(prove_larger_boxes_nearer({}), ""); }
TEST(CertifyCells, Faults) {
  for (const auto& proof : {prove_sides, prove_box, prove_distance}) {
    const Faults f = planted_faults(proof);
    EXPECT_GT(f.planted, 7);
    EXPECT_THAT(f.survived, testing::IsEmpty());
  }
}

}  // namespace
}  // namespace lightgrid::certify
