// The shadow rays of a frame on CPUs: by the tree, by light cells, and by Embree in packets of sixteen
// (robust mode, spatial splits), all on the same pairs of a pixel and a light in whose range and on whose
// side it lies. Masked triangles count as opaque. Rounds run in turn; receivers and pairs are made before
// them.
//   ray_race ROUNDS SCENE.gltf|hall|street|… [OPTION=VALUE]…     options as of lightgrid render: lights=64
// Prints CPU milliseconds of all threads, the least and the median, and the median of each round's ratio to
// Embree.
#include <fmt/format.h>

#if LIGHTGRID_EMBREE == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>

#include "base/embedded.h"
#include "base/error.h"
#include "base/parallel.h"
#include "cl/transfer.h"
#include "oracle/lit_set.h"
#include "oracle/position.h"
#include "rays/light_cells.h"
#include "rays/ray_packets.h"
#include "run/scene_choice.h"
#include "verify/engine.h"

namespace lightgrid {
using namespace lab;
namespace {

constexpr uint32_t packets_at_once = 64;  // as rays/ray_occlusion.cpp

constexpr const char* kernels = R"(
kernel void by_tree(RAYS_ARGUMENTS, global const float* points, global const int* own,
                    global const RaySource* lights, global const uint4* packets, uint count, global uint* hidden) {
  const RayScene scene = RAYS_SCENE;
  const uint first = (uint)get_global_id(0) * 64, end = min(first + 64, count);
  int last_blocker = -1;
  for (uint i = first; i < end; ++i) {
    const uint4 packet = packets[i];
    global const float* at = points + packet.x * (size_t)64;
    hidden[i] = lane_bits(rays_hidden(&scene, lights[packet.y],
                                      real3(vload16(0, at), vload16(1, at), vload16(2, at)), vload16(3, at),
                                      lanes_of(packet.z), vload16(packet.x, own), &last_blocker));
  }
}
kernel void by_cells(RAYS_ARGUMENTS, LIGHT_CELL_ARGUMENTS, global const float* points, global const int* own,
                     global const RaySource* lights, global const uint4* packets, uint count, global uint* hidden) {
  const RayScene scene = RAYS_SCENE;
  const LightCells cells = LIGHT_CELLS;
  const uint first = (uint)get_global_id(0) * 64, end = min(first + 64, count);
  int last_blocker = -1;
  for (uint i = first; i < end; ++i) {
    const uint4 packet = packets[i];
    global const float* at = points + packet.x * (size_t)64;
    const Real3 to = real3(vload16(0, at), vload16(1, at), vload16(2, at));
    const whole triangles = vload16(packet.x, own);
    uint served = 0;
    whole veil = (whole)(0);
    hidden[i] = hidden_by_cells(&cells, &scene, light_cells + packet.y, lights[packet.y], to, vload16(3, at),
                                packet.z, triangles, &served, &veil);
    if (packet.z & ~served)
      hidden[i] |= lane_bits(rays_hidden(&scene, lights[packet.y], to, vload16(3, at),
                                         lanes_of(packet.z & ~served), triangles, &last_blocker));
  }
})";

double cpu_ms() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) * 1e3 + double(t.tv_nsec) * 1e-6;
}

void make_rays(RayScene& rays, const Scene& scene) {
  std::vector<RayMesh> meshes;
  std::vector<RayInstance> instances;
  for (const Mesh& mesh : scene.meshes) meshes.push_back({mesh.positions, mesh.indices});
  for (const Instance& i : scene.instances) {
    const AlphaMode mode = scene.materials[scene.meshes[i.mesh].material].alpha_mode;
    instances.push_back({.mesh = i.mesh,
                         .world_from_object = i.world_from_object,
                         .casts = i.casts_shadow && mode != AlphaMode::blend});
  }
  rays.set_meshes(meshes);
  rays.set_instances(instances);
}

struct Pairs {
  std::vector<RayPoint> points;  // blocks of 4 x 4 pixels
  std::vector<RayLight> lights;
  std::vector<CellLight> cell_lights;  // the same
  std::vector<RayPacket> packets;      // by tile, then by light
  size_t count = 0;
};

