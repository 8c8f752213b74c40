// Lights in view space: position, radius, tangents and tiles.
#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "certify/gappa.h"
#include "certify/kernel_text.h"
#include "certify/theorem.h"

namespace lightgrid::certify {
namespace {

constexpr const char* axes[] = {"x", "y", "d"};

// ---- view_sphere ----

// The light's position minus the eye's, which is two floats e + q with |q| <= u |e|. Either w - e is exact
// (Sterbenz), or |q| <= 2u |w - e|. In both cases the two subtractions round by at most 2u (1 + 4u) of the result, D.
std::vector<Real> view_sphere_kernel() {
  CullParams p;
  Real* axis[] = {&p.x_axis_x, &p.x_axis_y, &p.x_axis_z, &p.y_axis_x, &p.y_axis_y,
                  &p.y_axis_z, &p.d_axis_x, &p.d_axis_y, &p.d_axis_z};
  Real *eye[] = {&p.eye_x, &p.eye_y, &p.eye_z}, *rest[] = {&p.eye_rest_x, &p.eye_rest_y, &p.eye_rest_z};
  Real world[3];
  for (int i = 0; i < 3; ++i) {
    const std::string n = std::to_string(i);
    world[i] = input("w" + n), *eye[i] = input("e" + n), *rest[i] = input("q" + n);
    for (int row = 0; row < 3; ++row) {
      *axis[row * 3 + i] = input(axes[row] + n);
      give(*axis[row * 3 + i], sized(axes[row] + n, u));  // a double, rounded
    }
  }
  p.side_slack = input("side"), p.side_slack_m = input("side_m");
  const ViewSphere s = view_sphere(world[0], world[1], world[2], input("R"), &p);
  const Naming naming;
  for (int i = 0; i < 3; ++i)
    give((world[i] - *eye[i]) - *rest[i], sized("D" + std::to_string(i), 2 * u * (1 + 4 * u)));
  for (const std::string name : {"R", "side", "side_m"}) give(input(name), sized(name));
  return {s.x, s.y, s.d, s.r};
}

Meaning meaning_of_view_sphere() {
  Meaning m;
  m.inputs = {"R", "side", "side_m"};
  for (int i = 0; i < 3; ++i)
    for (const std::string name : {"w", "e", "q", "x", "y", "d"})
      m.inputs.push_back(name + std::to_string(i));
  m.values = [](const Inputs& in) {
    Values v;
    for (const std::string axis : axes) {
      long double sum = 0;
      for (const std::string i : {"0", "1", "2"})
        sum += in.at(axis + i) * (in.at("w" + i) - in.at("e" + i) - in.at("q" + i));
      v.push_back(sum);
    }
    const long double slack = SLACK, r = in.at("R"), d = std::fabs(v[2]);
    v.push_back(r + slack * (std::fabs(v[0]) + std::fabs(v[1])) + (slack + in.at("side")) * (d + r) +
                in.at("side_m") + double(LEAST_RADIUS));
    return v;
  };
  return m;
}

// Each coordinate is within 6.00001u of |row of the matrix| |D|.
std::string prove_view_sphere(const Fault& fault) {
  const std::vector<Path> paths = paths_of(view_sphere_kernel, fault);
  for (int row = 0; row < 3; ++row) {
    Polynomial bound;
    for (int i = 0; i < 3; ++i)
      bound.add(axes[row] + std::to_string(i) + "*D" + std::to_string(i), coordinate_error);
    // Products have their factors sorted: D0*x0.
    Polynomial sorted = Polynomial(1.0) * bound;
    const Form f = form_of(paths[0], paths[0].results[size_t(row)]);
    if (const std::string e = exceeds(axes[row], f.error, sorted); !e.empty()) return e;
  }
  Inputs zero;
  for (const std::string& name : meaning_of_view_sphere().inputs) zero[name] = 0;
  const long double least = exact_values(paths[0], zero)[size_t(paths[0].results[3])];
  if (const std::string e = exceeds("LEAST_RADIUS", double(LEAST_RADIUS), double(least)); !e.empty())
    return e;
  return meaning_differs(paths, meaning_of_view_sphere());
}

TEST(CertifyLights, ViewSphere) { EXPECT_EQ(prove_view_sphere({}), ""); }
TEST(CertifyLights, ViewSphereFaults) {
  const Faults f = planted_faults(prove_view_sphere);
  EXPECT_GT(f.planted, 50);
  EXPECT_THAT(f.survived, testing::IsEmpty());
}

// ---- tangent_slopes ----

double slack_of(const Fault& fault) { return constant_of(double(TANGENT_SLACK), fault); }

std::vector<Real> tangents_kernel() {
  const Real v = input("v"), d = input("d"), r = input("r");
  Real low, high;
  tangent_slopes(v, d, r, &low, &high);
  const Naming naming;
  for (const Real x : {v, d, r}) give(x, sized(recorder.node(x.id).name));
  give(d - r, sized("m", u));
  give(d + r, sized("p", u));
  give_sign(r, 1);
  give_sign(d + r, 1);  // tile_rect drops lights behind the eye
  const bool open = d <= r;
  give_sign(d - r, open ? -1 : 1);
  if (!open) give_sign(d, 1);
  return {low, high};
}

// Whether the circle reaches past the eye and the root may cancel.
bool cancels(const Path& path) {
  bool open = false, beside = true;
  for (const Choice& c : path.choices) {
    const Node &a = path.nodes[size_t(c.a)], &b = path.nodes[size_t(c.b)];
    if (c.op == 'l' && a.name == "d" && b.name == "r") open = c.taken;
    if (c.op == '>' && a.op == '*' && path.nodes[size_t(a.a)].a == 0)
      beside = !c.taken;  // n, of v - r with input v first
  }
  return open && beside;
}

// The square under the path's root.
int under_root(const Path& path) {
  for (const Node& n : path.nodes)
    if (n.op == 's') return n.a;
  throw std::runtime_error("a path without a root");
}

// The slopes of the two tangents from the eye by their angles; past a right angle from the axis there is none.
Values tangents_by_angles(const Inputs& in) {
  const long double v = in.at("v"), d = in.at("d"), r = in.at("r"), away = std::hypot(v, d),
                    right = std::acos(-1.0L) / 2;
  if (away <= r) return {-double(FAR_AWAY), double(FAR_AWAY)};
  const long double middle = std::atan2(v, d), half = std::asin(r / away);
  return {middle - half <= -right ? -double(FAR_AWAY) : std::tan(middle - half),
          middle + half >= right ? double(FAR_AWAY) : std::tan(middle + half)};
}

// Where the root cancels it is reduced by TANGENT_SLACK, which moves the tangents outwards by up to a tenth here.
std::string tangents_mean_angles(const std::vector<Path>& paths) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> any(-2, 2);
  for (int sample = 0; sample < 2000; ++sample) {
    const Inputs in{{"v", any(random)}, {"d", any(random)}, {"r", std::abs(any(random))}};
    if (in.at("d") <= -in.at("r")) continue;
    const Values right = tangents_by_angles(in);
    for (const Path& path : paths) {
      const Values values = exact_values(path, in);
      if (!is_taken(path, values)) continue;
      for (const int side : {-1, 1}) {
        const long double found = values[size_t(path.results[side > 0])], bound = right[side > 0];
        const long double outside = (found - bound) * side, tolerance = 1e-12L * std::fabs(bound);
        const bool cancels = in.at("d") <= in.at("r") && std::fabs(in.at("v")) <= in.at("r");
        const bool beyond = std::fabs(found) >= double(FAR_AWAY);
        if (!(outside >= -tolerance) ||
            (outside > tolerance && !(cancels && (beyond || outside < 0.1L + std::fabs(bound) * 0.1L))))
          return "a tangent is " + std::to_string(double(found)) + ", not " + std::to_string(double(bound));
      }
    }
  }
  return "";
}

// v^2 + (d - r)(d + r), reduced by TANGENT_SLACK of v^2 + d^2 + r^2, is no larger than exact: its error is less than
// the reduction. |(d - r)(d + r)| <= d^2 + r^2.
std::string root_is_too_large(const Path& path, const Fault& fault) {
  const int root2 = under_root(path);
  const Polynomial squares = Polynomial("v*v") + Polynomial("d*d") + Polynomial("r*r");
  const Form f = form_of(path, root2);
  const Polynomial error = f.error.with("m*p", Polynomial("d*d") + Polynomial("r*r"));
  if (const std::string e = exceeds("a root", error, squares * Polynomial(slack_of(fault))); !e.empty())
    return e;
  for (const long double v : {0.25L, -0.75L})
    for (const long double d : {0.5L, -0.125L, 1.5L}) {
      const long double r = 2, right = v * v + (d - r) * (d + r) - slack_of(fault) * (v * v + d * d + r * r);
      const Values values = exact_values(path, {{"v", v}, {"d", d}, {"r", r}});
      if (std::fabs(values[size_t(root2)] - right) > 1e-15L) return "the root's square is another number";
    }
  return "";
}

// Each slope is within `bound` of itself. Where the root may cancel, its reduced square is no larger than the exact
// one, and the slopes of a smaller root lie outwards.
std::string prove_tangents(const Fault& fault, const Device& device, double bound) {
  const std::vector<Path> paths = paths_of(tangents_kernel, fault);
  for (const Path& path : paths) {
    for (const int side : {0, 1}) {
      const int slope = path.results[size_t(side)];
      if (path.nodes[size_t(slope)].op == 'c') continue;  // no bound on this side
      std::map<int, double> given;
      if (cancels(path)) {
        if (const std::string e = root_is_too_large(path, fault); !e.empty()) return e;
        given[under_root(path)] = 0;
      }
      const double error = relative_error(path, slope, given, device);
      if (const std::string e = exceeds("a slope", error, bound); !e.empty()) return e;
    }
  }
  return tangents_mean_angles(paths);
}

std::string prove_tangents(const Fault& fault) { return prove_tangents(fault, {}, 9.00001 * u); }

TEST(CertifyLights, Tangents) { EXPECT_EQ(prove_tangents({}), ""); }
// As OpenCL allows without correctly rounded division and root: 2.5 and 3 units in the last place, 5u and 6u.
TEST(CertifyLights, TangentsOnDevicesThatRoundLess) {
  EXPECT_EQ(prove_tangents({}, {5 * u, 6 * u}, 18.00002 * u), "");
}
TEST(CertifyLights, TangentsNeedAQuarterOfTheirSlack) {
  const float least = least_constant([](const Fault& f) { return prove_tangents(f); }, TANGENT_SLACK);
  EXPECT_THAT(double(least) / u, testing::AllOf(testing::Gt(5), testing::Lt(8)));
}
TEST(CertifyLights, TangentsByGappa) {
  if (!has_gappa()) GTEST_SKIP() << "there is no gappa (Debian: gappa)";
  const Proved proved = prove_by_gappa(paths_of(tangents_kernel), cancels);
  EXPECT_GE(proved.scripts, 10u);
  EXPECT_LT(proved.largest / u, 9.0001);
}
TEST(CertifyLights, TangentsFaults) {
  const Faults found = planted_faults([](const Fault& f) { return prove_tangents(f); });
  EXPECT_GT(found.planted, 50);
  EXPECT_THAT(found.survived, testing::IsEmpty());
}

// ---- tile_range ----

// One slope for both ends: the first tile from it, and the last. The results are the floors' arguments.
std::vector<Real> tile_range_kernel() {
  const Real slope = input("slope"), scale = input("scale"), offset = input("offset"), inset = input("inset");
  int first, last;
  tile_range(slope, slope, scale, offset, inset, 1280, Real(16.0f), &first, &last);
  std::vector<Real> floors;
  for (const Node& n : recorder.path().nodes)
    if (n.op == 'f') floors.push_back(of(n.a));
  const Naming naming;
  give(slope, sized("slope", 9.00001 * u));
  give(scale, sized("scale", u));
  give(offset, sized("offset", u));
  give(inset / Real(16.0f), sized("margin", u));
  return floors;
}

// The tile coordinate of a tangent, moved outwards by TANGENT_SLACK and inwards by the margin of pixel centres. Its
// errors, and those of a pixel's own tile coordinate, are below TANGENT_SLACK: the floor is the pixel's tile or one outside.
// A margin is at most half a pixel of a tile of 8.
std::string prove_tile_range(const Fault& fault) {
  const std::vector<Path> paths = paths_of(tile_range_kernel, fault);
  const Polynomial whole = Polynomial("scale*slope") + Polynomial("offset") + Polynomial(1.0);
  int first = 0, last = 0, compared = 0;
  for (const Path& path : paths) {
    const auto is = [&](int node, int sign, auto&& value) {
      for (const long double slope : {0.3L * sign, -0.6L * sign}) {
        const Values values =
            exact_values(path, {{"slope", slope}, {"scale", 7}, {"offset", 1.5L * sign}, {"inset", 0.5L}});
        const long double at = slope * 7 + 1.5L * sign,
                          slack = slack_of(fault) * (std::fabs(slope * 7) + 2.5L);
        if (std::fabs(values[size_t(node)] - value(at, slack, 0.5L / 16)) > 1e-15L) return false;
      }
      return true;
    };
    // Inside the image both ends are computed, left and right of it neither.
    for (const auto& [slope, ends] : {std::pair{0.3L, 2u}, {-0.6L, 0u}, {6000.0L, 0u}}) {
      const Inputs in{{"slope", slope}, {"scale", 7}, {"offset", 1.5L}, {"inset", 0.5L}};
      if (is_taken(path, exact_values(path, in)) && path.results.size() != ends)
        return "the image's ends are elsewhere";
    }
    const auto begin = [](auto at, auto slack, auto) { return at - slack; };
    const auto end = [](auto, auto, auto margin) { return 1280 / 16 - margin; };
    for (const Choice& c : path.choices)
      if (c.op == '>' && is(c.a, 1, begin) && is(c.a, -1, begin) && is(c.b, 1, end)) ++compared;
    for (const int floor : path.results) {  // of numbers; at the image's end it is of a constant
      const Form f = form_of(path, floor);
      // The pixel's own coordinate, and the comparison with the last tile's end, round too.
      const Polynomial error = f.error.with("margin", Polynomial(0.0625)) + whole * Polynomial(3 * u);
      const std::string e = exceeds("a tile", error, whole * Polynomial(slack_of(fault)));
      if (!e.empty()) return e;
      const auto low = [](auto at, auto slack, auto margin) { return at - slack + margin; };
      const auto high = [](auto at, auto slack, auto margin) { return at + slack - margin; };
      const bool is_low = is(floor, 1, low) && is(floor, -1, low),
                 is_high = is(floor, 1, high) && is(floor, -1, high);
      if (!is_low && !is_high) return "a floor is of another number";
      ++(is_high ? last : first);
    }
  }
  if (compared != int(paths.size())) return "the first tile is not compared with the last one's end";
  return first == last && first > 0 ? "" : "an end is not computed on some path";
}

TEST(CertifyLights, TileRange) { EXPECT_EQ(prove_tile_range({}), ""); }
TEST(CertifyLights, TileRangeNeedsHalfOfItsSlack) {
  const float least = least_constant(prove_tile_range, TANGENT_SLACK);
  EXPECT_THAT(double(least) / u, testing::AllOf(testing::Gt(16.9), testing::Lt(17.1)));
}
TEST(CertifyLights, TileRangeFaults) {
  const Faults f = planted_faults(prove_tile_range);
  EXPECT_GT(f.planted, 10);
  EXPECT_THAT(f.survived, testing::IsEmpty());
}

}  // namespace
}  // namespace lightgrid::certify
