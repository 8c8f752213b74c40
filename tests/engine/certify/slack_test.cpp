// The slack of a radius against the errors that the other theorems bound, added up. Sizes: S is |x| + |y| + |d|, R the
// radius, O the sum of the offsets' slopes times |d| + R, H half the diagonal of a cell's box.
#include <gmock/gmock.h>

#include <cmath>

#include "certify/host.h"
#include "certify/kernel_text.h"
#include "certify/theorem.h"

namespace lightgrid::certify {
namespace {

// For products of errors, for coordinates that are themselves within their errors, and for a matrix that stretches.
constexpr double second_order = 1 + 1e-4;

// The radius that view_sphere makes is at least this: its terms, none of which is negative, less their errors.
// side_slack is the host's.
Polynomial radius(const Fault& fault) {
  const std::vector<Path> paths = paths_of(
      [] {
        CullParams p;
        Real* zero[] = {&p.eye_x,    &p.eye_y,    &p.eye_z,    &p.eye_rest_x, &p.eye_rest_y, &p.eye_rest_z,
                        &p.x_axis_y, &p.x_axis_z, &p.y_axis_x, &p.y_axis_z,   &p.d_axis_x,   &p.d_axis_y};
        for (Real* z : zero) *z = 0.0f;
        p.x_axis_x = p.y_axis_y = p.d_axis_z = 1.0f;
        p.side_slack = input("side"), p.side_slack_m = input("side_m");
        const ViewSphere s = view_sphere(input("x"), input("y"), input("d"), input("R"), &p);
        for (const char* name : {"x", "y", "d", "R", "side", "side_m"}) give(input(name), sized(name));
        return std::vector{s.r};
      },
      fault);
  const Form r = form_of(paths[0], paths[0].results[0]);
  const auto least = [&](const char* term) { return r.size[term] - r.error[term]; };
  Polynomial sum("S", std::min({least("x"), least("y"), least("d")}));
  sum.add("R", least("R"));
  sum.add("O", std::min(least("R*side"), least("d*side")) * host_side_slack());
  return sum;
}

// A point that the light reaches is this far from the computed centre, at most, in each part of the box's distance: the
// light's radius, the centre's error over three coordinates, and the box's error at the point. A point's |x| + |y| is at
// most S + sqrt(2) R, its distance at most |d| + R.
Polynomial from_box() {
  Polynomial sum("R");
  sum.add("S", second_order * (std::sqrt(3.0) * coordinate_error + box_slope_error));
  sum.add("R", second_order * std::sqrt(2.0) * box_slope_error);
  sum.add("O", second_order * box_offset_error);
  return sum;
}

// As shaded, a pixel has a slope of its own, which rounds as a tile's side does. The positions of light and pixel, their
// difference and its square have errors of 5u of S and 7u of R (by hand).
Polynomial as_shaded() {
  Polynomial sum = from_box();
  sum.add("S", second_order * (3.00001 + 5) * u);
  sum.add("R", second_order * (3.00001 * std::sqrt(2.0) + 7) * u);
  sum.add("O", second_order * 5.00001 * u);
  return sum;
}

// box: fl(distance^2) <= fl(r^2).
std::string prove_box(const Polynomial& needed, const Fault& fault) {
  return exceeds("box", needed * Polynomial(1 + second_order * (distance_error + u) / 2), radius(fault));
}

// sphere: (distance from the middle)^2 <= reach^2. |m| is at most S + R + H.
std::string prove_sphere(const Polynomial& needed, const Fault& fault) {
  Polynomial distance = needed + Polynomial("H");
  distance = distance * Polynomial(1 + second_order * sphere_error / 2);
  for (const char* size : {"S", "R", "H"}) distance.add(size, second_order * sphere_middle_error / 2);
  for (const char* size : {"R", "H"}) distance.add(size, second_order * 1.5 * u);  // r + H, and its square
  distance.add("H", second_order * half_error);
  Polynomial reach = radius(fault);
  reach.add("H", 1 + constant_of(double(SLACK), fault));
  return exceeds("sphere", distance, reach);
}

// planes: the sphere's tangents, and d + r against distances: only the centre's error matters.
std::string prove_planes(const Fault& fault) {
  Polynomial needed("R");
  needed.add("S", second_order * std::sqrt(3.0) * coordinate_error);
  return exceeds("planes", needed, radius(fault));
}

// exact: a step's bound is f - (2 W - Z) Z - E^2 with W = |g| + E and E = SLACK A bend, where A = |x| + |y| + |d| + r. h is
// the distance along the axis to the nearest section of the cell, which has f <= needed^2. f is convex, so
// f(t) <= needed^2 + 2 |G| h - h^2, and a step of any h <= Z lowers the bound by no more than Z does. The distance to the
// cell's end rounds by u. W exceeds |G| by E, less g's error and its own rounding. With V <= A bend for the sum of the
// sizes of g's terms (bound_by_definition), the computed bound is below needed^2 if E covers g's error and the rounding of
// both falls.
std::string prove_exact(const Polynomial& needed, const Fault& fault) {
  const double falls = section_f_error + bound_fall_error + u;  // of 2 V h
  const double moved = falls + section_g_error + u;             // of V
  const std::string e = exceeds("exact: g", second_order * moved, constant_of(double(SLACK), fault));
  if (!e.empty()) return e;
  // f and the two subtractions round, and r^2.
  return exceeds("exact", needed * Polynomial(1 + second_order * (section_f_error + 3 * u) / 2),
                 radius(fault));
}

TEST(CertifySlack, Exact) { EXPECT_EQ(prove_exact(from_box(), {}), ""); }
TEST(CertifySlack, ExactAsShaded) { EXPECT_EQ(prove_exact(as_shaded(), {}), ""); }
TEST(CertifySlack, Box) { EXPECT_EQ(prove_box(from_box(), {}), ""); }
TEST(CertifySlack, BoxAsShaded) { EXPECT_EQ(prove_box(as_shaded(), {}), ""); }
TEST(CertifySlack, Sphere) { EXPECT_EQ(prove_sphere(from_box(), {}), ""); }
TEST(CertifySlack, SphereAsShaded) { EXPECT_EQ(prove_sphere(as_shaded(), {}), ""); }
TEST(CertifySlack, Planes) { EXPECT_EQ(prove_planes({}), ""); }

// The least SLACK with which each proof holds; with the next smaller float it does not.
TEST(CertifySlack, LeastSlack) {
  const auto least = [](const Proof& proof) { return double(least_constant(proof, SLACK)) / u; };
  EXPECT_NEAR(least([](const Fault& f) { return prove_planes(f); }), 10.4, 0.1);
  EXPECT_NEAR(least([](const Fault& f) { return prove_box(from_box(), f); }), 14.4, 0.1);
  EXPECT_NEAR(least([](const Fault& f) { return prove_sphere(from_box(), f); }), 15.4, 0.1);
  EXPECT_NEAR(least([](const Fault& f) { return prove_box(as_shaded(), f); }), 22.4, 0.1);
  EXPECT_NEAR(least([](const Fault& f) { return prove_exact(from_box(), f); }), 14.4, 0.1);
  EXPECT_NEAR(least([](const Fault& f) { return prove_exact(as_shaded(), f); }), 22.4, 0.1);
}

// cones: of the middle's distance V from the apex, of the middle m, and of S, each against 2 SLACK. The axis is a unit vector
// in a direction with an error of sqrt(3) axis_error, times 1 + length_error + u. A part of the cross product is at most V
// long. across * cos - along * sin has the errors of both.
TEST(CertifySlack, Cones) {
  const double axis = std::sqrt(3.0) * axis_error + length_error + u;
  const double across = axis + std::sqrt(3.0) * across_error + 3.5001 * u + u, along = axis + along_error + u;
  const double given = 2 * double(SLACK) / second_order;
  EXPECT_NEAR((std::hypot(across, along) + std::sqrt(2.0) * u) / u, 31, 1);
  EXPECT_LT(std::hypot(across, along) + std::sqrt(2.0) * u,
            given - 8 * u);                                              // the sum of the reach rounds, too
  EXPECT_LT((std::sqrt(3.0) + 1) * u + box_slope_error, given - 8 * u);  // m
  EXPECT_LT(std::sqrt(3.0) * coordinate_error + box_slope_error, given - 8 * u);  // S
}

// Uploads grow radii for a matrix that stretches by MAX_STRETCH: none that is accepted stretches more.
TEST(CertifySlack, AcceptedMatrices) {
  EXPECT_LE(accepted_stretch(), double(MAX_STRETCH));
  EXPECT_GT(accepted_stretch(), double(MAX_STRETCH) * 0.9999);
}

// The host's side_slack covers the offset's part of a side twice, as shaded; with a tenth less it does not.
TEST(CertifySlack, SideSlack) {
  for (const bool orthographic : {false, true}) EXPECT_NEAR(host_side_slack(orthographic) / u, 12, 1e-5);
  EXPECT_GT(radius({})["O"], as_shaded()["O"]);
  EXPECT_LT(radius({})["O"], as_shaded()["O"] * 1.25);
}

}  // namespace
}  // namespace lightgrid::certify
