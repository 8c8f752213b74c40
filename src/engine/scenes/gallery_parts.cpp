#include "scenes/gallery_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/shapes.h"

namespace lightgrid::gallery {
namespace {

using glm::dvec3, glm::dvec2;
using std::numbers::pi;

// A surface P(s, t), s and t in 0 to 1, with normals from differences. uv_m: its size in texture coordinates.
template <typename Position>
void add_surface(Mesh& mesh, int columns, int rows, glm::vec2 uv_m, const Position& position) {
  constexpr double step = 1e-4;
  std::vector<shapes::SurfacePoint> points;
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      const double s = double(column) / columns, t = double(row) / rows;
      // A pole has no derivative: it takes those of a point beside it.
      const double beside = std::clamp(t, 2e-3, 1 - 2e-3);
      const dvec3 along_s = position(s + step, beside) - position(s - step, beside);
      const dvec3 along_t = position(s, beside + step) - position(s, beside - step);
      points.push_back({position(s, t),
                        glm::normalize(glm::cross(along_s, along_t)),
                        glm::normalize(along_s),
                        {float(s) * uv_m.x, -float(t) * uv_m.y}});
    }
  }
  shapes::add_grid(mesh, columns, rows, points);
}

double bump(double x, double width) { return std::exp(-x * x / (width * width)); }

