#include "rays/ray_scene.h"

#include <algorithm>
#include <utility>

#include "base/embedded.h"
#include "base/error.h"
#include "cl/transfer.h"
#include "rays/ray_state.h"
#include "rays/wide_tree.h"
#include "shared/surface_records.h"

namespace lightgrid {
namespace {

template <typename T>
void upload(ClDevice& device, GrowingBuffer& buffer, const std::vector<T>& values) {
  buffer.at_least(device, values.size() * sizeof(T));
  write_buffer(device, "rays: scene", buffer.get(), values.data(), values.size() * sizeof(T));
}

bool has_doubles(ClDevice& device) {
  return device.device().getInfo<CL_DEVICE_EXTENSIONS>().find("cl_khr_fp64") != std::string::npos;
}

}  // namespace

void RayScene::State::build(std::span<const RayInstance> given, const RayBounds& bounds) {
  refit.reset();
  if (!options.origin) origin = glm::dvec3(glm::vec3(bounds.low * 0.5 + bounds.high * 0.5));
  const RayArrays arrays = ray_arrays(given, meshes, origin);
  first_triangles.clear();
  triangle_count = 0;
  for (const RayInstance& instance : given) {
    first_triangles.push_back(triangle_count);
    triangle_count += meshes[instance.mesh].triangles();
  }
  invalid = arrays.invalid;
  masked = !arrays.masks.empty();
  upload(device, nodes, arrays.nodes);
  if (device.info().cpu) {
    const WideTree wide = wide_tree(arrays.nodes);
    upload(device, wide_nodes, wide.nodes);
    upload(device, wide_slots, wide.slots);
  }
  upload(device, triangles, arrays.triangles);
  upload(device, places, arrays.places);
  upload(device, mask_records, arrays.masks);
  refit.emplace(device, programs, arrays);
  ++builds;
}

// Throws unless the device has all that lookups need.
void RayScene::State::check() const {
  if (!has_instances)
    throw input_error(
        "rays: there are no instances: set_instances has to come first, again after set_meshes");
  if (!has_masks()) return;
  size_t vertices = 0, materials = 0;
  for (const RayMeshData& mesh : meshes) vertices += mesh.positions.size();
  for (const RayInstance& instance : instances)
    materials = std::max(materials, size_t(instance.alpha_material + 1));
  if (bytes_of(masks.vertices) < vertices * sizeof(SurfaceVertex))
    throw input_error("rays: masks have vertices for {} bytes of {}", bytes_of(masks.vertices),
                      vertices * sizeof(SurfaceVertex));
  if (bytes_of(masks.materials) < materials * sizeof(SurfaceMaterial))
    throw input_error("rays: masks have materials for {} bytes of {}", bytes_of(masks.materials),
                      materials * sizeof(SurfaceMaterial));
}

RayScene::RayScene(ClDevice& device, ProgramCache& programs, const RayOptions& options)
    : state_(new State{device, programs, options}) {
  if (!has_doubles(device)) {
    throw machine_error("rays: {} has no doubles (cl_khr_fp64), which exact shadow rays need",
                        device.info().name);
  }
  if (options.origin) set_origin(*options.origin);
}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;

void RayScene::set_origin(const glm::dvec3& origin) {
  State& s = *state_;
  const glm::dvec3 rounded{glm::vec3(origin)};
  if (!(glm::dot(rounded, rounded) < HUGE_VAL)) throw input_error("rays: the origin is not finite");
  if (s.options.origin && s.origin == rounded) return;
  s.options.origin = s.origin = rounded;
  s.refit.reset();
  s.has_instances = false;
}

// Its tree can be kept if positions alone changed.
void RayScene::set_meshes(std::span<const RayMesh> meshes) {
  State& s = *state_;
  std::vector<RayMeshData> made = ray_meshes(meshes);
  const auto same_triangles = [](const RayMeshData& a, const RayMeshData& b) {
    return a.indices == b.indices && a.positions.size() == b.positions.size();
  };
  const bool same = std::ranges::equal(made, s.meshes, same_triangles);
  s.has_instances = false;
  s.changed.resize(made.size());
  if (!same) s.refit.reset();
  for (size_t m = 0; m < made.size() && same; ++m) {
    if (made[m].positions == s.meshes[m].positions) continue;
    s.changed[m] = true;
    if (s.refit) s.refit->positions_changed();
  }
  s.meshes = std::move(made);
}

void RayScene::set_masks(const RayMasks& masks) {
  const bool vertices = masks.vertices() != nullptr, materials = masks.materials() != nullptr,
             alphas = masks.alphas() != nullptr;
  if (vertices != materials || vertices != alphas) {
    throw input_error("rays: masks have {}vertices, {}materials and {}alphas: all three or none will do",
                      vertices ? "" : "no ", materials ? "" : "no ", alphas ? "" : "no ");
  }
  state_->masks = masks;
}

void RayScene::set_instances(std::span<const RayInstance> instances) {
  State& s = *state_;
  check_ray_instances(instances, s.meshes);
  const auto same_triangles = [](const RayInstance& a, const RayInstance& b) {
    return a.mesh == b.mesh && a.alpha_material == b.alpha_material && a.casts == b.casts &&
           a.blends == b.blends;
  };
  const RayBounds bounds = ray_bounds(instances, s.meshes);
  // Where something fails on the way, the next call builds anew.
  s.has_instances = false;
  const std::vector<RayInstance> before = std::exchange(s.instances, {});
  // A corner that cannot be placed is in no tree, and would have to come back into it.
  if (!s.refit || s.invalid != 0 || !all_are_valid(bounds, s.origin) ||
      !std::ranges::equal(instances, before, same_triangles)) {
    s.build(instances, bounds);
  } else {
    std::vector<size_t> moved;
    for (size_t i = 0; i < instances.size(); ++i) {
      if (s.changed[instances[i].mesh] || instances[i].world_from_object != before[i].world_from_object)
        moved.push_back(i);
    }
    s.refit->refit(
        moved, instances, s.meshes, s.first_triangles, s.origin,
        {s.nodes.get(), s.wide_nodes.get(), s.wide_slots.get(), s.triangles.get(), s.places.get()});
  }
  s.instances.assign(instances.begin(), instances.end());
  s.changed.assign(s.meshes.size(), false);
  s.has_instances = true;
}

glm::dvec3 RayScene::origin() const { return state_->origin; }
uint32_t RayScene::triangles() const { return state_->triangle_count; }
uint32_t RayScene::first_triangle(size_t instance) const { return state_->first_triangles.at(instance); }
uint32_t RayScene::invalid_triangles() const { return state_->invalid; }

int RayScene::builds() const { return state_->builds; }

ClArguments RayScene::arguments() const {
  const State& s = *state_;
  s.check();
  return {{"ray_nodes", s.nodes.get()},         {"ray_triangles", s.triangles.get()},
          {"ray_places", s.places.get()},       {"ray_wide_nodes", s.wide_nodes.get()},
          {"ray_masks", s.mask_records.get()},  {"ray_vertices", s.masks.vertices},
          {"ray_materials", s.masks.materials}, {"ray_alphas", s.masks.alphas}};
}

std::string RayScene::defines() const {
  const std::string wide = state_->device.info().cpu ? "-DRAYS_WIDE" : "";
  if (!state_->has_masks()) return wide;
  const bool veils = std::ranges::any_of(
      state_->instances, [](const RayInstance& i) { return i.casts && i.blends && i.alpha_material >= 0; });
  return wide + (veils ? " -DRAYS_MASKS -DRAYS_VEILS" : " -DRAYS_MASKS");
}

std::string RayScene::kernel_text() { return with_includes("kernels/rays/rays.h"); }

size_t RayScene::memory_bytes() const {
  const State& s = *state_;
  return s.nodes.bytes() + s.wide_nodes.bytes() + s.wide_slots.bytes() + s.triangles.bytes() +
         s.places.bytes() + s.mask_records.bytes() + (s.refit ? s.refit->memory_bytes() : 0);
}

}  // namespace lightgrid
