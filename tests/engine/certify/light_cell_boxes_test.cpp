// Light cells: a ray that meets a triangle's box in float is in one of the box's cells, for point lights.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "certify/light_cells_text.h"
#include "certify/theorem.h"

namespace lightgrid::certify {
namespace {

const std::array<std::string, 3> axes{"x", "y", "z"};

// A ray that passes the float test of a box goes through the box moved outwards by this much: parts of the sum of the
// light's coordinates, and of the greatest coordinate of the box relative to the light.
constexpr double box_size_error = 14.001 * u, box_most_error = 20.001 * u;
Polynomial box_error() {
  const Polynomial size = Polynomial("lx") + Polynomial("ly") + Polynomial("lz");
  return size * Polynomial(box_size_error) + Polynomial("m", box_most_error);
}

// ---- The float test of a box ----

// The order of three corners along an axis: "a", "c", "b".
bool in_order(const Choice& c, char a, char b) {
  const std::string order = "acb";
  return (c.op == '<') == (order.find(a) < order.find(b));
}

std::vector<Real> meets_kernel() {
  const Double x = input("lx"), y = input("ly"), z = input("lz");
  RayPacket p;
  set_packet(&p, {x, y, z, 1}, {input("tx"), input("ty"), input("tz")}, input("gap"));
  const RayOctants octants = octants_of(&p);
  take_octant(&p, &octants, 1);
  Real corners[9];
  for (size_t k = 0; k < 3; ++k)
    for (size_t corner = 0; corner < 3; ++corner) corners[3 * corner + k] = input("acb"[corner] + axes[k]);
  meets_own_box(&p, corners);
  const Naming naming;
  for (const std::string& k : axes) {
    give(input("l" + k), sized("l" + k));
    for (const char* corner : {"a", "b"})
      give(input(corner + k), Form{Polynomial("m") + Polynomial("l" + k), {}});
  }
  for (const auto& [x, axis] : {std::pair{p.inverse_x, "x"}, {p.inverse_y, "y"}, {p.inverse_z, "z"}})
    give(x, sized(std::string("i") + axis, u));
  const Choice& last = recorder.path().choices.back();
  return {of(last.a), of(last.b)};
}

// The axis of a ray's coordinate that a node is computed from.
char axis_of(int id) {
  const Node& n = recorder.node(id);
  if (n.op == 'i') return n.name[0] == 't' ? n.name[1] : ' ';
  const char first = n.a < 0 ? ' ' : axis_of(n.a);
  return first != ' ' || n.b < 0 ? first : axis_of(n.b);
}

// The path of rays that go up all axes, or down, and enter and leave the box along one.
Recorder::Decide going(bool down, char axis) {
  return [=](const Choice& c) -> std::optional<bool> {
    const Node &a = recorder.node(c.a), &b = recorder.node(c.b);
    if (a.op == 'i' && b.op == 'i') return in_order(c, a.name[0], b.name[0]);
    if (a.op == '*' && b.op == '*') return (c.op == '<') == down;  // -i (x - reach) and -i (x + reach)
    if (a.op == 'a') return false;                                 // not along a plane
    if (a.op == '/') return down;
    return axis_of(c.a) == axis;
  };
}

Meaning meaning_of_meets() {
  Meaning m{{"gap"}, {}};
  for (const std::string& k : axes)
    for (const char* name : {"l", "t", "a", "b", "c"}) m.inputs.push_back(name + k);
  m.adjust = [](Inputs& in) {
    in["gap"] = std::fabs(in["gap"]) / 8;
    return true;
  };
  m.values = [](const Inputs& in) {
    long double squared = 0, reach = 0, enter = 0, leave = HUGE_VALL;
    for (const std::string& k : axes) {
      const long double d = in.at("t" + k) - in.at("l" + k);
      squared += d * d;
      reach += 0x1p-22L * std::fabs(in.at("l" + k));
    }
    leave = 1 - in.at("gap") / std::sqrt(squared);
    for (const std::string& k : axes) {
      const long double d = in.at("t" + k) - in.at("l" + k);
      const auto [least, greatest] = std::minmax({in.at("a" + k), in.at("b" + k), in.at("c" + k)});
      const long double low = (least - reach - in.at("l" + k)) / d,
                        high = (greatest + reach - in.at("l" + k)) / d;
      enter = std::max(enter, std::min(low, high));
      leave = std::min(leave, std::max(low, high));
    }
    return Values{enter, leave * double(1.000001f)};
  };
  m.samples = 30;
  return m;
}

// Both ends of the ray's part in the box, as coordinates: the box's, moved outwards by the reach that the test adds, by
// what its comparison allows, and by all rounding.
std::string prove_meets(const Fault& fault) {
  const double slack = double(1.000001f);
  const Polynomial reach =
      (Polynomial("lx") + Polynomial("ly") + Polynomial("lz")) * Polynomial(0x1p-22 * slack);
  bool planted = false;
  for (const bool down : {false, true})
    for (const std::string& k : axes) {
      const Path path = paths_of(meets_kernel, fault, going(down, k[0]))[0];
      planted |= recorder.planted;
      for (const bool leaves : {false, true}) {
        Polynomial moved = form_of(path, path.results[leaves]).error + Polynomial("i" + k) * reach;
        if (leaves) moved = moved + Polynomial("i" + k) * Polynomial("m", slack - 1);
        if (const std::string e = exceeds("a box", moved, Polynomial("i" + k) * box_error()); !e.empty())
          return e;
      }
    }
  const std::string e = meaning_differs(meets_kernel, fault, meaning_of_meets());
  recorder.planted |= planted;
  return e;
}

TEST(CertifyLightCells, BoxesThatRaysMeet) { EXPECT_EQ(prove_meets({}), ""); }

// ---- The boxes of the lists ----

// From corners (a triangle's, in double relative to the light) or from a node's sides.
std::vector<Real> boxes_kernel(bool triangle) {
  LightCellJob job{};
  job.x = input("lx");
  job.y = input("ly");
  job.z = input("lz");
  job.w = 1;
  job.grid.top = -2.0f;
  Real low[3], high[3], near;
  if (triangle) {
    SeenTriangles s;
    Double c[3][3];
    for (size_t k = 0; k < 3; ++k)
      for (size_t corner = 0; corner < 3; ++corner) c[corner][k] = input("acb"[corner] + axes[k]);
    see_boxes(&s, &job, c);
    std::copy(s.low, s.low + 3, low);
    std::copy(s.high, s.high + 3, high);
    near = s.near;
  } else {
    Real a[3], b[3];
    for (size_t k = 0; k < 3; ++k) {
      a[k] = input("a" + axes[k]);
      b[k] = input("b" + axes[k]);
    }
    const SeenBox box = seen_box(&job, a, b);
    std::copy(box.low, box.low + 3, low);
    std::copy(box.high, box.high + 3, high);
    near = box.near;
  }
  const Naming naming;
  for (const std::string& k : axes) {
    give(input("l" + k), sized("l" + k));
    for (const char* corner : {"a", "b"})
      give(triangle ? input(corner + k) : of((Double(input(corner + k)) - Double(input("l" + k))).id),
           sized("m"));
  }
  return {low[0], low[1], low[2], high[0], high[1], high[2], near};
}

// Corner a is the least one and b the greatest. The box lies above the light along all axes.
std::optional<bool> above(const Choice& c) {
  const Node &a = recorder.node(c.a), &b = recorder.node(c.b);
  if (a.op == 'r' && b.op == 'r') return in_order(c, recorder.node(a.a).name[0], recorder.node(b.a).name[0]);
  if (a.op == 'a' || b.op == 'a') return false;  // the greatest coordinate
  return true;
}

Meaning meaning_of_boxes(bool triangle, const Fault& fault) {
  Meaning m{{"lx", "ly", "lz"}, {}};
  for (const std::string& k : axes)
    for (const char* name : {"a", "b", "c"}) m.inputs.push_back(name + k);
  m.adjust = [triangle](Inputs& in) {
    for (const std::string& k : axes) {
      for (const char* corner : {"a", "b"}) in[corner + k] = in["c" + k] + in[corner + k] / 8;
      if (!triangle && in["a" + k] > in["b" + k]) std::swap(in["a" + k], in["b" + k]);
    }
    return true;
  };
  m.values = [=](const Inputs& in) {
    long double size = 0, most = 0, squared = 0, low[3], high[3];
    for (size_t k = 0; k < 3; ++k) {
      const long double light = in.at("l" + axes[k]), from = triangle ? 0 : light;
      low[k] = in.at("a" + axes[k]) - from;
      high[k] = in.at("b" + axes[k]) - from;
      if (triangle) {
        const auto [least, greatest] = std::minmax({low[k], high[k], (long double)in.at("c" + axes[k])});
        low[k] = least;
        high[k] = greatest;
      }
      size += std::fabs(light);
      most = std::max({most, std::fabs(low[k]), std::fabs(high[k])});
    }
    const long double pad = constant_of(double(BOX_PAD), fault) * (size + most) + double(1e-12f);
    Values v;
    for (size_t k = 0; k < 3; ++k) v.push_back(low[k] - pad);
    for (size_t k = 0; k < 3; ++k) v.push_back(high[k] + pad);
    for (size_t k = 0; k < 3; ++k) {
      const long double away = std::max({v[k], -v[3 + k], 0.0L});
      squared += away * away;
    }
    v.push_back(std::sqrt(squared) * double(0.9999f));
    return v;
  };
  m.samples = 30;
  return m;
}

// The boxes of the lists, with all their rounding, hold those that rays meet. The distance of a box is not above the
// length of a ray to it: that ends at 1 + 1e-6 of it at most, and has an error of 4u.
std::string prove_boxes(bool triangle, const Fault& fault) {
  const auto kernel = [triangle] { return boxes_kernel(triangle); };
  const Polynomial pad = (Polynomial("lx") + Polynomial("ly") + Polynomial("lz") + Polynomial("m")) *
                             Polynomial(constant_of(double(BOX_PAD), fault)) +
                         1e-12;
  const Path path = paths_of(kernel, fault, above)[0];
  const bool planted = recorder.planted;
  std::map<int, double> given;
  for (size_t i = 0; i < 6; ++i) {
    const std::string e = exceeds("a box", form_of(path, path.results[i]).error + box_error(), pad);
    if (!e.empty()) return e;
    if (i < 3) given[path.results[i]] = 0;
  }
  const double distance = relative_error(path, path.results[6], given) + double(1.000001f) - 1 + 6 * u;
  if (const std::string e = exceeds("a distance", distance, 1 - double(0.9999f)); !e.empty()) return e;
  const std::string e = meaning_differs(kernel, fault, meaning_of_boxes(triangle, fault));
  recorder.planted |= planted;
  return e;
}

std::string prove_triangles(const Fault& fault) { return prove_boxes(true, fault); }
std::string prove_nodes(const Fault& fault) { return prove_boxes(false, fault); }

TEST(CertifyLightCells, BoxesOfTriangles) { EXPECT_EQ(prove_triangles({}), ""); }
TEST(CertifyLightCells, BoxesOfNodes) { EXPECT_EQ(prove_nodes({}), ""); }
TEST(CertifyLightCells, BoxPad) {
  const double least =
      std::max(least_constant(prove_triangles, BOX_PAD), least_constant(prove_nodes, BOX_PAD));
  EXPECT_THAT(least, testing::AllOf(testing::Gt(1e-6), testing::Lt(2e-6)));
}

// ---- The cells of a box ----

Kernel cells_kernel(int size) {
  return [size] {
    Real first, last;
    const Real low = input("low"), high = input("high");
    const int seen =
        cells_of_boxes(low, high, input("along_low"), input("along_high"), Real(size), &first, &last);
    const Naming naming;
    for (int i = 0; i < int(recorder.path().nodes.size()); ++i)
      if (recorder.node(i).op == '/') give(of(i), Form{1, u});
    return std::vector{first, last, Real(seen)};
  };
}

Meaning meaning_of_cells(int size, const Fault& fault) {
  Meaning m{{"low", "high", "along_low", "along_high"}, {}};
  m.adjust = [](Inputs& in) {
    if (in["low"] > in["high"]) std::swap(in["low"], in["high"]);
    if (in["along_low"] > in["along_high"]) std::swap(in["along_low"], in["along_high"]);
    return in["along_high"] > 0;
  };
  m.values = [size, slack = constant_of(double(CELL_SLACK), fault)](const Inputs& in) {
    // The least and the greatest quotient of a box's coordinates, as places.
    const long double nearest = std::max<long double>(in.at("along_low"), double(1e-30f)),
                      farthest = in.at("along_high");
    const long double begin =
                          (std::min(in.at("low") / nearest, in.at("low") / farthest) + 1) * size / 2 - slack,
                      end = (std::max(in.at("high") / nearest, in.at("high") / farthest) + 1) * size / 2 +
                            slack;
    return Values{std::floor(std::max(begin, 0.0L)), std::floor(std::min(end, size - 1.0L)),
                  (long double)(begin < size && end >= 0)};
  };
  m.samples = 2000;
  return m;
}

// The first and the last place have an error that, with that of a ray's place, is less than CELL_SLACK. Quotients beyond
// 1 are outside of the face, and floats of greater numbers are not less.
std::string prove_cells(const Fault& fault) {
  for (int size = 8; size <= 96; size += 8) {
    for (const Path& path : paths_of(cells_kernel(size), fault))
      for (const Choice& c : path.choices) {
        const char op = path.nodes[size_t(c.a)].op;
        if (op != '+' && op != '-') continue;
        const Polynomial error = form_of(path, c.a).error + 4.0001 * u * size / 2;
        const std::string e = exceeds("a place", error, Polynomial(constant_of(double(CELL_SLACK), fault)));
        if (!e.empty()) return e;
      }
  }
  const bool planted = recorder.planted;
  const std::string e = meaning_differs(paths_of(cells_kernel(64), fault), meaning_of_cells(64, fault));
  recorder.planted |= planted;
  return e;
}

TEST(CertifyLightCells, CellsOfBoxes) { EXPECT_EQ(prove_cells({}), ""); }
TEST(CertifyLightCells, CellSlack) {
  EXPECT_THAT(double(least_constant(prove_cells, CELL_SLACK)),
              testing::AllOf(testing::Gt(1e-5), testing::Lt(5e-5)));
}

// Three faults of each change nothing. A ray's coordinates are the same floats here and in its cell's lookup. A box's
// greatest coordinate is that of its upper side or minus that of its lower side.
TEST(CertifyLightCells, BoxFaults) {
  for (const auto& [proof, equal] :
       {std::pair<Proof, size_t>{prove_meets, 3}, {prove_triangles, 3}, {prove_nodes, 3}, {prove_cells, 0}}) {
    const Faults f = planted_faults(proof);

    EXPECT_GT(f.planted, 20);
    EXPECT_THAT(f.survived, testing::SizeIs(equal)) << testing::PrintToString(f.survived);
  }
}

}  // namespace
}  // namespace lightgrid::certify
