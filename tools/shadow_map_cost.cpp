// Costs and errors of shadow maps on the OpenCL device that lightgrid would use: a scene's
// first camera, all its point and spot lights, every pair of a pixel and a light that reaches it. Leaked and
// acned are counted against exact rays of the same pairs. Times are of kernels, the least of three.
//   shadow_map_cost SCENE.gltf|hall|street|... [LIGHTS.json]
#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "base/timer.h"
#include "cl/transfer.h"
#include "oracle/lit_set.h"
#include "oracle/position.h"
#include "raster/raster_view.h"
#include "rays/ray_scene.h"
#include "scene/lights_file.h"
#include "scene/load_gltf.h"
#include "scenes/builtin.h"
#include "shadow_maps/shadow_maps.h"

namespace lightgrid {
using namespace lab;
namespace {

using glm::dvec3;

struct Device {
  ClDevice cl;
  ProgramCache programs{cl};
};

// Masks count as opaque. Triangles have the same numbers in both.
struct Geometry {
  RayScene rays;
  RasterScene raster;
  RasterView view;
  Geometry(Device& device, const Scene& scene)
      : rays(device.cl, device.programs), raster(device.cl), view(raster, device.programs) {
    std::vector<RayMesh> ray_meshes;
    std::vector<RasterMesh> raster_meshes;
    for (const Mesh& mesh : scene.meshes) {
      ray_meshes.push_back({mesh.positions, mesh.indices});
      raster_meshes.push_back({mesh.positions, mesh.indices});
    }
    std::vector<RayInstance> ray_instances;
    std::vector<RasterInstance> raster_instances;
    for (const Instance& i : scene.instances) {
      const Material& material = scene.materials[size_t(scene.meshes[size_t(i.mesh)].material)];
      const bool solid = material.alpha_mode != AlphaMode::blend;
      ray_instances.push_back(
          {.mesh = i.mesh, .world_from_object = i.world_from_object, .casts = solid && i.casts_shadow});
      raster_instances.push_back(
          {.mesh = i.mesh, .world_from_object = i.world_from_object, .two_sided = true, .drawn = solid});
    }
    rays.set_meshes(ray_meshes);
    raster.set_meshes(raster_meshes);
    rays.set_instances(ray_instances);
    view.set_instances(raster_instances);
  }
};

struct Pairs {
  std::vector<RayPoint> points;
  std::vector<RayPacket> packets;
  std::vector<RayLight> sources;
  size_t count = 0;
};

struct Corner {
  dvec3 at[3];
};

std::vector<Corner> triangles_of(const Scene& scene, const dvec3& origin) {
  std::vector<Corner> triangles;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
      Corner& t = triangles.emplace_back();
      for (size_t k = 0; k < 3; ++k) {
        const glm::dvec4 p(dvec3(mesh.positions[mesh.indices[i + k]]), 1);
        t.at[k] = dvec3(instance.world_from_object * p) - origin;
      }
    }
  }
  return triangles;
}

// Packets are blocks of 4 x 4 pixels. Lights on the other side of a pixel's triangle than the eye make no
// pair: they are hidden without a map.
Pairs pairs_of(Device& device, const Scene& scene, const View& view, Geometry& geometry) {
  geometry.view.set_camera({view.grid(), view.clip_from_view, view.view_from_world, view.eye});
  const Visibility image = geometry.view.draw();
  const size_t pixels = size_t(view.width) * size_t(view.height);
  std::vector<uint32_t> numbers(pixels);
  std::vector<float> depths(pixels);
  read_buffer(device.cl, "shadow_map_cost", image.triangle, numbers.data(), pixels * 4);
  read_buffer(device.cl, "shadow_map_cost", image.depth, depths.data(), pixels * 4);
  const dvec3 origin = geometry.rays.origin(), eye = view.eye - origin;
  const std::vector<Corner> triangles = triangles_of(scene, origin);
  const std::vector<ViewLight> lights = lights_in_view(scene, view);
  const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(view.view_from_world));
  Pairs pairs;
  for (const Light& light : scene.lights) pairs.sources.push_back({light.position - origin, 1});
  for (int y0 = 0; y0 + 4 <= view.height; y0 += 4) {
    for (int x0 = 0; x0 + 4 <= view.width; x0 += 4) {
      const uint32_t block = uint32_t(pairs.points.size() / 16);
      std::vector<uint32_t> lanes(lights.size());
      for (int k = 0; k < 16; ++k) {
        const int x = x0 + k % 4, y = y0 + k / 4;
        const size_t i = size_t(y) * size_t(view.width) + size_t(x);
        RayPoint& point = pairs.points.emplace_back();
        if (numbers[i] == no_triangle) continue;
        const Corner& t = triangles[numbers[i]];
        const dvec3 in_view = position_from_depth(view, x, y, double(depths[i]));
        const dvec3 seen = eye + world_from_view * in_view;
        const dvec3 normal = glm::normalize(glm::cross(t.at[1] - t.at[0], t.at[2] - t.at[0]));
        const dvec3 place = seen - normal * glm::dot(normal, seen - t.at[0]);
        point.position = glm::vec3(place);
        point.own = int(numbers[i]);
        const bool eye_side = glm::dot(normal, eye - place) > 0;
        for (size_t l = 0; l < lights.size(); ++l) {
          if (is_directional(lights[l]) || !is_lit(lights[l], in_view)) continue;
          if ((glm::dot(normal, dvec3(pairs.sources[l]) - place) > 0) != eye_side) continue;
          lanes[l] |= 1u << k;
          ++pairs.count;
        }
      }
      for (size_t l = 0; l < lights.size(); ++l)
        if (lanes[l]) pairs.packets.push_back({block, uint32_t(l), lanes[l]});
    }
  }
  return pairs;
}

