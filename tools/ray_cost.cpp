// The costs of a scene's shadow rays on the OpenCL device that lightgrid would use: the tree's making and
// memory, refits, and rays from the scene's lights to patches of 4 x 4 points, 2 cm apart, on triangles
// within their reach.
//   ray_cost SCENE.gltf|hall|street|... [LIGHTS]
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

#include "base/error.h"
#include "base/timer.h"
#include "cl/transfer.h"
#include "rays/ray_scene.h"
#include "scene/load_gltf.h"
#include "scene/random.h"
#include "scenes/builtin.h"

namespace lightgrid {
namespace {

constexpr int patches_a_light = 400;
constexpr double max_reach_m = 10;  // a light's

struct Queries {
  std::vector<RayPoint> points;
  std::vector<RayLight> lights;
  std::vector<RayPacket> packets;
};

struct Placed {
  glm::dvec3 corners[3];
};

Queries queries_of(const Scene& scene, const RayScene& rays, size_t lights) {
  std::vector<Placed> triangles;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
      Placed& t = triangles.emplace_back();
      for (int k = 0; k < 3; ++k) {
        const glm::dvec4 at(glm::dvec3(mesh.positions[mesh.indices[i + k]]), 1);
        t.corners[k] = glm::dvec3(instance.world_from_object * at) - rays.origin();
      }
    }
  }
  Queries q;
  Random random(1);
  for (const Light& light : scene.lights) {
    if (is_directional(light) || q.lights.size() >= lights) continue;
    const glm::dvec3 at = light.position - rays.origin();
    std::vector<size_t> near;
    for (size_t i = 0; i < triangles.size(); ++i) {
      if (glm::distance(triangles[i].corners[0], at) < std::min<double>(light.radius_m, max_reach_m))
        near.push_back(i);
    }
    for (int patch = 0; patch < patches_a_light && !near.empty(); ++patch) {
      const size_t number = near[size_t(random.uniform() * float(near.size()))];
      const glm::dvec3(&c)[3] = triangles[number].corners;
      const glm::dvec3 normal = glm::cross(c[1] - c[0], c[2] - c[0]);
      if (!(glm::length(normal) > 0)) continue;
      const glm::dvec3 u = glm::normalize(c[1] - c[0]), v = glm::cross(glm::normalize(normal), u);
      const glm::dvec3 middle = (c[0] + c[1] + c[2]) / 3.0;
      q.packets.push_back({uint32_t(q.points.size() / 16), uint32_t(q.lights.size())});
      for (int i = 0; i < 16; ++i) {
        const glm::dvec3 p = middle + 0.02 * (u * (i % 4 - 1.5) + v * (i / 4 - 1.5));
        q.points.push_back({.position = glm::vec3(p), .own = int(number)});
      }
    }
    q.lights.push_back({at, 1});
  }
  return q;
}

void measure(const std::string& name, size_t lights) {
  const BuiltinScene* builtin = find_builtin_scene(name);
  const Scene scene = builtin ? builtin->make() : load_gltf(name);
  ClDevice device;
  ProgramCache programs(device);
  std::vector<RayMesh> meshes;
  std::vector<RayInstance> instances, once;
  for (const Mesh& mesh : scene.meshes) meshes.push_back({mesh.positions, mesh.indices});
  for (const Instance& i : scene.instances)
    instances.push_back({.mesh = i.mesh, .world_from_object = i.world_from_object});
  for (size_t m = 0; m < meshes.size(); ++m) once.push_back({.mesh = int(m)});
  RayScene rays(device, programs), each_mesh_once(device, programs);
  rays.set_meshes(meshes);
  each_mesh_once.set_meshes(meshes);
  const Timer building;
  rays.set_instances(instances);
  const double build_ms = building.elapsed_ms();
  each_mesh_once.set_instances(once);
  fmt::print(
      "{}, {}: {} instances of {} meshes, {} triangles: built in {:.0f} ms, {:.1f} MB; each mesh once: {} "
      "triangles, {:.1f} MB\n",
      name, device.info().name, instances.size(), meshes.size(), rays.triangles(), build_ms,
      double(rays.memory_bytes()) * 1e-6, each_mesh_once.triangles(),
      double(each_mesh_once.memory_bytes()) * 1e-6);

  const Queries q = queries_of(scene, rays, lights);
  device.profiler().time_launches(true);
  double least = HUGE_VAL;
  size_t hidden = 0;
  for (int run = 0; run < 9; ++run) {
    hidden = 0;
    for (const uint32_t bits : rays.occlusion(q.points, q.lights, q.packets))
      hidden += size_t(__builtin_popcount(bits));
    for (const ClProfiler::Row& row : device.profiler().collect()) least = std::min(least, row.ms);
  }
  if (q.points.empty()) {
    fmt::print("  no rays: the scene has no point or spot light near a triangle\n");
  } else {
    fmt::print("  {} rays from {} lights, {:.0f} % hidden: {:.2f} ms\n", q.points.size(), q.lights.size(),
               100.0 * double(hidden) / double(q.points.size()), least);
  }
  for (const bool all : {false, true}) {
    double refit = HUGE_VAL;
    for (int run = 0; run < 8; ++run) {
      for (size_t i = 0; i < (all ? instances.size() : 1); ++i)
        instances[i].world_from_object[3] += glm::dvec4(run % 2 ? -1e-3 : 1e-3, 0, 0, 0);
      const Timer timer;
      rays.set_instances(instances);
      finish_queue(device, "ray_cost");
      refit = std::min(refit, timer.elapsed_ms());
    }
    fmt::print("  refit of {}: {:.2f} ms\n", all ? "all instances" : "the first instance", refit);
  }
}

}  // namespace
}  // namespace lightgrid

int main(int count, char** arguments) {
  try {
    if (count < 2) throw lightgrid::input_error("ray_cost SCENE.gltf|hall|street|... [LIGHTS]");
    lightgrid::measure(arguments[1], count > 2 ? size_t(std::atoi(arguments[2])) : 256);
  } catch (const lightgrid::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.exit_code();
  }
}