// Which of 16 pixels the light may shade: bits.
uint32_t lanes_of(const ViewLight& light, const glm::dvec3& light_at, const Receiver* receivers,
                  const glm::dvec3* positions, const glm::dvec3* normals) {
  uint32_t lanes = 0;
  for (int i = 0; i < 16; ++i) {
    const glm::dvec3& at = receivers[i].place.place;
    if (receivers[i].own.instance >= 0 && is_lit(light, positions[i]) &&
        glm::dot(normals[i], light_at - at) * glm::dot(normals[i], receivers[i].eye.place - at) > 0)
      lanes |= 1u << i;
  }
  return lanes;
}

glm::dvec3 normal_of(const Scene& scene, const CastingTriangle& t) {
  const Instance& instance = scene.instances[size_t(t.instance)];
  const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
  glm::dvec3 c[3];
  for (uint32_t k = 0; k < 3; ++k)
    c[k] = glm::dvec3(instance.world_from_object *
                      glm::dvec4(mesh.positions[mesh.indices[3 * t.triangle + k]], 1));
  return glm::cross(c[1] - c[0], c[2] - c[0]);
}

Pairs pairs_of(const Scene& scene, const View& view, const RayScene& rays) {
  const auto engine = verify::device_engine("");
  const verify::ShadowImage image = engine->shadows(scene, std::vector{view}, {}).at(0);
  const std::vector<ViewLight> lights = lights_in_view(scene, view, {}, image.lights);
  const Occlusion occlusion(scene);
  Pairs pairs;
  for (const int number : image.lights) {
    const Light& light = scene.lights[size_t(number)];
    const glm::dvec3 at = light.position - rays.origin();
    pairs.lights.push_back({at, 1});
    pairs.cell_lights.push_back({at.x, at.y, at.z, light.radius_m});
  }
  constexpr int side = HostShadows::side;
  for (size_t tile = 0; tile < image.shadows.cells.size(); ++tile) {
    const int left = int(tile) % image.shadows.tiles_x * side, low = int(tile) / image.shadows.tiles_x * side;
    Receiver receivers[256];
    glm::dvec3 positions[256], normals[256];
    const size_t first = pairs.points.size();
    for (int i = 0; i < 256; ++i) {
      const int x = left + i / 16 % 4 * 4 + i % 4, y = low + i / 64 * 4 + i / 4 % 4;
      RayPoint& point = pairs.points.emplace_back();
      if (x >= view.width || y >= view.height) continue;
      const size_t pixel = view.grid().index(x, y);
      const CastingTriangle& own = image.triangles[pixel];
      if (own.instance < 0) continue;
      receivers[i] = occlusion.receiver(view, x, y, image.depths[pixel], own);
      positions[i] = position_from_depth(view, x, y, image.depths[pixel]);
      normals[i] = normal_of(scene, own);
      point = {glm::vec3(receivers[i].place.place - rays.origin()), float(receivers[i].gap_m),
               int(rays.first_triangle(size_t(own.instance)) + own.triangle)};
    }
    const glm::uvec2 cell = image.shadows.cells[tile];
    for (uint32_t entry = cell.x; entry < cell.x + cell.y; ++entry) {
      const uint32_t light = image.shadows.indices[entry];
      for (int i = 0; i < 256; i += 16) {
        const uint32_t lanes = lanes_of(lights[light], glm::dvec3(pairs.lights[light]) + rays.origin(),
                                        receivers + i, positions + i, normals + i);
        if (lanes == 0) continue;
        pairs.packets.push_back({uint32_t(first + size_t(i)) / 16, light, lanes});
        pairs.count += size_t(std::popcount(lanes));
      }
    }
  }
  return pairs;
}

