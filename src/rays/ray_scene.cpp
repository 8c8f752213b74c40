#include "rays/ray_scene.h"

#include <array>

#include "base/error.h"
#include "cl/buffers.h"
#include "cl/transfer.h"
#include "rays/ray_arrays.h"

namespace lightgrid {
namespace {

constexpr uint32_t packets_a_work_item = 64;  // they find their last blocker again
constexpr uint32_t packets_a_group = 4;       // of gpu/occlusion.cl at a time

template <typename T>
void upload(ClDevice& device, GrowingBuffer& buffer, const std::vector<T>& values) {
  buffer.at_least(device, values.size() * sizeof(T));
  write_buffer(device, "rays: scene", buffer.get(), values.data(), values.size() * sizeof(T));
}

template <typename T>
cl::Buffer uploaded(ClDevice& device, const std::vector<T>& values) {
  const cl::Buffer buffer = device_buffer(device, values.size() * sizeof(T));
  write_buffer(device, "rays: occlusion", buffer, values.data(), values.size() * sizeof(T));
  return buffer;
}

bool has_doubles(ClDevice& device) {
  return device.device().getInfo<CL_DEVICE_EXTENSIONS>().find("cl_khr_fp64") != std::string::npos;
}

}  // namespace

struct RayScene::State {
  ClDevice& device;
  ProgramCache& programs;
  RayOptions options;
  std::vector<RayMeshData> meshes{};
  std::vector<uint32_t> first_triangles{};
  uint32_t triangle_count = 0, invalid = 0;
  glm::dvec3 origin{0};
  float extent = 0;
  bool has_instances = false;
  GrowingBuffer nodes{}, triangles{}, places{};
  NamedKernel occlusion{};

  bool lanes() const {
    return options.shape == KernelShape::automatic ? device.info().cpu : options.shape == KernelShape::lanes;
  }
};

RayScene::RayScene(ClDevice& device, ProgramCache& programs, const RayOptions& options)
    : state_(new State{device, programs, options}) {
  if (!has_doubles(device)) {
    throw machine_error("rays: {} has no doubles (cl_khr_fp64), which exact shadow rays need",
                        device.info().name);
  }
  if (!options.origin) return;
  const glm::dvec3 rounded(glm::vec3(*options.origin));
  if (!(glm::dot(rounded, rounded) < HUGE_VAL)) throw input_error("rays: the origin is not finite");
  state_->origin = rounded;
}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;

void RayScene::set_meshes(std::span<const RayMesh> meshes) {
  state_->meshes = ray_meshes(meshes);
  state_->has_instances = false;
}

void RayScene::set_instances(std::span<const RayInstance> instances) {
  State& s = *state_;
  check_ray_instances(instances, s.meshes);
  if (!s.options.origin) s.origin = ray_origin(instances, s.meshes);
  const RayArrays arrays = ray_arrays(instances, s.meshes, s.origin);
  s.first_triangles.clear();
  s.triangle_count = 0;
  for (const RayInstance& instance : instances) {
    s.first_triangles.push_back(s.triangle_count);
    s.triangle_count += s.meshes[instance.mesh].triangles();
  }
  s.invalid = arrays.invalid;
  s.extent = arrays.extent;
  upload(s.device, s.nodes, arrays.nodes);
  upload(s.device, s.triangles, arrays.triangles);
  upload(s.device, s.places, arrays.places);
  s.has_instances = true;
}

std::vector<uint32_t> RayScene::occlusion(std::span<const RayPoint> points, std::span<const RayLight> lights,
                                          std::span<const RayPacket> packets) {
  State& s = *state_;
  if (!s.has_instances) throw input_error("rays: occlusion() without set_instances()");
  std::vector<std::array<uint32_t, 4>> records;
  for (size_t i = 0; i < packets.size(); ++i) {
    const RayPacket& p = packets[i];
    if (size_t(p.block) * 16 >= points.size() || p.light >= lights.size()) {
      throw input_error("rays: packet {} has block {} of {} points and light {} of {}", i, p.block,
                        points.size(), p.light, lights.size());
    }
    records.push_back({p.block, p.light, p.lanes & 0xffff, 0});
  }
  std::vector<uint32_t> hidden(packets.size());
  if (packets.empty()) return hidden;
  const size_t blocks = (points.size() + 15) / 16;
  std::vector<float> numbers(blocks * 64);
  std::vector<int> own(blocks * 16, -1);
  for (size_t i = 0; i < points.size(); ++i) {
    float* to = &numbers[i / 16 * 64 + i % 16];
    to[0] = points[i].position.x, to[16] = points[i].position.y, to[32] = points[i].position.z;
    to[48] = points[i].gap;
    own[i] = points[i].own;
  }
  const std::string file = s.lanes() ? "rays/cpu/occlusion" : "rays/gpu/occlusion";
  if (!s.occlusion) s.occlusion = NamedKernel(s.programs, file, defines());
  const cl::Buffer on_device[] = {uploaded(s.device, numbers), uploaded(s.device, own),
                                  uploaded(s.device, std::vector(lights.begin(), lights.end())),
                                  uploaded(s.device, records),
                                  device_buffer(s.device, hidden.size() * sizeof(uint32_t))};
  const size_t at_once = s.lanes() ? packets_a_work_item : packets_a_work_item * packets_a_group;
  const size_t items = (packets.size() + at_once - 1) / at_once, group = s.lanes() ? 1 : 16 * packets_a_group;
  s.occlusion.launch(s.device, "rays_occlusion", cl::NDRange(items * group), cl::NDRange(group),
                     arguments() + ClArguments{{"points", on_device[0]},
                                               {"own", on_device[1]},
                                               {"lights", on_device[2]},
                                               {"packets", on_device[3]},
                                               {"count", cl_uint(packets.size())},
                                               {"a_work_item", cl_uint(packets_a_work_item)},
                                               {"hidden", on_device[4]}});
  read_buffer(s.device, "rays: occlusion", on_device[4], hidden.data(), hidden.size() * sizeof(uint32_t));
  return hidden;
}

glm::dvec3 RayScene::origin() const { return state_->origin; }
uint32_t RayScene::triangles() const { return state_->triangle_count; }
uint32_t RayScene::first_triangle(size_t instance) const { return state_->first_triangles.at(instance); }
uint32_t RayScene::invalid_triangles() const { return state_->invalid; }

ClArguments RayScene::arguments() const {
  const State& s = *state_;
  return {{"ray_nodes", s.nodes.get()},
          {"ray_triangles", s.triangles.get()},
          {"ray_places", s.places.get()},
          {"ray_extent", s.extent}};
}

std::string RayScene::defines() const { return ""; }

size_t RayScene::memory_bytes() const {
  return state_->nodes.bytes() + state_->triangles.bytes() + state_->places.bytes();
}

}  // namespace lightgrid
