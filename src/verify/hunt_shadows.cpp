#include "verify/hunt_shadows.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/timer.h"
#include "scene/builtin/compose.h"
#include "verify/chosen_by_name.h"
#include "verify/shadow_scenes.h"

namespace lightgrid::verify {
namespace {

using glm::dmat4;
using glm::dvec3;
using glm::vec3;

struct HuntedScene {
  Scene scene;
  std::vector<View> views;
};

// A scene of a class about the origin, about 4 m wide, without lights. Returns its triangles, for lights that
// are placed on them.
using MakeScene = ShadowTriangles (*)(Scene& scene, Random& random);

int count_of(Random& random, int low, int high) {
  return low + int(random.next() % uint64_t(high - low + 1));
}

dmat4 moved_to(const dvec3& place) { return glm::translate(dmat4(1), place); }

// Half-metres, so that pieces touch, share planes and overlap.
vec3 half_metres(Random& random, float half) {
  const float x = random.uniform(-half, half), y = random.uniform(-half, half),
              z = random.uniform(-half, half);
  return glm::round(vec3(x, y, z) * 2.0f) * 0.5f;
}

ShadowTriangles with_floor(Scene& scene, ShadowTriangles triangles) {
  add_triangles(scene, triangles);
  add_triangles(scene, quad_of({-4, -2.25f, 4}, {8, 0, 0}, {0, 0, -8}, 3, 2));
  return triangles;
}

ShadowTriangles slivers_hunted(Scene& scene, Random& random) {
  return with_floor(scene, sliver_soup(random, count_of(random, 20, 500)));
}
ShadowTriangles duplicates_hunted(Scene& scene, Random& random) {
  return with_floor(scene, duplicate_soup(random, count_of(random, 5, 100)));
}
ShadowTriangles coplanar_hunted(Scene& scene, Random& random) {
  return with_floor(scene, coplanar_soup(random, count_of(random, 3, 60)));
}
ShadowTriangles junctions_hunted(Scene& scene, Random& random) {
  return with_floor(scene, junction_soup(random, count_of(random, 3, 12)));
}
ShadowTriangles sizes_hunted(Scene& scene, Random& random) {
  return with_floor(scene, soup_of_all_sizes(random, count_of(random, 41, 300)));
}

// Walls on some sides, columns of many sides, lintels on them.
ShadowTriangles rooms_hunted(Scene& scene, Random& random) {
  ShadowTriangles all =
      quad_of({-2, -1, 2}, {4, 0, 0}, {0, 0, -4}, count_of(random, 1, 8), count_of(random, 1, 8));
  if (random.next() % 2) add_quad(all, {-2, 1, 2}, {4, 0, 0}, {0, 0, -4}, 2, 3);
  if (random.next() % 2) add_quad(all, {-2, -1, -2}, {4, 0, 0}, {0, 2, 0}, 3, 1);
  if (random.next() % 2) add_quad(all, {-2, -1, 2}, {0, 0, -4}, {0, 2, 0}, 1, 4);
  for (int i = count_of(random, 1, 12); i > 0; --i) {
    const int sides = count_of(random, 3, 24);
    const float radius = random.uniform(0.02f, 0.3f);
    const vec3 foot = vec3(0, -1, 0) + half_metres(random, 2) * vec3(1, 0, 1);
    for (int k = 0; k < sides; ++k) {
      const auto at = [&](int n) {
        const double angle = 2 * std::numbers::pi * (n % sides) / sides;
        return foot + radius * vec3(float(std::cos(angle)), 0, float(std::sin(angle)));
      };
      add_quad(all, at(k), at(k + 1) - at(k), {0, 2, 0}, 1, 2);
    }
    add_box(all, foot + vec3(-0.5f, 1.5f, -0.1f), foot + vec3(0.5f, 1.75f, 0.1f));
  }
  add_triangles(scene, all);
  return all;
}

// Steps whose treads and risers are many quads of one plane.
ShadowTriangles terraces_hunted(Scene& scene, Random& random) {
  ShadowTriangles all;
  const int steps = count_of(random, 2, 7);
  for (int i = 0; i < steps; ++i) {
    const float at = -2 + 4 * float(i) / float(steps), depth = 4 / float(steps),
                rise = random.uniform(0.0f, 0.7f);
    const float y = -1 + 0.25f * float(i);
    add_quad(all, {-2, y, at + depth}, {4, 0, 0}, {0, 0, -depth}, count_of(random, 1, 40),
             count_of(random, 1, 5));
    add_quad(all, {-2, y, at + depth}, {4, 0, 0}, {0, rise, 0}, count_of(random, 1, 30), 1);
  }
  add_triangles(scene, all);
  for (int i = count_of(random, 0, 6); i > 0; --i)
    add_triangles(scene, box_of({-0.25f, 0, -0.25f}, {0.25f, 0.5f, 0.25f}),
                  moved_to(half_metres(random, 1.5f)));
  return all;
}

// Closed boxes in each other and beside each other, with common faces.
ShadowTriangles boxes_hunted(Scene& scene, Random& random) {
  ShadowTriangles all;
  for (int i = count_of(random, 1, 25); i > 0; --i) {
    const vec3 low = half_metres(random, 1.5f), size = glm::abs(half_metres(random, 1)) + vec3(0.5f);
    add_box(all, low, low + size);
    if (random.next() % 3 == 0) add_box(all, low - size * 0.25f, low + size * 1.25f);
  }
  return with_floor(scene, all);
}

ShadowTriangles foliage_hunted(Scene& scene, Random& random) {
  scene.materials[1].alpha_cutoff = random.uniform(0.05f, 1);
  const ShadowTriangles card = quad_of({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0});
  for (int i = count_of(random, 5, 60); i > 0; --i) {
    const dmat4 turned = glm::rotate(dmat4(1), double(random.uniform(0, 6)), any_direction(random));
    add_triangles(scene, card, moved_to(in_cube(random, 1.6)) * turned, random.next() % 6 ? 1 : 0);
  }
  return with_floor(scene, box_of({-0.25f, -2.25f, -0.25f}, {0.25f, 1, 0.25f}));
}

// Mirrored, scaled, sheared, and flat.
ShadowTriangles instances_hunted(Scene& scene, Random& random) {
  const ShadowTriangles made =
      with_floor(scene, random.next() % 2 ? coplanar_soup(random, 6)
                                          : box_of({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}));
  for (int i = count_of(random, 2, 20); i > 0; --i) {
    dmat4 m(1);
    for (int k = 0; k < 3; ++k) {
      if (i % 2)
        m[k] = glm::dvec4(in_cube(random, 0.8), 0);
      else
        m[k][k] = random.next() % 2 ? 0.5 : -0.5;
    }
    m[i % 3] *= std::pow(10.0, -double(random.next() % 5));
    m[3] = glm::dvec4(dvec3(half_metres(random, 1.5f)), 1);
    scene.instances.push_back({"instance", scene.instances[0].mesh, m});
    scene.instances.back().casts_shadow = random.next() % 8 != 0;
  }
  return made;
}

struct ShadowHuntClass {
  const char* name;
  MakeScene make;
  double least_far_m = 0, most_far_m = 0;  // from the world's origin
};

constexpr ShadowHuntClass shadow_hunt_classes[] = {
    {"slivers", slivers_hunted},
    {"duplicates", duplicates_hunted},
    {"coplanar", coplanar_hunted},
    {"junctions", junctions_hunted},
    {"sizes", sizes_hunted},
    {"rooms", rooms_hunted},
    {"terraces", terraces_hunted},
    {"boxes", boxes_hunted},
    {"foliage", foliage_hunted},
    {"instances", instances_hunted},
    {"far_soups", slivers_hunted, 1e5, 1e9},
    {"far_rooms", rooms_hunted, 1e5, 1e9},
};

dvec3 place_of_lamp(const ShadowTriangles& triangles, Random& random) {
  const ShadowTriangle& t = triangles[size_t(random.next() % triangles.size())];
  const dvec3 on = on_triangle(random, t), a(t[0]), u = dvec3(t[1]) - a, v = dvec3(t[2]) - a;
  const double x = random.uniform(-2, 3), y = random.uniform(-2, 3);
  switch (random.next() % 16) {
    case 0:
      return on;
    case 1:
      return dvec3(t[random.next() % 3]);
    case 2:
      return glm::clamp(a + u * x + v * y, dvec3(-50), dvec3(50));  // in its plane
    case 3:
      return on + any_direction(random) * std::exp2(double(random.uniform(-24, -4)));
    case 4:
      return in_cube(random, 30);
    case 5:
      return dvec3(half_metres(random, 2));
    default:
      return in_cube(random, 2.1);
  }
}

void add_lamps(Scene& scene, const ShadowTriangles& triangles, Random& random) {
  const int count = count_of(random, 1, 120);
  for (int i = 0; i < count; ++i) {
    const dvec3 at = place_of_lamp(triangles, random);
    const dvec3 target = on_triangle(random, triangles[size_t(random.next() % triangles.size())]);
    const uint64_t range = random.next() % 8;
    const float radius = range == 0   ? float(glm::length(target - at))
                         : range == 1 ? random.uniform(0.1f, 3)
                                      : 60.0f;
    if (random.next() % 4 == 0 && target != at)
      add_spot_lamp(scene, at, target, random.uniform(0.02f, 3.1f), radius);
    else
      add_lamp(scene, at, radius);
    scene.lights.back().casts_shadow = random.next() % 32 != 0;
  }
  scene.lights.front().casts_shadow = true;
}

View random_shadow_view(const ShadowTriangles& triangles, Random& random) {
  constexpr int sizes[][2] = {{64, 64}, {97, 61}, {128, 96}, {33, 17}, {160, 90}, {7, 120}};
  const auto& size = sizes[random.next() % std::size(sizes)];
  const dvec3 target = on_triangle(random, triangles[size_t(random.next() % triangles.size())]);
  const dvec3 eye = random.next() % 3 ? in_cube(random, 4)
                                      : target + any_direction(random) * double(random.uniform(0.02f, 1));
  Camera camera = look_at(eye, target);
  camera.fov_y_rad = random.uniform(0.05f, 2.6f), camera.near_m = std::exp2(random.uniform(-12, -3));
  if (random.next() % 5 == 0) camera.far_m = random.uniform(2, 30);
  if (random.next() % 6 == 0) {
    camera.orthographic = true, camera.half_height_m = std::exp2(random.uniform(-4, 3));
    camera.near_m = -20, camera.far_m = random.uniform(5, 60);
  }
  return make_view(camera, size[0], size[1]);
}

HuntedScene hunted_scene(const ShadowHuntClass& hunted, uint64_t seed) {
  Random random(Random::mix(seed));
  HuntedScene made{empty_shadow_scene(), {}};
  const ShadowTriangles triangles = hunted.make(made.scene, random);
  add_lamps(made.scene, triangles, random);
  for (int i = 0; i < 3; ++i) made.views.push_back(random_shadow_view(triangles, random));
  if (hunted.most_far_m > 0) {
    const double far_m =
        hunted.least_far_m * std::pow(hunted.most_far_m / hunted.least_far_m, double(random.uniform()));
    const dvec3 far = any_direction(random) * far_m;
    for (Instance& instance : made.scene.instances) instance.world_from_object[3] += glm::dvec4(far, 0);
    for (Light& light : made.scene.lights) light.position += far;
    for (View& view : made.views) {
      view.eye += far;
      view.view_from_world[3] = glm::dvec4(-(glm::dmat3(view.view_from_world) * view.eye), 1);
    }
  }
  return made;
}

std::vector<ShadowHuntClass> chosen_shadow_classes(const std::string& filter) {
  return chosen_by_name(
      shadow_hunt_classes, filter, [](const ShadowHuntClass& c) { return c.name; },
      "class of the hunt of shadows", "slivers or rooms");
}

class ShadowHunt {
 public:
  ShadowHunt(CullEngine& engine, const HuntOptions& options)
      : engine_(engine), options_(options), classes_(chosen_shadow_classes(options.filter)) {
    report_.device = engine.name(), report_.seed = options.seed;
    for (const ShadowHuntClass& hunted : classes_) report_.classes.push_back({.name = hunted.name});
  }