double least_ms(Device& device, const std::string& label, const std::function<void()>& run) {
  double least = HUGE_VAL;
  for (int i = 0; i < 3; ++i) {
    run();
    for (const ClProfiler::Row& row : device.cl.profiler().collect())
      if (row.label == label) least = std::min(least, row.ms);
  }
  return least;
}

// One RasterView for all faces in turn: wall time a face.
double raster_views_ms(Geometry& geometry, const RayScene& rays, const ShadowAtlas& atlas, size_t most) {
  const size_t faces = std::min(most, atlas.faces.size());
  const Timer timer;
  for (size_t i = 0; i < faces; ++i) {
    const ShadowFace& f = atlas.faces[i * atlas.faces.size() / faces];
    glm::dmat4 view_from_world(1), clip_from_view(0);
    dvec3 light;
    for (int k = 0; k < 3; ++k) {
      view_from_world[k] = glm::dvec4(f.right[k], f.up[k], -f.ahead[k], 0);
      light[k] = double(f.from[k]) + rays.origin()[k];
    }
    clip_from_view[0][0] = clip_from_view[1][1] = 1 / double(f.extent);
    clip_from_view[2][3] = -1;
    clip_from_view[3][2] = 1e-3 * double(f.range_m);
    geometry.view.set_camera({{int(f.size), int(f.size)}, clip_from_view, view_from_world, light});
    geometry.view.draw();
  }
  return timer.elapsed_ms() / double(faces);
}

void measure(const std::string& name, const char* lights_file) {
  constexpr int width = 640, height = 360;
  const BuiltinScene* builtin = find_builtin_scene(name);
  Scene scene = builtin ? builtin->make() : load_gltf(name);
  if (lights_file) scene.lights = load_lights_file(lights_file);
  Device device;
  Geometry geometry(device, scene);
  const View view = make_view(choose_camera(scene, "", double(width) / height), width, height);
  const Pairs pairs = pairs_of(device, scene, view, geometry);
  const WorldBox box = world_box(scene);
  device.cl.profiler().time_launches(true);
  std::vector<uint32_t> truth;
  const double rays_ms = least_ms(device, "rays_occlusion", [&] {
    truth = geometry.rays.occlusion(pairs.points, pairs.sources, pairs.packets);
  });
  size_t hidden = 0;
  for (const uint32_t bits : truth) hidden += size_t(__builtin_popcount(bits));
  fmt::print("{}, {} x {}, {}: {} triangles, {} pairs, {:.1f} % hidden; rays {:.1f} ms\n", name, width,
             height, device.cl.info().name, geometry.rays.triangles(), pairs.count,
             100.0 * double(hidden) / double(pairs.count), rays_ms);
  fmt::print(
      "| size | bits | filter | leaked % | acned % | light too much % | too little % | draw ms | look up ms "
      "| MB | halved |\n");
  const auto row = [&](const ShadowMapOptions& options) {
    ShadowMaps maps(device.cl, device.programs, options);
    const ShadowAtlas atlas = plan_shadow_atlas(scene.lights, view, geometry.rays.origin(), box, options);
    const double draw_ms = least_ms(device, "draw_faces", [&] { maps.draw(geometry.rays, atlas); });
    std::vector<uint8_t> taps;
    const double look_ms =
        least_ms(device, "look_up", [&] { taps = maps.look_up(geometry.rays, pairs.points, pairs.packets); });
    const int side = options.taps, most = side * side;
    double leaked = 0, acned = 0, more = 0, less = 0;
    for (size_t p = 0; p < pairs.packets.size(); ++p) {
      for (uint32_t k = 0; k < 16; ++k) {
        if (!(pairs.packets[p].lanes >> k & 1)) continue;
        const int dark = taps[p * 16 + k];
        if (truth[p] >> k & 1) {
          leaked += dark < most;
          more += double(most - dark) / most;
        } else {
          acned += dark > 0;
          less += double(dark) / most;
        }
      }
    }
    const double percent = 100.0 / double(pairs.count);
    fmt::print("| {} | {} | {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.1f} | {:.1f} | {:.1f} | {} |\n",
               options.size, options.bits, side, leaked * percent, acned * percent, more * percent,
               less * percent, draw_ms, look_ms, double(atlas.bytes) * 1e-6, atlas.halvings);
    std::fflush(stdout);
    return atlas;
  };
  for (const int size : {64, 128, 256, 512, 1024}) row({.size = size});
  for (const int bits : {16, 24}) row({.bits = bits});
  for (const int taps : {3, 5})
    for (const int size : {64, 256, 1024}) row({.size = size, .taps = taps});
  const ShadowAtlas atlas = plan_shadow_atlas(scene.lights, view, geometry.rays.origin(), box, {});
  device.cl.profiler().time_launches(false);
  fmt::print("a RasterView takes {:.2f} ms a face; {} faces\n",
             raster_views_ms(geometry, geometry.rays, atlas, 100), atlas.faces.size());
}

}  // namespace
}  // namespace lightgrid

int main(int count, char** arguments) {
  try {
    if (count < 2) throw lightgrid::input_error("shadow_map_cost SCENE.gltf|hall|street|... [LIGHTS.json]");
    lightgrid::measure(arguments[1], count > 2 ? arguments[2] : nullptr);
  } catch (const lightgrid::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.exit_code();
  }
}
