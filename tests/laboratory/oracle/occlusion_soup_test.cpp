// The oracle of shadows against a plain loop over all triangles in long double, in soups of random triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "oracle/shadow_scenes.h"
#include "scene/random.h"

namespace lightgrid::lab {
namespace {

using Real = long double;
using Point = glm::vec<3, Real>;

struct Soup {
  std::vector<std::array<Point, 3>> triangles;
  Point light, place, eye;
  Real gap;
};

// Möller and Trumbore 1997, on both sides, along the segment less its end.
bool crosses(const std::array<Point, 3>& t, const Point& from, const Point& way, Real end) {
  const Point e1 = t[1] - t[0], e2 = t[2] - t[0], p = glm::cross(way, e2);
  const Real det = glm::dot(e1, p);
  if (det == 0) return false;
  const Point s = from - t[0], q = glm::cross(s, e1);
  const Real u = glm::dot(s, p) / det, v = glm::dot(way, q) / det, share = glm::dot(e2, q) / det;
  return u >= 0 && v >= 0 && u + v <= 1 && share > 0 && share < end;
}

// Triangle 0 is the receiver's.
bool hidden_in(const Soup& soup) {
  const auto& own = soup.triangles[0];
  const Point normal = glm::cross(own[1] - own[0], own[2] - own[0]);
  if (glm::dot(normal, soup.light - own[0]) * glm::dot(normal, soup.eye - own[0]) < 0) return true;
  const Point way = soup.place - soup.light;
  const Real end = 1 - soup.gap / glm::length(way);
  for (size_t i = 1; i < soup.triangles.size(); ++i) {
    if (crosses(soup.triangles[i], soup.light, way, end)) return true;
  }
  return false;
}

glm::dvec3 point_in(Random& random, float size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

Point moved(Random& random, const glm::dvec3& p, double by_m) {
  return Point(p) + Point(any_direction(random) * by_m);
}

// Kinds: large ones, slivers, pieces of one plane, and strips with common edges.
std::vector<glm::vec3> random_triangles(Random& random, int count) {
  std::vector<glm::vec3> corners;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 a(point_in(random, 5));
    const glm::vec3 b = a + glm::vec3(point_in(random, 3));
    const int kind = i % 4;
    if (kind == 0) {
      corners.insert(corners.end(), {a, b, a + glm::vec3(point_in(random, 3))});
    } else if (kind == 1) {
      corners.insert(corners.end(),
                     {a, b, a + (b - a) * random.uniform(0, 1) + glm::vec3(point_in(random, 1e-3f))});
    } else if (kind == 2) {
      const auto flat = [&](glm::vec3 p) {
        p.y = 1.25f;
        return p;
      };
      corners.insert(corners.end(), {flat(a), flat(b), flat(a + glm::vec3(point_in(random, 3)))});
    } else {
      const glm::vec3 c = a + glm::vec3(point_in(random, 3)), d = c + b - a;
      corners.insert(corners.end(), {a, b, c, c, b, d});
    }
  }
  return corners;
}

// A receiver on the first triangle and a light.
struct Pair {
  Receiver receiver;
  Light light;
};

Pair random_pair(Random& random, const Scene& scene, int kind) {
  const std::vector<glm::vec3>& p = scene.meshes[0].positions;
  const double u = random.uniform(0, 1), v = random.uniform(0, float(1 - u));
  const glm::dvec3 place = glm::dvec3(p[0]) + u * glm::dvec3(p[1] - p[0]) + v * glm::dvec3(p[2] - p[0]);
  const size_t other = 3 * size_t(random.uniform(1, float(p.size() / 3)));
  const glm::dvec3 mid = glm::dvec3(p[other] + (p[other + 1] - p[other]) * random.uniform(0, 1)) +
                         any_direction(random) * double(random.uniform(0, 1e-4f));
  glm::dvec3 light = point_in(random, 6);
  if (kind == 1) light = mid + (mid - place) * double(random.uniform(0, 2));    // close by an edge
  if (kind == 2) light = glm::dvec3(p[other] + (p[other + 1] - p[other + 2]));  // in a plane
  if (kind == 3)
    light = place + glm::normalize(point_in(random, 1)) * double(random.uniform(0, 0.01f));  // near
  const glm::dvec3 normal = glm::cross(glm::dvec3(p[1] - p[0]), glm::dvec3(p[2] - p[0]));
  const double turn = glm::dot(normal, light - place) < 0 ? -1 : 1;
  return {{{0, 0}, {place, 4e-5}, 1e-3 + 6e-6, {place + glm::normalize(normal) * turn * 3.0, 1e-6}},
          light_at(light)};
}

// For each vertex the first one at its place: they move alike.
std::vector<size_t> first_alike(const std::vector<glm::vec3>& p) {
  std::vector<size_t> first;
  for (size_t i = 0; i < p.size(); ++i) first.push_back(size_t(std::ranges::find(p, p[i]) - p.begin()));
  return first;
}

Soup soup_of(Random& random, const Scene& scene, const Occlusion& occlusion, const Pair& pair,
             const std::vector<size_t>& first, double by) {
  const std::vector<glm::vec3>& p = scene.meshes[0].positions;
  std::vector<Point> points;
  for (size_t i = 0; i < p.size(); ++i)
    points.push_back(first[i] < i
                         ? points[first[i]]
                         : moved(random, glm::dvec3(p[i]), by * occlusion.rounded(glm::dvec3(p[i])).error_m));
  Soup soup;
  for (size_t i = 0; i < p.size(); i += 3)
    soup.triangles.push_back({points[i], points[i + 1], points[i + 2]});
  soup.light = moved(random, pair.light.position, by * 1e-7);
  soup.place = moved(random, pair.receiver.place.place, by * pair.receiver.place.error_m);
  soup.eye = Point(pair.receiver.eye.place);
  soup.gap = Real(pair.receiver.gap_m);
  return soup;
}

struct Count {
  int seen = 0, hidden = 0, either = 0;
};

Count check_soup(unsigned seed) {
  Random random(seed);
  const Scene scene = scene_of({mesh_of(random_triangles(random, 60))});
  const Occlusion occlusion(scene);
  const std::vector<size_t> first = first_alike(scene.meshes[0].positions);
  Count count;
  int last = -1;
  for (int i = 0; i < 600; ++i) {
    const Pair pair = random_pair(random, scene, i % 4);
    const SightAnswer answer = occlusion.sight(pair.light, pair.receiver, &last);
    EXPECT_EQ(answer.sight, occlusion.sight(pair.light, pair.receiver).sight) << seed << " " << i;
    ++(answer.sight == Sight::seen     ? count.seen
       : answer.sight == Sight::hidden ? count.hidden
                                       : count.either);
    if (answer.sight == Sight::either) continue;
    // As they are, and with all points moved as far as rounding may.
    for (int move = 0; move < 4; ++move) {
      EXPECT_EQ(hidden_in(soup_of(random, scene, occlusion, pair, first, move > 0)),
                answer.sight == Sight::hidden)
          << "soup " << seed << " pair " << i << " move " << move;
    }
  }
  return count;
}

// Within 1 mm to 1 m of a place on the first triangle.
TEST(OcclusionSoup, ReceiversBesideEachOtherGetTheSameAnswersTogether) {
  int seen = 0, hidden = 0, either = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    Random random(seed);
    const Scene scene = scene_of({mesh_of(random_triangles(random, 60))});
    const Occlusion occlusion(scene);
    int last = -1;
    for (int i = 0; i < 200; ++i) {
      const Pair pair = random_pair(random, scene, i % 4);
      std::vector<Receiver> receivers(16, pair.receiver);
      const double apart = std::pow(10.0, -i % 4);
      for (Receiver& r : receivers) r.place.place += any_direction(random) * apart * double(random.uniform());
      std::vector<const Receiver*> pointers;
      for (const Receiver& r : receivers) pointers.push_back(&r);
      std::vector<SightAnswer> answers(16);
      occlusion.sights(pair.light, pointers, answers, &last);
      for (size_t k = 0; k < 16; ++k) {
        const Sight alone = occlusion.sight(pair.light, receivers[k]).sight;
        EXPECT_EQ(answers[k].sight, alone) << "soup " << seed << " block " << i << " receiver " << k;
        ++(alone == Sight::seen ? seen : alone == Sight::hidden ? hidden : either);
      }
    }
  }
  EXPECT_GT(seen, 3000);
  EXPECT_GT(hidden, 3000);
  EXPECT_GT(either, 300);
}

TEST(OcclusionSoup, WhatIsCertainStaysSoHoweverPositionsAreRounded) {
  Count all;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const Count c = check_soup(seed);
    all.seen += c.seen;
    all.hidden += c.hidden;
    all.either += c.either;
  }
  // A quarter of the lights shine close by an edge, another lies in a plane.
  EXPECT_GT(all.seen, 600);
  EXPECT_GT(all.hidden, 2000);
  EXPECT_LT(all.either, 7200 / 3);
  EXPECT_GT(all.either, 500);
}

}  // namespace
}  // namespace lightgrid::lab