class EmbreeRays {
 public:
  EmbreeRays(const Scene& scene, const RayScene& rays) : device_(rtcNewDevice(nullptr)) {
    std::vector<glm::vec3> corners;
    for (const Instance& instance : scene.instances) {
      const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
      const bool casts =
          instance.casts_shadow && scene.materials[size_t(mesh.material)].alpha_mode != AlphaMode::blend;
      for (const uint32_t i : mesh.indices) {
        const glm::dvec3 at(instance.world_from_object * glm::dvec4(mesh.positions[i], 1));
        corners.push_back(casts ? glm::vec3(at - rays.origin()) : glm::vec3(0));
      }
    }
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* places = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), corners.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), corners.size() / 3));
    for (unsigned i = 0; i < corners.size(); ++i) {
      indices[i] = i;
      for (int k = 0; k < 3; ++k) places[3 * i + unsigned(k)] = corners[i][k];
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeRays() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeRays(const EmbreeRays&) = delete;
  EmbreeRays& operator=(const EmbreeRays&) = delete;

  uint32_t hidden(const float* points, const glm::vec3& light, uint32_t lanes) const {
    RTCRay16 r;
    alignas(64) int valid[16];
    for (uint32_t i = 0; i < 16; ++i) {
      valid[i] = lanes >> i & 1 ? -1 : 0;
      r.org_x[i] = light.x;
      r.org_y[i] = light.y;
      r.org_z[i] = light.z;
      r.dir_x[i] = points[i] - light.x;
      r.dir_y[i] = points[16 + i] - light.y;
      r.dir_z[i] = points[32 + i] - light.z;
      const float squared = r.dir_x[i] * r.dir_x[i] + r.dir_y[i] * r.dir_y[i] + r.dir_z[i] * r.dir_z[i];
      r.tnear[i] = 0;
      r.tfar[i] = 1 - points[48 + i] / std::sqrt(squared);
      r.time[i] = 0;
      r.mask[i] = ~0u;
      r.id[i] = i;
      r.flags[i] = 0;
    }
#if LIGHTGRID_EMBREE == 3
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded16(valid, scene_, &context, &r);
#else
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcOccluded16(valid, scene_, &r, &arguments);
#endif
    uint32_t hidden = 0;
    for (uint32_t i = 0; i < 16; ++i) hidden |= r.tfar[i] < 0 ? 1u << i : 0;
    return hidden & lanes;
  }

 private:
  RTCDevice device_;
  RTCScene scene_ = nullptr;
};

struct Racer {
  std::string name;
  std::function<void()> trace;
  std::function<std::vector<uint32_t>()> hidden;
  std::vector<double> ms{};
};

double median(std::vector<double> v) {
  std::ranges::sort(v);
  return v[v.size() / 2];
}

void print_results(std::vector<Racer>& racers, const Pairs& pairs) {
  const std::vector<uint32_t> tree = racers.front().hidden();
  size_t hidden = 0;
  for (const uint32_t bits : tree) hidden += size_t(std::popcount(bits));
  fmt::print("{} lights, {} pairs in {} packets, {:.1f} % hidden\n", pairs.lights.size(), pairs.count,
             pairs.packets.size(), 100.0 * double(hidden) / double(pairs.count));
  for (Racer& racer : racers) {
    size_t differ = 0;
    const std::vector<uint32_t> bits = racer.hidden();
    for (size_t i = 0; i < bits.size(); ++i) differ += size_t(std::popcount(bits[i] ^ tree[i]));
    std::vector<double> ratios;
    for (size_t i = 0; i < racer.ms.size(); ++i) ratios.push_back(racer.ms[i] / racers.back().ms[i]);
    fmt::print("{:12} {:7.2f} ms least, {:7.2f} median, {:.2f} of Embree's; {} pairs differ from the tree\n",
               racer.name, std::ranges::min(racer.ms), median(racer.ms), median(ratios), differ);
  }
}

