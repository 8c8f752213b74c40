// cull-test=exact, and cones: bounds of their expressions. The sum of the exact test is by hand (docs/certificate.md).
#define CULL_TEST 4
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "certify/kernel_text.h"
#include "certify/theorem.h"

namespace lightgrid::certify {
namespace {

// ---- section_at ----

Kernel section_kernel(uint orthographic) {
  return [orthographic] {
    const ViewSphere s{input("x"), input("y"), input("d"), input("r")};
    Cell c;
    c.x0 = input("x0"), c.x1 = input("x1"), c.y0 = input("y0"), c.y1 = input("y1");
    const Real t = input("t");
    const Section at = section_at(s, &c, t, orthographic);
    const Naming naming;
    const Real scale = orthographic ? Real(1.0f) : t;
    // X from a side: the product's rounding is u of X and of the centre, the difference's u of X.
    for (const auto& [side, centre] : {std::pair{c.x0, s.x}, {c.x1, s.x}, {c.y0, s.y}, {c.y1, s.y}}) {
      const Form far{Polynomial("X"), Polynomial("X", 2 * u * (1 + u)) + Polynomial("S", u * (1 + u))};
      give(side * scale - centre, far);
      give(centre - side * scale, far);
      give(side, sized("K"));
    }
    give(t - s.d, sized("T", u));
    return std::vector{at.f, at.g, at.bend};
  };
}

// The squared distance from the centre to the section at t, by the definition.
long double squared_distance(const Inputs& in, long double t, bool orthographic) {
  const long double scale = orthographic ? 1 : t;
  const auto beyond = [&](const char* centre, const char* low, const char* high) {
    return std::max({in.at(low) * scale - in.at(centre), in.at(centre) - in.at(high) * scale, 0.0L});
  };
  return std::pow(t - in.at("d"), 2) + std::pow(beyond("x", "x0", "x1"), 2) +
         std::pow(beyond("y", "y0", "y1"), 2);
}

// g is half the slope of f and bend half its curvature: exact by differences where no side changes between them.
Meaning meaning_of_section(bool orthographic) {
  constexpr long double h = 0x1p-12L;
  Meaning m{{"x", "y", "d", "r", "x0", "x1", "y0", "y1", "t"}, {}};
  m.adjust = [orthographic](Inputs& in) {
    for (const auto& [x, low, high] : {std::tuple{"x", "x0", "x1"}, {"y", "y0", "y1"}}) {
      for (const char* side : {low, high}) {
        const long double at = in[side] * (orthographic ? 1 : in["t"]) - in[x];
        if (std::fabs(at) < 0.01L) return false;
      }
      if (in[low] >= in[high]) return false;
    }
    return in["t"] > 0.01L;
  };
  m.values = [orthographic](const Inputs& in) {
    const long double t = in.at("t"), f = squared_distance(in, t, orthographic);
    const long double before = squared_distance(in, t - h, orthographic),
                      after = squared_distance(in, t + h, orthographic);
    return Values{f, (after - before) / (4 * h), (after - 2 * f + before) / (2 * h * h)};
  };
  m.tolerance = 1e-9L;
  return m;
}

// f within 7u of each square and 2u S X; g within 3u T + 6u K X + 2u K S, where the slack is 24u (S + r)(1 + K^2).
std::string prove_section(bool orthographic, const Fault& fault) {
  const std::vector<Path> paths = paths_of(section_kernel(orthographic), fault);
  Polynomial f("T*T", 6.0001 * u), g("T", 4.0001 * u);
  f.add("X*X", 2 * 7.0001 * u), f.add("S*X", 2 * 2.0001 * u), f.add("S*S", 2 * 1.0001 * u * u);
  g.add("K*X", 2 * 5.0001 * u), g.add("K*S", 2 * 1.0001 * u);
  for (const Path& path : paths) {
    if (const std::string e = exceeds("f", form_of(path, path.results[0]).error, f); !e.empty()) return e;
    if (const std::string e = exceeds("g", form_of(path, path.results[1]).error, g); !e.empty()) return e;
    if (const std::string e = exceeds("bend", relative_error(path, path.results[2]), 3.0001 * u); !e.empty())
      return e;
  }
  return meaning_differs(paths, meaning_of_section(orthographic));
}

std::string prove_section(const Fault& fault) { return prove_section(false, fault); }

TEST(CertifyExact, Section) { EXPECT_EQ(prove_section({}), ""); }
TEST(CertifyExact, OrthographicSection) { EXPECT_EQ(prove_section(true, {}), ""); }
TEST(CertifyExact, Faults) {
  const Faults f = planted_faults([](const Fault& fault) { return prove_section(fault); });
  EXPECT_GT(f.planted, 20);
  EXPECT_THAT(f.survived, testing::IsEmpty());
}

// ---- view_cone ----

std::vector<Real> view_cone_kernel() {
  CullParams p;
  Real* axes[] = {&p.x_axis_x, &p.x_axis_y, &p.x_axis_z, &p.y_axis_x, &p.y_axis_y,
                  &p.y_axis_z, &p.d_axis_x, &p.d_axis_y, &p.d_axis_z};
  Real light[8];
  for (int i = 0; i < 9; ++i) *axes[i] = input("a" + std::to_string(i));
  for (int i = 0; i < 8; ++i) light[i] = input("w" + std::to_string(i));
  const ViewCone k = view_cone(light, 1, &p);
  const Naming naming;
  for (int i = 0; i < 9; ++i) give(*axes[i], sized("a" + std::to_string(i), u));  // doubles, rounded
  for (int i = 4; i < 7; ++i) give(light[i], sized("w" + std::to_string(i), u));
  return {k.x, k.y, k.d};
}

// Before its division by its length, each coordinate of the axis is within 5u of |row| |axis|; the length is within 3.5u.
std::string prove_view_cone(const Fault& fault) {
  const std::vector<Path> paths = paths_of(view_cone_kernel, fault);
  const Path& path = paths[0];
  std::map<int, double> coordinates;
  for (const int id : path.results) {
    if (path.nodes[size_t(id)].op != '/') return "the axis is no unit vector";
    coordinates[path.nodes[size_t(id)].a] = 0;
  }
  for (int row = 0; row < 3; ++row) {
    const Node& k = path.nodes[size_t(path.results[size_t(row)])];
    Polynomial bound;
    for (int i = 0; i < 3; ++i)
      bound.add("a" + std::to_string(row * 3 + i) + "*w" + std::to_string(4 + i), axis_error);
    if (const std::string e = exceeds("an axis", form_of(path, k.a).error, bound); !e.empty()) return e;
    if (const std::string e = exceeds("a length", relative_error(path, k.b, coordinates), length_error);
        !e.empty())
      return e;
  }
  Meaning m;
  for (int i = 0; i < 9; ++i) m.inputs.push_back("a" + std::to_string(i));
  for (int i = 0; i < 8; ++i) m.inputs.push_back("w" + std::to_string(i));
  m.values = [](const Inputs& in) {
    Values v;
    for (int row = 0; row < 3; ++row) {
      v.push_back(0);
      for (int i = 0; i < 3; ++i)
        v.back() += in.at("a" + std::to_string(row * 3 + i)) * in.at("w" + std::to_string(4 + i));
    }
    const long double length = std::hypot(v[0], v[1], v[2]);
    for (long double& x : v) x /= length;
    return v;
  };
  return meaning_differs(paths, m);
}

TEST(CertifyCones, ViewCone) { EXPECT_EQ(prove_view_cone({}), ""); }

// ---- cone_may_touch ----

// The cone's two comparisons: how far the box's sphere is outside its side, and how far behind its apex.
std::vector<Real> cone_kernel() {
  const ViewSphere s{input("x"), input("y"), input("d"), input("r")};
  const ViewCone k{input("kx"), input("ky"), input("kd"), input("cosine")};
  Cell c;
  c.near = input("near"), c.far = input("far");
  c.box_x0 = input("x0"), c.box_x1 = input("x1"), c.box_y0 = input("y0"), c.box_y1 = input("y1");
  CullParams p;
  p.side_slack = input("side"), p.side_slack_m = input("side_m"), p.cone_slack_m = input("cone_m");
  cone_may_touch(s, k, &c, &p);
  const Choice *side = nullptr, *behind = nullptr;
  for (const Choice& found : recorder.path().choices) {
    if (found.op == '>' && recorder.node(found.b).op != 'c') side = &found;
    if (found.op == '<' && recorder.node(found.b).op == 'n') behind = &found;
  }
  if (!side || !behind) throw std::runtime_error("a comparison is missing");
  const std::vector<Real> results{of(side->a), of(side->b), of(behind->a), of(behind->b)};
  const Naming naming;
  // The box's middle m rounds by u of itself, and the difference V from the apex once more; the axis is a unit vector.
  const Real middles[] = {0.5f * (c.box_x0 + c.box_x1), 0.5f * (c.box_y0 + c.box_y1),
                          0.5f * (c.near + c.far)};
  const Real apex[] = {s.x, s.y, s.d}, axis[] = {k.x, k.y, k.d};
  for (int i = 0; i < 3; ++i) {
    const std::string n = std::to_string(i);
    give(middles[i] - apex[i],
         {Polynomial("V" + n), Polynomial("V" + n, u) + Polynomial("m" + n, u * (1 + u))});
    give(axis[i], {Polynomial(1.0), {}});
  }
  return results;
}

Meaning meaning_of_cone() {
  Meaning m{{"x", "y", "d", "r", "kx", "ky", "kd", "cosine", "near", "far", "x0", "x1", "y0", "y1", "side",
             "side_m", "cone_m"},
            {}};
  m.adjust = [](Inputs& in) { return in["cosine"] > -1 && in["cosine"] < 2; };
  m.values = [](const Inputs& in) {
    long double v[3], size2 = 0, centre = 0, sum = 0;
    const long double k[] = {in.at("kx"), in.at("ky"), in.at("kd")};
    const char* names[3][3] = {{"x0", "x1", "x"}, {"y0", "y1", "y"}, {"near", "far", "d"}};
    for (int i = 0; i < 3; ++i) {
      const long double low = in.at(names[i][0]), high = in.at(names[i][1]), middle = (low + high) / 2;
      v[i] = middle - in.at(names[i][2]);
      size2 += (high - low) * (high - low);
      centre += std::fabs(middle);
      sum += std::fabs(v[i]) + std::fabs(in.at(names[i][2]));
    }
    const long double along = v[0] * k[0] + v[1] * k[1] + v[2] * k[2];
    const long double across =
        std::hypot(v[1] * k[2] - v[2] * k[1], v[2] * k[0] - v[0] * k[2], v[0] * k[1] - v[1] * k[0]);
    const long double cosine = in.at("cosine"), sine = std::sqrt(std::max(1 - cosine * cosine, 0.0L));
    const long double reach = std::sqrt(size2) / 2 * (1.0f + SLACK) +
                              in.at("side") * (std::fabs(in.at("near")) + std::fabs(in.at("far"))) +
                              in.at("side_m") + double(LEAST_RADIUS) + in.at("cone_m") +
                              2.0f * SLACK * (sum + centre);
    return Values{across * cosine - along * sine, reach, along, -reach};
  };
  return m;
}

// along within 4u V + u m for each coordinate, and each part of the cross product within 3u V + u m: together less than
// half of the slack, 48u of V, of the apex and of m.
std::string prove_cone(const Fault& fault) {
  const std::vector<Path> paths = paths_of(cone_kernel, fault);
  Polynomial along, across;
  for (const std::string i : {"0", "1", "2"}) {
    along.add("V" + i, along_error), along.add("m" + i, 1.0001 * u);
    across.add("V" + i, across_error), across.add("m" + i, 1.0001 * u);
  }
  for (const Path& path : paths) {
    if (const std::string e = exceeds("along", form_of(path, path.results[2]).error, along); !e.empty())
      return e;
    int parts = 0;
    for (size_t i = 0; i < path.nodes.size(); ++i) {  // squares of differences of products
      const Node& square = path.nodes[i];
      if (square.op != '*' || square.a != square.b || path.nodes[size_t(square.a)].op != '-') continue;
      const Node& part = path.nodes[size_t(square.a)];
      if (path.nodes[size_t(part.a)].op != '*') continue;
      ++parts;
      if (const std::string e = exceeds("across", form_of(path, square.a).error, across); !e.empty())
        return e;
    }
    if (parts != 3) return "the cross product is not there";
    Inputs zero;
    for (const std::string& name : meaning_of_cone().inputs) zero[name] = 0;
    const double least = double(exact_values(path, zero)[size_t(path.results[1])]);
    if (const std::string e = exceeds("LEAST_RADIUS", double(LEAST_RADIUS), least); !e.empty()) return e;
  }
  return meaning_differs(paths, meaning_of_cone());
}

TEST(CertifyCones, AlongAndAcross) { EXPECT_EQ(prove_cone({}), ""); }
TEST(CertifyCones, Faults) {
  for (const auto& proof : {prove_view_cone, prove_cone}) {
    const Faults f = planted_faults(proof);
    EXPECT_GT(f.planted, 40);
    EXPECT_THAT(f.survived, testing::IsEmpty());
  }
}

}  // namespace
}  // namespace lightgrid::certify
