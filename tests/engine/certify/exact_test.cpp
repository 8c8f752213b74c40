// cull-test=exact, and cones: bounds of their expressions. slack_test.cpp adds them up.
#define CULL_TEST 4
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>
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
    // The product's rounding is a change of the side by u of it: all distances are those of the changed cell, and only
    // their differences X round.
    for (const auto& [side, centre] : {std::pair{c.x0, s.x}, {c.x1, s.x}, {c.y0, s.y}, {c.y1, s.y}}) {
      give(side * scale - centre, sized("X", u));
      give(centre - side * scale, sized("X", u));
      give(side, sized("K", u));
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

// f within 5u of itself; g within 5u of T + K X, which is the sum of its terms' sizes.
std::string prove_section(bool orthographic, const Fault& fault) {
  const std::vector<Path> paths = paths_of(section_kernel(orthographic), fault);
  const Polynomial g("T", section_g_error), slope("K*X", 2 * section_g_error);
  for (const Path& path : paths) {
    std::map<int, double> differences;
    for (const auto& [node, form] : path.forms)
      if (path.nodes[size_t(node)].op == '-') differences[node] = u;
    const double f = relative_error(path, path.results[0], differences);
    if (const std::string e = exceeds("f", f, section_f_error); !e.empty()) return e;
    if (const std::string e = exceeds("g", form_of(path, path.results[1]).error, g + slope); !e.empty())
      return e;
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

// ---- exact_may_touch ----

// One step of the loop, between sections that are left of and below the cell: section_at has its paths above. The result
// is the bound that is compared with r2. Sizes: F is f, W is |g| + E, the part by which g is moved, Z is step.
bool is_square_of_radius(const Node& n) {
  return n.op == '*' && n.a == n.b && recorder.node(n.a).name == "r";
}

std::optional<bool> one_step(const Choice& c) {
  const Node &a = recorder.node(c.a), &b = recorder.node(c.b);
  const bool of_sides = a.op == '-' && (b.op == '-' || (b.op == 'c' && b.value == 0));
  if (of_sides) return a.a >= 0 && recorder.node(a.a).op == '*';
  if (a.op != '+' || !is_square_of_radius(b)) return std::nullopt;
  for (const Choice& before : recorder.path().choices)
    if (before.b == c.b && recorder.node(before.a).op == '+') return false;  // the first section misses
  return true;
}

std::vector<Real> bound_kernel() {
  const ViewSphere s{input("x"), input("y"), input("d"), input("r")};
  Cell c;
  c.near = input("near"), c.far = input("far");
  c.x0 = input("x0"), c.x1 = input("x1"), c.y0 = input("y0"), c.y1 = input("y1");
  exact_may_touch(1, s, &c, 0);
  give_sign(s.r, 1);
  const Choice* beyond = nullptr;
  for (const Choice& k : recorder.path().choices)
    if (k.op == '>' && recorder.node(k.a).op == '-' && is_square_of_radius(recorder.node(k.b))) beyond = &k;
  if (!beyond) throw std::runtime_error("the bound is not compared");
  return {of(beyond->a)};
}

// The step's bound by its definition, at a Newton iterate of f. False: the inputs do not take the path.
bool bound_by_definition(const Inputs& in, long double& bound) {
  const long double x0 = in.at("x0"), y0 = in.at("y0"), x = in.at("x"), y = in.at("y"), d = in.at("d"),
                    r = in.at("r"), near = in.at("near"), far = in.at("far"), bend = 1 + x0 * x0 + y0 * y0;
  const auto left = [&](long double t) { return x0 * t - x; };
  const auto low = [&](long double t) { return y0 * t - y; };
  const auto f = [&](long double t) {
    return std::pow(t - d, 2) + std::pow(left(t), 2) + std::pow(low(t), 2);
  };
  const auto g = [&](long double t) { return t - d + x0 * left(t) + y0 * low(t); };
  const long double start = std::clamp(d, near, far), t = std::clamp(start - g(start) / bend, near, far);
  if (left(start) <= 0 || low(start) <= 0 || left(t) <= 0 || low(t) <= 0 || f(start) <= r * r || f(t) > r * r)
    return false;
  const long double error = SLACK * (std::fabs(x) + std::fabs(y) + std::fabs(d) + r) * bend;
  const long double steepest = std::fabs(g(t)) + error,
                    step = std::min(steepest, g(t) > 0 ? t - near : far - t);
  bound = f(t) - (2 * steepest - step) * step - error * error;
  return true;
}

// Lights left of and below the cell and about as far from it as their radius.
std::vector<Inputs> inputs_of_one_step() {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> any(0, 1);
  std::vector<Inputs> found;
  while (found.size() < 30) {
    Inputs in{{"near", any(random)}, {"x0", any(random)}, {"y0", any(random)}, {"x1", 2}, {"y1", 2}};
    in["far"] = in["near"] + any(random);
    in["x"] = any(random) - 0.5, in["y"] = any(random) - 0.5, in["d"] = 2 * any(random) - 0.5;
    in["r"] = any(random);
    if (long double bound; bound_by_definition(in, bound)) found.push_back(in);
  }
  return found;
}

// The bound's sum rounds by 2u of f - (2 W - Z) Z, the product by 2u of itself.
std::string prove_bound(const Fault& fault) {
  const std::vector<Path> paths = paths_of(bound_kernel, fault, one_step);
  for (const Path& path : paths) {
    const auto node = [&](int id) -> const Node& { return path.nodes[size_t(id)]; };
    const Node& bound = node(path.results[0]);
    if (bound.op != '-') return "the bound is no difference";
    const Node& square = node(bound.b);
    if (square.op != '*' || square.a != square.b) return "the bound lacks the square of g's error";
    if (const std::string e = exceeds("g's error", relative_error(path, square.a), 1e-6); !e.empty())
      return e;
    if (node(bound.a).op != '-') continue;  // t is at the cell's end: no step is left
    const Node& fall = node(node(bound.a).b);
    if (fall.op != '*') return "the fall is no product";
    const Node& twice = node(fall.a);
    if (twice.op != '-' || twice.b != fall.b) return "the fall is another product";
    Path there = path;
    there.forms = {{fall.a, sized("V", u)}, {fall.b, sized("Z")}};
    const Polynomial given("V*Z", bound_fall_error);
    if (const std::string e = exceeds("the fall", form_of(there, node(bound.a).b).error, given); !e.empty())
      return e;
  }
  static const std::vector<Inputs> taken = inputs_of_one_step();
  Meaning m;
  m.adjust = [at = size_t(0)](Inputs& in) mutable {
    in = taken[at++ % taken.size()];
    return true;
  };
  m.values = [](const Inputs& in) {
    long double bound = 0;
    bound_by_definition(in, bound);
    return Values{bound};
  };
  m.tolerance = 1e-9L;
  m.samples = int(taken.size());
  return meaning_differs(paths, m);
}

// True if the planted fault is one of the bound's last operations, after f, g and bend.
bool is_in_bound(const Path& path) {
  const auto node = [&](int id) -> const Node& { return path.nodes[size_t(id)]; };
  const Node& bound = node(path.results[0]);
  if (path.faulty < 0 || bound.a < 0 || node(bound.a).op != '-') return path.faulty == path.results[0];
  const int fall = node(bound.a).b, twice = node(fall).a;
  for (const int id : {path.results[0], bound.a, bound.b, node(bound.b).a, fall, twice})
    if (id == path.faulty) return true;
  return false;
}

// A lemma by hand, tried at random: the sizes of g's terms sum to at most (|x| + |y| + |d| + r) bend at each iterate, if
// the light is no farther from the box than r. slack_test.cpp uses it.
TEST(CertifyExact, SizesOfSlopes) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  size_t iterates = 0;
  for (int sample = 0; sample < 200000; ++sample) {
    const double wide = std::exp2(8 * any(random)), near = std::fabs(any(random)),
                 far = near + std::fabs(any(random));
    const double low[] = {wide * any(random), wide * any(random)},
                 centre[] = {2 * any(random), 2 * any(random)};
    const double high[] = {low[0] + std::fabs(any(random)), low[1] + std::fabs(any(random))};
    const double d = 2 * any(random), r = 2 * std::fabs(any(random));
    if (near - d > r || d - far > r) continue;
    double t = std::clamp(d, near, far);
    for (int step = 0; step < 5; ++step, ++iterates) {
      double g = t - d, sizes = std::fabs(t - d), bend = 1;
      for (const int axis : {0, 1}) {
        const double left = low[axis] * t - centre[axis], right = centre[axis] - high[axis] * t;
        const double slope = left > 0 ? low[axis] : right > 0 ? -high[axis] : 0;
        g += slope * std::max({left, right, 0.0});
        sizes += std::fabs(slope) * std::max({left, right, 0.0});
        bend += slope * slope;
      }
      ASSERT_LE(sizes, (std::fabs(centre[0]) + std::fabs(centre[1]) + std::fabs(d) + r) * bend * (1 + 1e-9));
      t = std::clamp(t - g / bend, near, far);
    }
  }
  EXPECT_GT(iterates, 100000u);
}

TEST(CertifyExact, Bound) { EXPECT_EQ(prove_bound({}), ""); }
// Faults of the bound's last operations: the falls, g's error and the differences.
TEST(CertifyExact, BoundFaults) {
  const Faults f = planted_faults([](const Fault& fault) {
    const std::string reason = prove_bound(fault);
    bool planted = false;
    for (const Path& path : paths_of(bound_kernel, fault, one_step)) planted |= is_in_bound(path);
    recorder.planted = planted;
    return reason;
  });
  EXPECT_GT(f.planted, 10);
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
