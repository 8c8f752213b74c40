// The sector meets the cell if the nearest point to the apex, among the cell's points within the cone's
// angle, is within the radius. That point is stationary on its stratum: interior (only the apex itself),
// face, edge or corner of the cell, each inside the cone or on its boundary. Each stratum has at most two
// stationary points, all in closed form, so testing those of every stratum is enough; cones wider than a
// half-space need no special case.
#include "oracle/cell.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace lightgrid::lab {

namespace {

using glm::dvec3;

constexpr double angle_slack = 1e-8;
constexpr double radius_slack = 1e-9;
constexpr double rounding =
    1e-14;  // relative to coordinates: bounds the error of a stationary point, about ten operations

struct Plane {
  dvec3 normal;   // unit, into the cell
  double offset;  // normal . q + offset is the distance inside
};

// foot + s * direction for begin <= s <= end. The foot is the line's nearest point to the apex, so that
// points near the apex are computed from small numbers, however far away the corners are.
struct Edge {
  dvec3 foot, direction;  // unit; zero where the edge is a point
  double begin, end;      // the end may be infinite
};

// The cell as seen from the apex: all points are offsets from it.
struct Polyhedron {
  std::vector<Plane> planes;
  std::vector<Edge> edges;
};

Edge edge_along(const dvec3& start, const dvec3& direction, double length) {
  const double to_foot = -glm::dot(start, direction);
  return {start + to_foot * direction, direction, -to_foot, length - to_foot};
}

Edge edge_between(const dvec3& a, const dvec3& b) {
  const double length = glm::length(b - a);
  return edge_along(a, length > 0 ? (b - a) / length : dvec3(0), length);
}

Polyhedron seen_from(const dvec3& apex, const Cell& cell) {
  Polyhedron shape;
  const double tip = cell.orthographic ? 0 : 1;  // side planes of a pyramid meet at the eye
  auto add_side = [&](const dvec3& axis, double bound, double inward) {
    const dvec3 normal = inward * (axis + dvec3(0, 0, tip * bound));
    const double length = glm::length(normal);
    const double constant = cell.orthographic ? -inward * bound : 0;
    shape.planes.push_back({normal / length, (glm::dot(normal, apex) + constant) / length});
  };
  add_side({1, 0, 0}, cell.x0, 1);
  add_side({1, 0, 0}, cell.x1, -1);
  add_side({0, 1, 0}, cell.y0, 1);
  add_side({0, 1, 0}, cell.y1, -1);
  shape.planes.push_back({{0, 0, -1}, -apex.z - cell.near});
  const bool bounded = std::isfinite(cell.far);
  if (bounded) shape.planes.push_back({{0, 0, 1}, apex.z + cell.far});

  const double xs[] = {cell.x0, cell.x1, cell.x1, cell.x0}, ys[] = {cell.y0, cell.y0, cell.y1, cell.y1};
  auto corner = [&](int i, double depth) {
    return dvec3(xs[i] * cell.scale_at(depth), ys[i] * cell.scale_at(depth), -depth) - apex;
  };
  for (int i = 0; i < 4; ++i) {
    const dvec3 near_corner = corner(i, cell.near);
    shape.edges.push_back(edge_between(near_corner, corner((i + 1) % 4, cell.near)));
    if (bounded) {
      shape.edges.push_back(edge_between(corner(i, cell.far), corner((i + 1) % 4, cell.far)));
      shape.edges.push_back(edge_between(near_corner, corner(i, cell.far)));
    } else {
      const dvec3 outward = glm::normalize(dvec3(xs[i] * tip, ys[i] * tip, -1));
      shape.edges.push_back(edge_along(near_corner, outward, std::numeric_limits<double>::infinity()));
    }
  }
  return shape;
}

struct Cone {
  dvec3 axis;
  double half_angle, cosine, sine;
};

Cone cone_of(const dvec3& axis, double half_angle) {
  return {axis, half_angle, std::cos(half_angle), std::sin(half_angle)};
}

double angle_between(const dvec3& q, const dvec3& axis) {
  return std::atan2(glm::length(glm::cross(q, axis)), glm::dot(q, axis));
}

dvec3 any_perpendicular(const dvec3& v) {
  const dvec3 other = std::abs(v.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  return glm::normalize(glm::cross(v, other));
}

// The face's stationary points: its nearest to the apex, and its nearest on the cone's boundary, which lies
// in the plane of the axis and the normal. A face with the apex on its inner side has none: from each of its
// points the segment to the apex leads into the cell and stays in the cone.
template <typename Visit>
bool any_on_face(const Plane& plane, const Cone& cone, const Visit& visit) {
  if (plane.offset >= 0) return false;
  if (visit(-plane.offset * plane.normal)) return true;
  const dvec3 across = plane.normal - glm::dot(plane.normal, cone.axis) * cone.axis;
  const double length = glm::length(across);
  // A plane perpendicular to the axis cuts a circle, whose points are equally near.
  const dvec3 side = length > 1e-12 ? across / length : any_perpendicular(cone.axis);
  const dvec3 ray = cone.cosine * cone.axis + cone.sine * side;
  const double t = -plane.offset / glm::dot(plane.normal, ray);
  return t > 0 && std::isfinite(t) && visit(t * ray);
}

// The edge's parameters where it crosses the cone's boundary: |q| sin(half_angle - angle(q)) = 0. Starts from
// the squared equation (which also holds on the mirrored cone), then corrects by Newton steps on the equation
// itself: squaring loses half the digits near 90 degrees. Returns their number.
int cone_crossings(const Edge& edge, const Cone& cone, double crossings[2]) {
  const dvec3 foot_across = glm::cross(edge.foot, cone.axis),
              step_across = glm::cross(edge.direction, cone.axis);
  const double foot_along = glm::dot(edge.foot, cone.axis), step_along = glm::dot(edge.direction, cone.axis);
  const double s2 = cone.sine * cone.sine, c2 = cone.cosine * cone.cosine;
  const double a = s2 * step_along * step_along - c2 * glm::dot(step_across, step_across);
  const double b = s2 * foot_along * step_along - c2 * glm::dot(foot_across, step_across);
  const double c = s2 * foot_along * foot_along - c2 * glm::dot(foot_across, foot_across);
  const double discriminant = b * b - a * c;
  if (discriminant < -1e-12 * (b * b + std::abs(a * c))) return 0;
  const double q = -(b + std::copysign(std::sqrt(std::max(discriminant, 0.0)), b));
  int count = 0;
  for (double s : {q / a, c / q}) {
    for (int step = 0; step < 3; ++step) {
      const dvec3 across = foot_across + s * step_across;
      const double length = glm::length(across);
      const double value = cone.sine * (foot_along + s * step_along) - cone.cosine * length;
      const double slope =
          cone.sine * step_along - (length > 0 ? cone.cosine * glm::dot(across, step_across) / length : 0);
      if (slope != 0) s -= value / slope;
    }
    if (std::isfinite(s)) crossings[count++] = s;
  }
  return count;
}

// The edge's nearest point to the apex, its end (every corner is the end of some edge), the cone's crossings.
template <typename Visit>
bool any_on_edge(const Edge& edge, const Cone& cone, const Visit& visit) {
  auto visit_at = [&](double s) {
    return visit(edge.foot + std::clamp(s, edge.begin, edge.end) * edge.direction);
  };
  if (visit_at(0)) return true;
  if (std::isfinite(edge.end) && visit_at(edge.end)) return true;
  double crossings[2];
  const int count = cone_crossings(edge, cone, crossings);
  return std::any_of(crossings, crossings + count, visit_at);
}

// True if a stationary point lies in the cell, to rounding, and its distance from the apex is accepted.
template <typename Accepts>
bool any_stationary_point(const Polyhedron& shape, const Cone& cone, double apex_distance,
                          const Accepts& accepts) {
  auto visit = [&](const dvec3& q) {
    const double distance = glm::length(q), error = rounding * (apex_distance + distance);
    return accepts(q, distance, error) &&
           std::all_of(shape.planes.begin(), shape.planes.end(),
                       [&](const Plane& p) { return glm::dot(p.normal, q) + p.offset >= -error; });
  };
  for (const Plane& plane : shape.planes) {
    if (any_on_face(plane, cone, visit)) return true;
  }
  for (const Edge& edge : shape.edges) {
    if (any_on_edge(edge, cone, visit)) return true;
  }
  return false;
}

}  // namespace

Touch cone_touches_cell(const Cell& cell, const dvec3& apex, const dvec3& axis, double cos_outer,
                        double radius) {
  if (!(radius >= 0)) return Touch::no;
  const Polyhedron shape = seen_from(apex, cell);
  const double apex_distance = glm::length(apex), apex_error = rounding * apex_distance;
  double depth_inside = std::numeric_limits<double>::infinity();
  for (const Plane& plane : shape.planes) depth_inside = std::min(depth_inside, plane.offset);
  if (depth_inside >= apex_error) return Touch::yes;

  const double half_angle = std::acos(std::clamp(cos_outer, -1.0, 1.0));
  const bool ball = half_angle >= std::numbers::pi;
  const Cone narrow = cone_of(axis, std::max(half_angle - angle_slack, 0.0));
  const bool certain =
      any_stationary_point(shape, narrow, apex_distance, [&](const dvec3& q, double d, double error) {
        return d + error <= radius * (1 - radius_slack) &&
               (ball || angle_between(q, axis) + error / d <= half_angle);
      });
  if (certain) return Touch::yes;

  const Cone wide = cone_of(axis, std::min(half_angle + angle_slack, std::numbers::pi));
  const bool possible =
      depth_inside >= -apex_error ||
      any_stationary_point(shape, wide, apex_distance, [&](const dvec3& q, double d, double error) {
        return d - error <= radius * (1 + radius_slack) &&
               angle_between(q, axis) <= wide.half_angle + error / d;
      });
  return possible ? Touch::unsure : Touch::no;
}

}  // namespace lightgrid::lab
