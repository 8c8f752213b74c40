// From depth to distances: the interval of a cell holds the distance of each of its surfaces.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "certify/kernel_text.h"
#include "certify/theorem.h"

namespace lightgrid::certify {
namespace {

// Depths 1 (the farthest) and 2 (the nearest), and a step of the format, at least twice its rounding.
std::vector<Real> interval_kernel(bool orthographic) {
  CullParams p;
  p.orthographic = orthographic;
  p.depth_a = input("a"), p.depth_a_rest = input("rest"), p.depth_b = input("b"),
  p.depth_step = input("step");
  const Interval i = interval_of_keys(1, 2, &p);
  const Naming naming;
  for (const Real b : {p.depth_a, p.depth_b})
    give(b, sized(recorder.node(b.id).name, u));  // doubles, rounded
  const Real clamped[] = {input("depth2") + p.depth_step, input("depth1") - p.depth_step, 0, 1};
  for (const Real z : clamped) {
    // One rounding of b - z, on top of b's own: it may cancel.
    give(p.depth_b - z, {Polynomial("D"), Polynomial("D", u) + Polynomial("b", u * (1 + u))});
    // z + a is exact (Sterbenz) or no smaller than half of a, whose rest then is at most 2u of it. Two roundings.
    give((z + p.depth_a) + p.depth_a_rest, sized("D", 2 * u * (1 + 4 * u)));
  }
  return {i.near, i.far};
}

// Depths inside and outside [0, 1], and distances that are negative or past FAR_AWAY.
Meaning meaning_of_interval(bool orthographic) {
  Meaning m{{"a", "rest", "b", "step", "depth1", "depth2", "kind"}, {}};
  m.low = -0.1, m.high = 1.1;
  m.adjust = [](Inputs& in) {
    if (in["kind"] < 0.2) in["b"] *= 1e18L;
    in["step"] *= 0.1L;
    return in["step"] > 0;
  };
  m.values = [orthographic](const Inputs& in) {
    const auto distance = [&](long double depth) {
      const long double z = std::clamp(depth, 0.0L, 1.0L);
      if (orthographic) return (in.at("b") - z) * in.at("a");
      const long double d = in.at("b") / (z + in.at("a") + in.at("rest")), far = double(FAR_AWAY);
      return d >= 0 && d <= far ? d : far;
    };
    const long double near = distance(in.at("depth2") + in.at("step")),
                      far = distance(in.at("depth1") - in.at("step"));
    const long double margin =
        orthographic ? WIDEN * (std::fabs(near) + std::fabs(far) + std::fabs(in.at("b") * in.at("a"))) : 0;
    const auto widened = [&](long double d,
                             float factor) {  // FAR_AWAY is a constant: its product is one too, in float
      return d == double(FAR_AWAY) ? (long double)(FAR_AWAY * factor) : d * factor;
    };
    return Values{widened(near, 1.0f - WIDEN) - margin, widened(far, 1.0f + WIDEN) + margin};
  };
  return m;
}

// The errors of an end are less than its widening.
std::string prove_perspective(const Fault& fault, const Device& device, double widen) {
  const std::vector<Path> paths = paths_of([] { return interval_kernel(false); }, fault);
  for (const Path& path : paths) {
    std::map<int, double> given;
    for (const auto& [node, form] : path.forms)
      for (const char* size : {"D", "b"})
        if (form.size[size] == 1 && form.error.terms().size() == 1) given[node] = form.error[size];
    for (const int end : path.results) {
      if (path.nodes[size_t(end)].op == 'c') continue;  // no end
      const double error = relative_error(path, end, given, device);
      if (const std::string e = exceeds("a distance", error * (1 + 1e-5), widen); !e.empty()) return e;
    }
  }
  return fault.instead != 0 ? "" : meaning_differs(paths, meaning_of_interval(false));
}

std::string prove_perspective(const Fault& fault) {
  return prove_perspective(fault, {}, constant_of(double(1.0f + WIDEN), fault) - 1);
}

std::string prove_orthographic(const Fault& fault) {
  const std::vector<Path> paths = paths_of([] { return interval_kernel(true); }, fault);
  const Polynomial ends = Polynomial("D*a", 2) + Polynomial("a*b");
  for (const Path& path : paths)
    for (const int end : path.results) {
      const std::string e = exceeds("a distance", form_of(path, end).error, ends * Polynomial(double(WIDEN)));
      if (!e.empty()) return e;
    }
  return meaning_differs(paths, meaning_of_interval(true));
}

TEST(CertifyDepth, Perspective) { EXPECT_EQ(prove_perspective({}), ""); }
// With a division of 2.5 units in the last place: 1u more than WIDEN, which SLACK has to spare.
TEST(CertifyDepth, PerspectiveOnDevicesThatRoundLess) {
  EXPECT_EQ(prove_perspective({}, {5 * u, 6 * u}, 9.001 * u), "");
}
TEST(CertifyDepth, Orthographic) { EXPECT_EQ(prove_orthographic({}), ""); }
// 5u of the 8u of WIDEN are needed.
TEST(CertifyDepth, LeastWidening) {
  const float least = least_constant([](const Fault& f) { return prove_perspective(f); }, 1.0f + WIDEN);
  EXPECT_THAT((double(least) - 1) / u, testing::AllOf(testing::Gt(4.9), testing::Le(6)));
}
TEST(CertifyDepth, Faults) {
  for (const Proof& proof :
       {Proof([](const Fault& f) { return prove_perspective(f); }), Proof(prove_orthographic)}) {
    const Faults f = planted_faults(proof);
    EXPECT_GT(f.planted, 10);
    EXPECT_THAT(f.survived, testing::IsEmpty());
  }
}

}  // namespace
}  // namespace lightgrid::certify
