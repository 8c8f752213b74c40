// Packets of points to a kernel, and its answers back.
#include "base/error.h"
#include "cl/transfer.h"
#include "rays/ray_packets.h"
#include "rays/ray_state.h"

namespace lightgrid {
namespace {

constexpr uint32_t packets_a_work_item = 64;  // on a CPU: they try each other's last blocker first
constexpr uint32_t packets_a_group = 4;       // packets per group of gpu/occlusion.cl

}  // namespace

PackedRays packed_rays(std::span<const RayPoint> points, size_t lights, std::span<const RayPacket> packets) {
  const size_t blocks = (points.size() + 15) / 16;
  PackedRays packed{std::vector<float>(blocks * 64), std::vector<int>(blocks * 16, -1)};
  for (size_t i = 0; i < packets.size(); ++i) {
    const RayPacket& p = packets[i];
    if (size_t(p.block) * 16 >= points.size() || p.light >= lights) {
      throw input_error("rays: packet {} has block {} of {} points and light {} of {}", i, p.block,
                        points.size(), p.light, lights);
    }
    packed.packets.push_back({p.block, p.light, p.lanes & 0xffff, 0});
  }
  for (size_t i = 0; i < points.size(); ++i) {
    float* to = &packed.points[i / 16 * 64 + i % 16];
    to[0] = points[i].position.x;
    to[16] = points[i].position.y;
    to[32] = points[i].position.z;
    to[48] = points[i].gap;
    packed.own[i] = points[i].own;
  }
  return packed;
}

std::vector<uint32_t> RayScene::occlusion(std::span<const RayPoint> points, std::span<const RayLight> lights,
                                          std::span<const RayPacket> packets) {
  State& s = *state_;
  s.check();
  const PackedRays packed = packed_rays(points, lights.size(), packets);
  std::vector<uint32_t> hidden(packets.size());
  if (packets.empty()) return hidden;
  const std::string file = s.lanes() ? "rays/cpu/occlusion" : "rays/gpu/occlusion";
  NamedKernel& kernel = s.occlusion[defines()];
  if (!kernel) kernel = NamedKernel(s.programs, file, defines());
  UploadedBuffer on_device[4];
  constexpr const char* what = "rays: occlusion";
  on_device[0].put(s.device, what, packed.points);
  on_device[1].put(s.device, what, packed.own);
  on_device[2].put(s.device, what, std::vector(lights.begin(), lights.end()));
  on_device[3].put(s.device, what, packed.packets);
  const cl::Buffer answers = device_buffer(s.device, hidden.size() * sizeof(uint32_t));
  const uint32_t a_work_item = s.lanes() ? packets_a_work_item : 1;
  const size_t at_once = s.lanes() ? a_work_item : packets_a_group;
  const size_t items = (packets.size() + at_once - 1) / at_once, group = s.lanes() ? 1 : 16 * packets_a_group;
  kernel.launch(s.device, "rays_occlusion", cl::NDRange(items * group), cl::NDRange(group),
                arguments() + ClArguments{{"points", on_device[0].buffer()},
                                          {"own", on_device[1].buffer()},
                                          {"lights", on_device[2].buffer()},
                                          {"packets", on_device[3].buffer()},
                                          {"count", cl_uint(packets.size())},
                                          {"a_work_item", cl_uint(a_work_item)},
                                          {"hidden", answers}});
  read_buffer(s.device, what, answers, hidden.data(), hidden.size() * sizeof(uint32_t));
  return hidden;
}

}  // namespace lightgrid