  ShadowHuntReport run() {
    for (uint64_t i = 0; part_done() < 1; ++i) {
      const size_t at = i % classes_.size();
      if (options_.progress) options_.progress(std::min(part_done(), 0.999), classes_[at].name);
      look(classes_[at], report_.classes[at], options_.seed + i);
    }
    if (options_.progress) options_.progress(1, "done");
    report_.seconds = timer_.elapsed_ms() / 1000;
    return report_;
  }

 private:
  double part_done() const {
    if (options_.contacts) return double(decided_) / double(options_.contacts);
    return timer_.elapsed_ms() / 60'000 / options_.minutes;
  }

  void look(const ShadowHuntClass& hunted, ShadowHuntTally& tally, uint64_t seed) {
    const Timer timer;
    const HuntedScene made = hunted_scene(hunted, seed);
    try {
      if (!compare(tally, made, seed)) tally.failed.push_back(seed);
    } catch (const Error& error) {
      if (tally.refused++ == 0) tally.refusal = fmt::format("seed {}: {}", seed, error.what());
      tally.failed.push_back(seed);
    }
    tally.seconds += timer.elapsed_ms() / 1000;
  }

  // Whether all is right.
  bool compare(ShadowHuntTally& tally, const HuntedScene& made, uint64_t seed) {
    Random random(seed);
    Settings settings;
    settings.everything_on = random.next() % 4 == 0, settings.portable = random.next() % 4 == 0;
    const std::vector<ShadowImage> images = engine_.shadows(made.scene, made.views, settings);
    if (images.empty()) throw input_error("the engine finds no shadows");
    std::vector<ShadowImage> by_others;
    if (random.next() % 16 == 0) {
      Settings lanes = settings, group = settings;
      lanes.kernel_shape = KernelShape::lanes, group.kernel_shape = KernelShape::group;
      by_others = engine_.shadows(made.scene, made.views, lanes);
      for (ShadowImage& image : engine_.shadows(made.scene, made.views, group))
        by_others.push_back(std::move(image));
    }
    bool right = true;
    const Occlusion occlusion(made.scene);
    for (size_t i = 0; i < images.size(); ++i) {
      ShadowPairs pairs = count_shadow_pairs(made.scene, occlusion, made.views[i], images[i]);
      if (!pairs.why.empty()) pairs.why = fmt::format("seed {}, view {}: {}", seed, i, pairs.why);
      right = right && pairs.wrong() == 0;
      decided_ += pairs.decided(), tally.pairs += pairs, ++tally.views;
    }
    for (size_t i = 0; i < by_others.size(); ++i) {
      const std::string differ = difference(by_others[i], images[i % images.size()]);
      if (differ.empty()) continue;
      right = false, ++tally.shapes_differ;
      if (tally.refusal.empty())
        tally.refusal = fmt::format("seed {}, view {}: the kernel shapes' {} differ", seed, i, differ);
    }
    return right;
  }