// The tree's kernel or the cells', on buffers that stay.
class KernelRays {
 public:
  KernelRays(ClDevice& device, ProgramCache& programs, const RayScene& rays, const Pairs& pairs,
             const LightCells* cells)
      : device_(device), name_(cells ? "by_cells" : "by_tree"), packets_(pairs.packets.size()) {
    const PackedRays packed = packed_rays(pairs.points, pairs.lights.size(), pairs.packets);
    inputs_[0].put(device, name_, packed.points);
    inputs_[1].put(device, name_, packed.own);
    inputs_[2].put(device, name_, pairs.lights);
    inputs_[3].put(device, name_, packed.packets);
    hidden_ = device_buffer(device, packets_ * sizeof(uint32_t));
    ClArguments arguments = rays.arguments();
    if (cells) {
      inputs_[4].put(device, name_, cells->tables(pairs.cell_lights));
      arguments = arguments + ClArguments{{"light_cells", inputs_[4].buffer()}} + cells->arguments();
    }
    arguments = arguments + ClArguments{{"points", inputs_[0].buffer()}, {"own", inputs_[1].buffer()},
                                        {"lights", inputs_[2].buffer()}, {"packets", inputs_[3].buffer()},
                                        {"count", cl_uint(packets_)},    {"hidden", hidden_}};
    kernel_ = programs.kernel_of_source(
        name_, "#define LANES 16\n" + with_includes("kernels/rays/light_cells.h") + kernels, rays.defines());
    for (size_t i = 0; i < arguments.size(); ++i)
      kernel_.setArg(cl_uint(i), arguments[i].bytes, arguments[i].value);
  }

  void trace() {
    launch(device_, name_, kernel_, cl::NDRange((packets_ + packets_at_once - 1) / packets_at_once),
           cl::NDRange(1));
    finish_queue(device_, name_);
  }
  std::vector<uint32_t> hidden() {
    std::vector<uint32_t> bits(packets_);
    read_buffer(device_, name_, hidden_, bits.data(), bits.size() * sizeof bits[0]);
    return bits;
  }

 private:
  ClDevice& device_;
  const char* name_;
  size_t packets_;
  UploadedBuffer inputs_[5];
  cl::Buffer hidden_;
  cl::Kernel kernel_;
};

std::vector<uint32_t> embree_answers(const EmbreeRays& embree, const Pairs& pairs,
                                     const std::vector<float>& points) {
  std::vector<uint32_t> hidden(pairs.packets.size());
  parallel_runs(hidden.size(), packets_at_once, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) {
      const RayPacket& p = pairs.packets[i];
      hidden[i] = embree.hidden(&points[size_t(p.block) * 64], glm::vec3(pairs.lights[p.light]), p.lanes);
    }
  });
  return hidden;
}

void race(int rounds, const SceneChoice& choice) {
  ChosenScene chosen = load_chosen_scene(choice);
  for (Light& light : chosen.scene.lights) light.casts_shadow = !is_directional(light);
  ClDevice device;
  ProgramCache programs(device);
  RayScene rays(device, programs);
  make_rays(rays, chosen.scene);
  const Pairs pairs = pairs_of(chosen.scene, chosen.view, rays);
  LightCells cells(device, programs);
  cells.make(rays, pairs.cell_lights, {.bytes = size_t(1) << 30, .triangles = size_t(1) << 30});
  KernelRays by_tree(device, programs, rays, pairs, nullptr), by_cells(device, programs, rays, pairs, &cells);
  const EmbreeRays embree(chosen.scene, rays);
  const std::vector<float> points = packed_rays(pairs.points, pairs.lights.size(), pairs.packets).points;
  std::vector<uint32_t> by_embree;
  std::vector<Racer> racers = {
      {"tree", [&] { by_tree.trace(); }, [&] { return by_tree.hidden(); }},
      {"light cells", [&] { by_cells.trace(); }, [&] { return by_cells.hidden(); }},
      {"Embree", [&] { by_embree = embree_answers(embree, pairs, points); }, [&] { return by_embree; }}};
  for (int round = -1; round < rounds; ++round) {
    for (Racer& racer : racers) {
      const double begun = cpu_ms();
      racer.trace();
      if (round >= 0) racer.ms.push_back(cpu_ms() - begun);
    }
  }
  print_results(racers, pairs);
}

}  // namespace
}  // namespace lightgrid

int main(int count, char** arguments) {
  using namespace lightgrid;
  try {
    SceneChoice choice;
    const int rounds = count > 1 ? std::atoi(arguments[1]) : 0;
    if (count < 3 || rounds < 1)
      throw input_error("ray_race ROUNDS SCENE.gltf|hall|street|… [OPTION=VALUE]…");
    choice.scene = arguments[2];
    for (int i = 3; i < count; ++i) set_choice_field(choice, arguments[i]);
    race(rounds, choice);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.exit_code();
  }
}
