// Light cells: rays through them have the tree's answers to the bit.
#include "rays/light_cells.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "base/embedded.h"
#include "cl/transfer.h"
#include "rays/ray_packets.h"
#include "rays/ray_scenes.h"
#include "support/long_tests.h"

namespace lightgrid {
namespace {

// As rays/cpu/occlusion.cl and rays/gpu/occlusion.cl. A lane that lists do not serve is reported. `hidden`
// and `unserved` are 0 at first.
constexpr const char* cells_kernel = R"(
kernel void cells_occlusion(RAYS_ARGUMENTS, LIGHT_CELL_ARGUMENTS, global const float* points, global const int* own,
                            global const RaySource* lights, global const uint4* packets, volatile global uint* hidden,
                            volatile global uint* unserved) {
  const RayScene scene = RAYS_SCENE;
  const LightCells cells = LIGHT_CELLS;
  const uint i = (uint)get_global_id(0) * LANES / 16;
  const uint4 packet = packets[i];
  global const LightCellTable* table = light_cells + packet.y;
  uint served = 0, found = 0;
#if LANES == 16
  const uint asked = packet.z, lane = 0;
  global const float* at = points + packet.x * (size_t)64;
  const Real3 to = real3(vload16(0, at), vload16(1, at), vload16(2, at));
  const int16 own_here = vload16(packet.x, own);
  const float16 gap = vload16(3, at);
  int16 veil = (int16)(0);
#else
  const uint lane = (uint)get_global_id(0) % 16, asked = packet.z >> lane & 1;
  global const float* at = points + packet.x * (size_t)64 + lane;
  const Real3 to = real3(at[0], at[16], at[32]);
  const int own_here = own[packet.x * 16 + lane];
  const float gap = at[48];
  int veil = 0;
#endif
  if (table->size != 0)
    found = hidden_by_cells(&cells, &scene, table, lights[packet.y], to, gap, asked, own_here, &served, &veil);
  atomic_or(hidden + i, found << lane), atomic_or(unserved + i, (asked & ~served) << lane);
})";

struct CellAnswers {
  std::vector<uint32_t> hidden, unserved;
};

CellAnswers cell_answers(RayScene& scene, const LightCells& cells, const Queries& q,
                         const std::vector<CellLight>& lights, KernelShape shape) {
  ClDevice& device = rays_device();
  const uint32_t lanes = shape == KernelShape::lanes ? 16 : 1;
  const PackedRays packed = packed_rays(q.points, q.lights.size(), q.packets);
  UploadedBuffer on_device[5];
  on_device[0].put(device, "points", packed.points);
  on_device[1].put(device, "own", packed.own);
  on_device[2].put(device, "lights", q.lights);
  on_device[3].put(device, "tables", cells.tables(lights));
  on_device[4].put(device, "packets", packed.packets);
  CellAnswers answers{std::vector<uint32_t>(q.packets.size()), std::vector<uint32_t>(q.packets.size())};
  const size_t bytes = q.packets.size() * sizeof(uint32_t);
  const cl::Buffer hidden = device_buffer(device, bytes), unserved = device_buffer(device, bytes);
  for (const cl::Buffer& buffer : {hidden, unserved}) fill_buffer(device, "answers", buffer, 0, bytes);
  const std::string source = "#define LANES " + std::to_string(lanes) + "\n" +
                             with_includes("kernels/rays/light_cells.h") + cells_kernel;
  cl::Kernel kernel = rays_programs().kernel_of_source("cells_occlusion", source, scene.defines());
  const ClArguments arguments = scene.arguments() + ClArguments{{"light_cells", on_device[3].buffer()}} +
                                cells.arguments() +
                                ClArguments{{"points", on_device[0].buffer()},
                                            {"own", on_device[1].buffer()},
                                            {"lights", on_device[2].buffer()},
                                            {"packets", on_device[4].buffer()},
                                            {"hidden", hidden},
                                            {"unserved", unserved}};
  for (size_t i = 0; i < arguments.size(); ++i)
    kernel.setArg(cl_uint(i), arguments[i].bytes, arguments[i].value);
  launch(device, "cells_occlusion", kernel, cl::NDRange(q.packets.size() * 16 / lanes), cl::NDRange(1));
  read_buffer(device, "hidden", hidden, answers.hidden.data(), bytes);
  read_buffer(device, "unserved", unserved, answers.unserved.data(), bytes);
  return answers;
}

// The lights of `q`. Point lights have random ranges, some without end, and some are spots.
std::vector<CellLight> cell_lights(const Queries& q, RandomNumbers& random) {
  std::vector<CellLight> lights;
  for (const RayLight& light : q.lights) {
    const double far_m = random.below(2) ? 40 : HUGE_VAL,
                 range_m = random.below(3) ? random.between(0.5, 4) : far_m;
    CellLight& made = lights.emplace_back(
        CellLight{light.x, light.y, light.z, light.w != 0 ? range_m : HUGE_VAL, light.w == 0});
    if (light.w == 0 || random.below(3)) continue;
    const glm::dvec3 axis = random.direction();
    made.axis_x = axis.x;
    made.axis_y = axis.y;
    made.axis_z = axis.z;
    made.cos_outer = random.between(-0.9, 0.99);
  }
  return lights;
}

// From a light through a corner or an edge of a triangle or a border or a corner of its cells, or up to 1e-6
// of a radian past it.
glm::dvec3 hard_direction(RandomNumbers& random, const std::vector<Corners>& triangles,
                          const glm::dvec3& light, uint32_t cells) {
  const Corners& c = triangles[size_t(random.below(int(triangles.size())))];
  const int kind = random.below(4), first = random.below(3);
  glm::dvec3 to = glm::dvec3(c[size_t(first)]) - light;
  if (kind == 1) to += glm::dvec3(c[size_t(first + 1) % 3] - c[size_t(first)]) * random.unit();
  if (kind >= 2) {
    const auto border = [&] { return 2.0 * random.below(int(cells) + 1) / cells - 1; };
    to[first] = random.below(2) ? 1 : -1;
    to[(first + 1) % 3] = border();
    to[(first + 2) % 3] = kind == 2 ? border() : random.between(-1, 1);
  }
  if (random.below(2)) to += random.direction() * glm::length(to) * std::pow(10.0, random.between(-8, -6));
  return glm::length(to) > 0 ? glm::normalize(to) : random.direction();
}

// A place behind or in front of an edge or a corner of a triangle, as seen along a direction, or up to 1e-6 m
// beside that.
glm::dvec3 hard_place(RandomNumbers& random, const std::vector<Corners>& triangles,
                      const glm::dvec3& toward) {
  const Corners& c = triangles[size_t(random.below(int(triangles.size())))];
  const int first = random.below(3);
  glm::dvec3 at(c[size_t(first)]);
  if (random.below(2)) at += glm::dvec3(c[size_t(first + 1) % 3] - c[size_t(first)]) * random.unit();
  if (random.below(2)) at += random.direction() * std::pow(10.0, random.between(-8, -6));
  return at - toward * (random.below(4) ? random.between(-0.5, 3) : std::pow(10.0, random.between(-6, -3)));
}

// Blocks of points along such directions and at such places, each for only one light.
void add_hard_points(Queries& q, const std::vector<Corners>& triangles, RandomNumbers& random) {
  for (uint32_t light = 0; light < q.lights.size(); ++light) {
    const glm::dvec3 at(q.lights[light]);
    const bool is_point = q.lights[light].w != 0;
    for (int block = 0; block < 12; ++block) {
      q.packets.push_back({uint32_t(q.points.size() / 16), light});
      for (int i = 0; i < 16; ++i) {
        const glm::dvec3 point = is_point
                                     ? at + hard_direction(random, triangles, at, 8) * random.between(0.1, 5)
                                     : hard_place(random, triangles, at);
        q.points.push_back({glm::vec3(point), 1e-3f});
      }
    }
  }
}

struct Compared {
  size_t rays = 0, hidden = 0, unserved = 0, different = 0;
  Compared& operator+=(const Compared& c) {
    rays += c.rays;
    hidden += c.hidden;
    unserved += c.unserved;
    different += c.different;
    return *this;
  }
};

// The tree's answers are those of the kernel for CPUs.
Compared compared_with_tree(RayScene& scene, const LightCells& cells, const Queries& q,
                            const std::vector<CellLight>& lights, KernelShape shape) {
  const std::vector<uint32_t> tree = scene.occlusion(q.points, q.lights, q.packets);
  const CellAnswers answers = cell_answers(scene, cells, q, lights, shape);
  Compared c;
  for (size_t i = 0; i < tree.size(); ++i) {
    const uint32_t served = q.packets[i].lanes & ~answers.unserved[i];
    c.rays += size_t(std::popcount(served));
    c.unserved += size_t(std::popcount(answers.unserved[i]));
    c.hidden += size_t(std::popcount(tree[i] & served));
    c.different += size_t(std::popcount((tree[i] ^ answers.hidden[i]) & served));
  }
  return c;
}

constexpr LightCellLimits enough{.bytes = size_t(1) << 28, .triangles = size_t(1) << 28};

// offset: of a soup's triangles from the origin of its rays.
Compared compared_in_soup(int number, KernelShape shape, uint32_t seed, const glm::vec3& offset = {},
                          ProgramCache& programs = rays_programs()) {
  std::vector<Corners> triangles = hard_soups(5 + seed)[size_t(number)].triangles;
  RandomNumbers random(seed + 31);
  Queries q = queries_of(triangles, 24, 30, 17 + seed);
  add_hard_points(q, triangles, random);
  for (Corners& c : triangles)
    for (glm::vec3& p : c) p += offset;
  for (RayPoint& point : q.points) point.position += offset;
  for (RayLight& light : q.lights) light += light.w * glm::dvec4(offset, 0);
  RayScene scene = scene_of(placed(triangles), {.shape = KernelShape::lanes, .origin = glm::dvec3(0)});
  const std::vector<CellLight> lights = cell_lights(q, random);
  LightCells cells(rays_device(), programs, shape);
  cells.make(scene, lights, enough);
  return compared_with_tree(scene, cells, q, lights, shape);
}

class LightCellsInSoups : public testing::TestWithParam<std::tuple<int, KernelShape>> {
 protected:
  int soup() const { return std::get<0>(GetParam()); }
  KernelShape shape() const { return std::get<1>(GetParam()); }
};

TEST_P(LightCellsInSoups, HaveTheTreesAnswers) {
  Compared sum;
  for (uint32_t seed = 0; seed < (long_tests() ? 200 : 3); ++seed)
    sum += compared_in_soup(soup(), shape(), seed);
  EXPECT_EQ(sum.different, 0u);
  EXPECT_GT(sum.rays, 15000u);
  EXPECT_GT(sum.hidden, sum.rays / 200);
  EXPECT_GT(sum.unserved, 100u) << "longer than a range";
}

// Where floats are half a millimetre and 8 mm apart.
TEST_P(LightCellsInSoups, HaveTheTreesAnswersFarFromTheOrigin) {
  for (const float metres : {8192.0f, 1e5f}) {
    const Compared c = compared_in_soup(soup(), shape(), 7, {metres, -metres, metres});
    EXPECT_EQ(c.different, 0u) << metres;
    EXPECT_GT(c.hidden, 100u) << metres;
  }
}

std::string name_of(KernelShape shape) { return shape == KernelShape::lanes ? "Lanes" : "Group"; }

INSTANTIATE_TEST_SUITE_P(Soups, LightCellsInSoups,
                         testing::Combine(testing::Range(0, 6),
                                          testing::Values(KernelShape::lanes, KernelShape::group)),
                         [](const auto& info) {
                           return hard_soups()[size_t(std::get<0>(info.param))].name +
                                  name_of(std::get<1>(info.param));
                         });

class LightCellShapes : public testing::TestWithParam<KernelShape> {};
INSTANTIATE_TEST_SUITE_P(Shapes, LightCellShapes, testing::Values(KernelShape::lanes, KernelShape::group),
                         [](const auto& info) { return name_of(info.param); });

// Points behind a triangle one of whose edges, and thus one of whose planes, is along the light but for
// rounding.
Compared compared_behind_edges(KernelShape shape) {
  RandomNumbers random(12);
  std::vector<Corners> triangles = {{glm::vec3(5, 5, 17), glm::vec3(-6, 5, -3), glm::vec3(-12, 7, -12)},
                                    {glm::vec3(-40), glm::vec3(40, -40, -40), glm::vec3(40)}};
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 at(random.in_cube(39));
    triangles.push_back({at, at + glm::vec3(0.1f, 0, 0), at + glm::vec3(0, 0.1f, 0.1f)});
  }
  Queries q{.lights = {{6.0 / 11, -2.0 / 11, 9.0 / 11, 0}}};
  for (uint32_t block = 0; block < 100; ++block) {
    q.packets.push_back({block, 0});
    for (int lane = 0; lane < 16; ++lane) {
      glm::vec3 at(-18.9842339f, 9.363904f, -22.4421539f);
      for (int k = 0; k < 3; ++k)
        for (int i = random.below(4); i > 0; --i) at[k] = std::nextafter(at[k], 0.0f);
      q.points.push_back({at, 0});
    }
  }
  RayScene scene = scene_of(placed(triangles), {.shape = KernelShape::lanes, .origin = glm::dvec3(0)});
  const std::vector<CellLight> lights = cell_lights(q, random);
  LightCells cells(rays_device(), rays_programs(), shape);
  cells.make(scene, lights, enough);
  return compared_with_tree(scene, cells, q, lights, shape);
}

