// cull-test=sphere: the sphere around a cell's box.
#define CULL_TEST 0
#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>

#include "certify/kernel_text.h"
#include "certify/theorem.h"

namespace lightgrid::certify {
namespace {

// The squared distance from the box's middle, and the squared reach that it is compared with.
std::vector<Real> sphere_kernel() {
  const ViewSphere s{input("x"), input("y"), input("d"), input("r")};
  Cell c;
  c.near = input("near"), c.far = input("far");
  c.box_x0 = input("x0"), c.box_x1 = input("x1"), c.box_y0 = input("y0"), c.box_y1 = input("y1");
  sphere_may_touch(s, &c);
  const Choice* found = nullptr;
  int spans = 0;
  for (const Choice& k : recorder.path().choices) {
    if (k.op == 'l' && recorder.node(k.b).op == '*') found = &k;
    const Node &a = recorder.node(k.a), &b = recorder.node(k.b);
    const bool of_radius =
        a.a >= 0 && a.b >= 0 && recorder.node(a.a).name == "d" && recorder.node(a.b).name == "r";
    spans += of_radius && ((k.op == 'g' && a.op == '+' && b.name == "near") ||
                           (k.op == 'l' && a.op == '-' && b.name == "far"));
  }
  if (!found || spans != 2) throw std::runtime_error("a comparison is missing");
  const std::vector<Real> results{of(found->a), of(found->b)};
  const Naming naming;
  // The box's middle m rounds by u |m|, and the difference V from it once more.
  const Real differences[] = {s.x - 0.5f * (c.box_x0 + c.box_x1), s.y - 0.5f * (c.box_y0 + c.box_y1),
                              s.d - 0.5f * (c.near + c.far)};
  for (int i = 0; i < 3; ++i) {
    const std::string v = "V" + std::to_string(i), m = "m" + std::to_string(i);
    give(differences[i], {Polynomial(v), Polynomial(v, u) + Polynomial(m, u * (1 + u))});
  }
  give_sign(s.r, 1);
  return results;
}

// The squared distance is within 5u V^2 + 2u V m for each coordinate, which is less than u |m| of the distance and 2.5u of
// itself; the reach is the rounded sum of the radius and half the diagonal, which is within 4.5u of itself.
std::string prove_sphere(const Fault& fault) {
  const std::vector<Path> paths = paths_of(sphere_kernel, fault);
  Polynomial bound;
  for (const std::string i : {"0", "1", "2"}) {
    bound.add("V" + i + "*V" + i, sphere_error);
    bound.add("V" + i + "*m" + i, sphere_middle_error);
    bound.add("m" + i + "*m" + i, 1.0001 * u * u);
  }
  for (const Path& path : paths) {
    if (const std::string e = exceeds("a distance", form_of(path, path.results[0]).error, bound); !e.empty())
      return e;
    const Node& reach2 = path.nodes[size_t(path.results[1])];
    const Node& reach = path.nodes[size_t(reach2.a)];
    if (reach2.b != reach2.a || reach.op != '+' || path.nodes[size_t(reach.a)].name != "r")
      return "the reach is no sum";
    if (const std::string e = exceeds("half a diagonal", relative_error(path, reach.b), half_error);
        !e.empty())
      return e;
  }
  Meaning m{{"x", "y", "d", "r", "x0", "x1", "y0", "y1", "near", "far"}, {}};
  m.values = [](const Inputs& in) {
    long double distance2 = 0, size2 = 0;
    for (const auto& [x, low, high] :
         {std::tuple{"x", "x0", "x1"}, {"y", "y0", "y1"}, {"d", "near", "far"}}) {
      distance2 += std::pow(in.at(x) - (in.at(low) + in.at(high)) / 2, 2);
      size2 += std::pow(in.at(high) - in.at(low), 2);
    }
    return Values{distance2, std::pow(in.at("r") + std::sqrt(size2) / 2 * (1.0f + SLACK), 2)};
  };
  return meaning_differs(paths, m);
}

TEST(CertifySphere, DistanceAndReach) { EXPECT_EQ(prove_sphere({}), ""); }
TEST(CertifySphere, Faults) {
  const Faults f = planted_faults(prove_sphere);
  EXPECT_GT(f.planted, 50);
  EXPECT_THAT(f.survived, testing::IsEmpty());
}

}  // namespace
}  // namespace lightgrid::certify