double step_up(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// A face adds this to an ellipsoid, as a share of its radius. turn: from the front, -pi to pi; rise:
// elevation.
double relief(double turn, double rise) {
  const double side = std::abs(turn);
  double d = 0;
  const double nose = step_up(0.34, -0.16, rise) * step_up(-0.34, -0.17, rise);
  d += 0.21 * nose * bump(turn, 0.10 + 0.09 * step_up(0.1, -0.15, rise));
  d += 0.045 * bump(turn, 0.12) * bump(rise - 0.22, 0.14);           // its bridge
  d += 0.060 * bump(rise - 0.23, 0.085) * bump(side - 0.33, 0.34);   // brows
  d -= 0.105 * bump(side - 0.36, 0.20) * bump(rise - 0.06, 0.115);   // sockets
  d += 0.065 * bump(side - 0.36, 0.115) * bump(rise - 0.06, 0.062);  // eyes
  d -= 0.012 * bump(side - 0.36, 0.13) * bump(rise - 0.055, 0.030);  // between the lids
  d += 0.040 * bump(side - 0.66, 0.24) * bump(rise + 0.16, 0.16);    // cheeks
  d -= 0.030 * bump(side - 0.42, 0.13) * bump(rise + 0.40, 0.12);    // beside the mouth
  d += 0.045 * bump(turn, 0.24) * bump(rise + 0.45, 0.065);          // lips
  d += 0.045 * bump(turn, 0.20) * bump(rise + 0.575, 0.070);
  d -= 0.018 * bump(turn, 0.26) * bump(rise + 0.512, 0.040);
  d += 0.105 * bump(turn, 0.30) * bump(rise + 0.86, 0.17);         // chin
  d += 0.13 * bump(side - 1.62, 0.085) * bump(rise + 0.02, 0.17);  // ears
  // Hair: from the forehead up, and behind the ears.
  const double hair = std::max(step_up(0.55, 0.72, rise + 0.05 * std::cos(3 * turn)),
                               step_up(1.72, 1.95, side) * step_up(-1.05, -0.45, rise));
  d += hair * (0.055 + std::cos(rise) *
                           (0.020 * std::sin(13 * turn + 9 * rise) + 0.010 * std::sin(9 * turn - 17 * rise)));
  return d;
}

dvec3 head_at(double s, double t) {
  const double turn = 2 * pi * s - pi, rise = pi * (t - 0.5);
  const double radius = 1 + relief(turn - 2 * pi * std::round(turn / (2 * pi)), rise);
  // s runs counter-clockwise seen from above, from the back over the left side.
  const dvec3 ball(std::cos(rise) * std::sin(turn), std::sin(rise), std::cos(rise) * std::cos(turn));
  const double jaw = 1 - 0.24 * step_up(-0.15, -1.1, rise),
               skull = 1 + 0.12 * step_up(0.2, -1.0, std::cos(turn));
  return dvec3(0, 0.487, 0.016) + dvec3(0.090 * jaw, 0.138, 0.106 * skull) * ball * radius;
}

// Half widths along x and z, and the shift of the middle along z, by height.
struct Section {
  double y, x, z, shift;
};
constexpr Section sections[] = {{0.00, 0.098, 0.082, 0.020},   {0.05, 0.146, 0.104, 0.022},
                                {0.13, 0.198, 0.122, 0.016},   {0.185, 0.208, 0.112, 0.006},
                                {0.225, 0.172, 0.092, -0.004}, {0.26, 0.110, 0.076, -0.008},
                                {0.295, 0.074, 0.070, -0.008}, {0.34, 0.064, 0.066, -0.002},
                                {0.38, 0.063, 0.067, 0.004},   {0.42, 0.058, 0.064, 0.006}};
constexpr int section_count = std::size(sections);

double between(double a, double b, double c, double d, double t) {  // Catmull-Rom
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

dvec3 chest_at(double s, double t) {
  const double place = std::clamp(t, 0.0, 1.0) * (section_count - 1);
  const int i = std::min(int(place), section_count - 2);
  const auto& a = sections[std::max(i - 1, 0)];
  const auto &b = sections[i], &c = sections[i + 1], &d = sections[std::min(i + 2, section_count - 1)];
  const double f = place - i, turn = 2 * pi * s;
  const auto mix = [&](double Section::*member) {
    return between(a.*member, b.*member, c.*member, d.*member, f);
  };
  const double y = mix(&Section::y), front = std::max(std::cos(turn), 0.0);
  // Two cords of the throat, and the collar bones.
  const double cords = 0.05 * bump(std::abs(std::remainder(turn, 2 * pi)) - 0.42, 0.2) * bump(y - 0.31, 0.05);
  const double bones = 0.05 * front * bump(y - 0.215 - 0.05 * std::abs(std::sin(turn)), 0.014);
  const double out = 1 + cords + bones;
  return {mix(&Section::x) * std::sin(turn) * out, y,
          mix(&Section::shift) + mix(&Section::z) * std::cos(turn) * out};
}

}  // namespace

Mesh bust(int material) {
  Mesh mesh;
  add_surface(mesh, 76, 60, {0.5f, 0.35f}, head_at);
  add_surface(mesh, 40, 30, {0.9f, 0.5f}, chest_at);
  return shapes::finished(std::move(mesh), "bust", material);
}

Mesh socle(int material) {
  Mesh mesh;
  const std::vector<glm::vec2> profile = {{0.12f, 0},       {0.12f, 0.025f},  {0.12f, 0.025f},
                                          {0.095f, 0.03f},  {0.066f, 0.05f},  {0.060f, 0.075f},
                                          {0.072f, 0.1f},   {0.098f, 0.112f}, {0.098f, 0.112f},
                                          {0.098f, 0.124f}, {0.098f, 0.124f}, {0.02f, 0.124f}};
  shapes::add_lathe(mesh, glm::vec3(0), profile, 28);
  return shapes::finished(std::move(mesh), "socle", material);
}

Mesh plinth(int material, float height_m) {
  Mesh mesh;
  shapes::add_box(mesh, {-0.28f, 0, -0.28f}, {0.28f, 0.09f, 0.28f});
  shapes::add_box(mesh, {-0.21f, 0.09f, -0.21f}, {0.21f, height_m - 0.06f, 0.21f});
  shapes::add_box(mesh, {-0.25f, height_m - 0.06f, -0.25f}, {0.25f, height_m, 0.25f});
  return shapes::finished(std::move(mesh), "plinth", material);
}

Mesh drapery(int material, float width_m, float height_m, float fold_m, double phase) {
  Mesh mesh;
  const double folds = width_m / fold_m;
  add_surface(mesh, int(folds * 14), 16, {width_m, height_m}, [&](double s, double t) {
    const double grown = 0.25 + 0.75 * (1 - t) * (1 - 0.35 * t), turn = 2 * pi * folds * s + phase;
    const double sway = 0.35 * std::sin(2.3 * t + phase) + 0.5 * std::sin(0.7 * turn + 1.3 * t);
    const double fold = std::sin(turn + sway) + 0.2 * std::sin(2 * turn + 1.9 * t + 2 * phase);
    return dvec3(s * width_m, t * height_m, 0.22 * fold_m * grown * fold);
  });
  return shapes::finished(std::move(mesh), "drapery", material);
}

Mesh ball(int material, float radius_m, int cells_per_edge) {
  Mesh mesh;
  shapes::add_sphere(mesh, glm::vec3(0), radius_m, cells_per_edge);
  return shapes::finished(std::move(mesh), "ball", material);
}

Mesh box(int material, const char* name, glm::vec3 low, glm::vec3 high) {
  Mesh mesh;
  shapes::add_box(mesh, low, high);
  return shapes::finished(std::move(mesh), name, material);
}

}  // namespace lightgrid::gallery