TEST_P(LightCellShapes, HaveTheTreesAnswersBehindEdgesAlongADirection) {
  const Compared c = compared_behind_edges(GetParam());
  EXPECT_EQ(c.different, 0u);
  EXPECT_GT(c.hidden, 20u);
}

// A mesh of its own for each instance, and lights, all of which move, come and go.
class LightCellSequence {
 public:
  LightCellSequence(uint32_t seed, KernelShape shape) : random_(seed), shape_(shape) {
    for (int i = 0; i < 12; ++i) {
      meshes_.push_back(placed({hard_soups()[size_t(i % 6)].triangles}));
      instances_.push_back({i, somewhere()});
    }
    for (int i = 0; i < 10; ++i) lights_.push_back(any_light());
    set_meshes();
    scene_.set_instances(instances_);
    for (int i = 0; i < 16 * 20; ++i) points_.push_back({glm::vec3(random_.in_cube(3))});
  }

  // Changes one thing, or nothing; then compares all rays with the tree's.
  Compared step(const LightCellLimits& limits) {
    moved_ = 10;
    const int change = random_.below(10), one = random_.below(int(lights_.size()));
    if (change == 0) {
      lights_[size_t(one)] = any_light();
      moved_ = one;
    }
    if (change == 1) {
      lights_[size_t(one)].range_m = random_.between(0.3, 3);
      moved_ = one;
    }
    if (change == 2) std::swap(lights_[0], lights_[size_t(one)]);
    if (change == 3) lights_[size_t(one)].range_m = -1;
    if (change == 4) move_instance(random_.below(12));
    if (change == 5) deform(random_.below(12));
    cells_.make(scene_, lights_, limits);
    Queries q{.points = points_};
    for (const CellLight& light : lights_)
      q.lights.push_back({light.x, light.y, light.z, light.directional ? 0 : 1});
    for (uint32_t light = 0; light < q.lights.size(); ++light)
      for (uint32_t block = 0; block < 20; ++block) q.packets.push_back({block, light});
    return compared_with_tree(scene_, cells_, q, lights_, shape_);
  }