  CullEngine& engine_;
  const HuntOptions& options_;
  const std::vector<ShadowHuntClass> classes_;
  const Timer timer_;
  ShadowHuntReport report_;
  uint64_t decided_ = 0;
};

nlohmann::ordered_json json_of(const ShadowHuntTally& t) {
  return {{"name", t.name},           {"pairs", t.pairs.decided()}, {"hidden", t.pairs.hidden},
          {"either", t.pairs.either}, {"leaked", t.pairs.leaked},   {"acned", t.pairs.acned},
          {"views", t.views},         {"refused", t.refused},       {"shapes_differ", t.shapes_differ},
          {"seconds", t.seconds},     {"failed_seeds", t.failed},   {"why", t.pairs.why},
          {"refusal", t.refusal}};
}

}  // namespace

ShadowHuntTally ShadowHuntReport::total() const {
  ShadowHuntTally sum{.name = "all"};
  for (const ShadowHuntTally& t : classes) {
    sum.pairs += t.pairs, sum.views += t.views, sum.refused += t.refused;
    sum.shapes_differ += t.shapes_differ, sum.seconds += t.seconds;
    sum.failed.insert(sum.failed.end(), t.failed.begin(), t.failed.end());
    if (sum.refusal.empty()) sum.refusal = t.refusal;
  }
  return sum;
}

bool ShadowHuntReport::failed() const { return !total().failed.empty(); }

ShadowHuntReport hunt_shadows(CullEngine& engine, const HuntOptions& options) {
  return ShadowHunt(engine, options).run();
}

nlohmann::ordered_json to_json(const ShadowHuntReport& report) {
  nlohmann::ordered_json json = {
      {"device", report.device}, {"seed", report.seed}, {"seconds", report.seconds}};
  nlohmann::ordered_json all = json_of(report.total());
  all.erase("name"), all.erase("seconds");
  json.update(all);
  json["classes"] = nlohmann::ordered_json::array();
  for (const ShadowHuntTally& tally : report.classes) json["classes"].push_back(json_of(tally));
  return json;
}

}  // namespace lightgrid::verify
