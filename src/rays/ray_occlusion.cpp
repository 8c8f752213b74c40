// Packets of points to a kernel, and its answers back.
#include <array>

#include "base/error.h"
#include "cl/transfer.h"
#include "rays/ray_state.h"

namespace lightgrid {
namespace {

constexpr uint32_t packets_a_work_item = 64;  // on a CPU: they try each other's last blocker first
constexpr uint32_t packets_a_group = 4;       // of gpu/occlusion.cl

template <typename T>
cl::Buffer uploaded(ClDevice& device, const std::vector<T>& values) {
  const cl::Buffer buffer = device_buffer(device, values.size() * sizeof(T));
  write_buffer(device, "rays: occlusion", buffer, values.data(), values.size() * sizeof(T));
  return buffer;
}

}  // namespace

std::vector<uint32_t> RayScene::occlusion(std::span<const RayPoint> points, std::span<const RayLight> lights,
                                          std::span<const RayPacket> packets) {
  State& s = *state_;
  s.check();
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
  NamedKernel& kernel = s.occlusion[defines()];
  if (!kernel) kernel = NamedKernel(s.programs, file, defines());
  const cl::Buffer on_device[] = {uploaded(s.device, numbers), uploaded(s.device, own),
                                  uploaded(s.device, std::vector(lights.begin(), lights.end())),
                                  uploaded(s.device, records),
                                  device_buffer(s.device, hidden.size() * sizeof(uint32_t))};
  const uint32_t a_work_item = s.lanes() ? packets_a_work_item : 1;
  const size_t at_once = s.lanes() ? a_work_item : packets_a_group;
  const size_t items = (packets.size() + at_once - 1) / at_once, group = s.lanes() ? 1 : 16 * packets_a_group;
  kernel.launch(s.device, "rays_occlusion", cl::NDRange(items * group), cl::NDRange(group),
                arguments() + ClArguments{{"points", on_device[0]},
                                          {"own", on_device[1]},
                                          {"lights", on_device[2]},
                                          {"packets", on_device[3]},
                                          {"count", cl_uint(packets.size())},
                                          {"a_work_item", cl_uint(a_work_item)},
                                          {"hidden", on_device[4]}});
  read_buffer(s.device, "rays: occlusion", on_device[4], hidden.data(), hidden.size() * sizeof(uint32_t));
  return hidden;
}

}  // namespace lightgrid