  // For the last step: whether a light that moved has lists, and how many lights have some.
  bool moved_has_lists() const { return moved_ < 10 && cells_.tables(lights_)[size_t(moved_)].size != 0; }
  size_t listed() const {
    return size_t(std::ranges::count_if(cells_.tables(lights_), [](const auto& t) { return t.size != 0; }));
  }
  size_t lights() const {
    return size_t(std::ranges::count_if(lights_, [](const CellLight& l) { return l.range_m >= 0; }));
  }
  size_t memory_bytes() const { return cells_.memory_bytes(); }

 private:
  CellLight any_light() {
    const bool directional = random_.below(4) == 0;
    const glm::dvec3 at = directional ? random_.direction() : random_.in_cube(2);
    return {at.x, at.y, at.z, random_.between(0.5, 3), directional};
  }
  glm::dmat4 somewhere() {
    glm::dmat4 m(0.3);
    m[3] = glm::dvec4(random_.in_cube(2), 1);
    return m;
  }
  void forget(int instance) {
    glm::dvec3 low(HUGE_VAL), high(-HUGE_VAL);
    for (const glm::vec3& p : meshes_[size_t(instance)].positions) {
      const glm::dvec3 at(instances_[size_t(instance)].world_from_object * glm::dvec4(glm::dvec3(p), 1));
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
    cells_.forget_near(low, high);
  }
  void move_instance(int i) {
    forget(i);
    instances_[size_t(i)].world_from_object = somewhere();
    forget(i);
    scene_.set_instances(instances_);
  }
  void deform(int i) {
    forget(i);
    for (glm::vec3& p : meshes_[size_t(i)].positions) p += glm::vec3(random_.in_cube(0.2));
    forget(i);
    set_meshes();
    scene_.set_instances(instances_);
  }
  void set_meshes() {
    std::vector<RayMesh> spans;
    for (const Placed& m : meshes_) spans.push_back({m.positions, m.indices});
    scene_.set_meshes(spans);
  }

  RandomNumbers random_;
  const KernelShape shape_;
  std::vector<Placed> meshes_;
  std::vector<RayInstance> instances_;
  std::vector<CellLight> lights_;
  std::vector<RayPoint> points_;
  RayScene scene_{rays_device(), rays_programs(), {.shape = KernelShape::lanes, .origin = glm::dvec3(0)}};
  LightCells cells_{rays_device(), rays_programs(), shape_};
  int moved_ = 10;
};

TEST_P(LightCellShapes, FollowWhateverChanges) {
  LightCellSequence sequence(3, GetParam());
  sequence.step({.bytes = size_t(1) << 28});
  EXPECT_EQ(sequence.listed(), sequence.lights()) << "of a new scene all at once, whatever that takes";
  size_t served = 0, listed = 0;
  const int steps = long_tests() ? 2000 : 60;
  for (int step = 0; step < steps; ++step) {
    const Compared c = sequence.step({.bytes = size_t(1) << 28, .triangles = 3000});
    ASSERT_EQ(c.different, 0u) << "step " << step;
    EXPECT_FALSE(sequence.moved_has_lists()) << "step " << step;
    served += c.rays;
    listed += sequence.listed() == sequence.lights();
  }
  EXPECT_GT(served, size_t(steps) * 300);
  EXPECT_GT(listed, size_t(steps) / 4) << "steps in which all lights have lists";
}

// Lists come back, since those of lights that are gone make room.
TEST_P(LightCellShapes, StayWithinTheirMemory) {
  LightCellSequence sequence(4, GetParam());
  size_t some = 0, all = 0;
  const size_t steps = long_tests() ? 2000 : 60;
  constexpr size_t bytes = 500'000;
  for (size_t step = 0; step < steps; ++step) {
    const Compared c = sequence.step({.bytes = bytes, .triangles = 3000});
    ASSERT_EQ(c.different, 0u) << "step " << step;
    some += sequence.listed() != 0;
    all += sequence.listed() == sequence.lights();
    EXPECT_LE(sequence.memory_bytes(), bytes + 10 * sizeof(LightCellJob));
  }
  EXPECT_GT(some, steps * 2 / 3);
  EXPECT_LT(all, steps / 3) << "the bound is too wide for this test";
}

// A light that comes to rest gets lists in a full pool: those of lights that are gone make room at once.
TEST_P(LightCellShapes, OfLightsThatAreGoneMakeRoomForOthers) {
  const std::vector<Corners> triangles = hard_soups()[0].triangles;
  const RayScene scene = scene_of(placed(triangles), {.shape = KernelShape::lanes, .origin = glm::dvec3(0)});
  LightCells cells(rays_device(), rays_programs(), GetParam());
  std::vector<CellLight> lights = {{0.1, 0.2, 0.3, 100}};
  cells.make(scene, lights, enough);
  const LightCellLimits limits{.bytes = cells.memory_bytes() * 3, .triangles = size_t(1) << 28};
  for (int step = 0; step < 20; ++step) {
    lights[0].x += 0.01;
    for (int frame = 0; frame < 2; ++frame) cells.make(scene, lights, limits);
    EXPECT_GT(cells.tables(lights)[0].size, 0u) << "step " << step;
    EXPECT_LE(cells.memory_bytes(), limits.bytes + sizeof(LightCellJob));
  }
  lights[0].x = 0.1;
  cells.make(scene, lights, {.bytes = 0});
  cells.make(scene, lights, {.bytes = 0});
  EXPECT_EQ(cells.tables(lights)[0].size, 0u) << "there is no room";
}

struct PlantedFault {
  const char *right, *wrong;
  KernelShape shape = KernelShape::lanes;
};

// That the comparison can fail.
TEST(LightCellFaults, EachIsFound) {
  constexpr PlantedFault faults[] = {
      {"PLANE_SLACK 1e-5f", "PLANE_SLACK -1e-3f"},
      {"CELL_SLACK 1e-3f", "CELL_SLACK -1e-2f"},
      {"-offset * 0.999f", "-offset * 1.05f"},
      {"number % 2 ? -1.0f : 1.0f", "number % 2 ? 1.0f : -1.0f"},
      {"ROW_SLACK 1e-3f", "ROW_SLACK -1.0f"},
      {"CONE_SLACK 1e-4f", "CONE_SLACK -1e-1f"},
      {"> radius + 1e-3f", "> -radius + 1e-3f"},
      {"near_steps(near)", "near_steps(near) ^ 2047"},
      {"GRID_SLACK 0x1p-17f", "GRID_SLACK -0x1p-8f"},
      {"REAL(f.height) : plane.at / down + extent", "REAL(f.height) : plane.at / down - extent"},
      {"- a * job->grid.u[3]", "+ a * job->grid.u[3]"},
      {"starts + 1 + cell", "starts + cell", KernelShape::group},
      {"entries[at - gap] > one", "entries[at - gap] < one", KernelShape::group},
      {"as_uint(lane_max(near, 0.0f))", "as_uint(near + 1.0f)", KernelShape::group},
  };
  for (const PlantedFault& fault : faults) {
    ProgramCache faulty(rays_device());
    bool is_planted = false;
    faulty.alter([&](std::string text) {
      const size_t at = text.find(fault.right);
      is_planted |= at != std::string::npos;
      return at == std::string::npos ? text : text.replace(at, strlen(fault.right), fault.wrong);
    });
    Compared sum;
    for (int soup = 0; soup < 6; ++soup) sum += compared_in_soup(soup, fault.shape, 0, {}, faulty);
    EXPECT_TRUE(is_planted) << fault.right;
    EXPECT_GT(sum.different, 0u) << fault.wrong;
  }
}

}  // namespace
}  // namespace lightgrid
