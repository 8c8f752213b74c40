#include "shadow_maps/shadow_maps.h"

#include <fmt/format.h>

#include <array>

#include "base/error.h"
#include "cl/transfer.h"

namespace lightgrid {
namespace {

template <typename T>
cl::Buffer uploaded(ClDevice& device, const std::vector<T>& values) {
  const cl::Buffer buffer = device_buffer(device, values.size() * sizeof(T));
  write_buffer(device, "shadow maps: look up", buffer, values.data(), values.size() * sizeof(T));
  return buffer;
}

}  // namespace

ShadowMaps::ShadowMaps(ClDevice& device, ProgramCache& programs, const ShadowMapOptions& options)
    : device_(device), programs_(programs), options_(options) {}

NamedKernel& ShadowMaps::kernel(const std::string& name, const RayScene& rays) {
  const std::string defines =
      fmt::format("{} {} -DLANES={}", rays.defines(), this->defines(), device_.info().cpu ? 16 : 1);
  NamedKernel& kernel = kernels_[name + defines];
  if (!kernel) kernel = NamedKernel(programs_, "shadow_maps/" + name, defines);
  return kernel;
}

void ShadowMaps::draw(const RayScene& rays, const ShadowAtlas& atlas) {
  if (atlas.texels > 0xffffffffu)
    throw machine_error("shadow maps: {} texels, more than 2^32 - 1: a smaller shadow-size", atlas.texels);
  lights_.put(device_, "shadow maps: lights", atlas.lights);
  faces_.put(device_, "shadow maps: faces", atlas.faces);
  texels_.at_least(device_, atlas.bytes);
  if (atlas.faces.empty()) return;
  kernel("draw_faces", rays)
      .launch(device_, "draw_faces", cl::NDRange(atlas.faces.size()), cl::NDRange(1),
              rays.arguments() + ClArguments{{"faces", faces_.buffer()}, {"texels", texels_.get()}});
}

std::vector<uint8_t> ShadowMaps::look_up(const RayScene& rays, std::span<const RayPoint> points,
                                         std::span<const RayPacket> packets) {
  const size_t blocks = (points.size() + 15) / 16;
  std::vector<float> places(blocks * 64);
  std::vector<int> own(blocks * 16);
  std::vector<std::array<uint32_t, 4>> records;
  for (size_t i = 0; i < points.size(); ++i) {
    const RayPoint& p = points[i];
    float* to = &places[i / 16 * 64 + i % 16];
    to[0] = p.position.x, to[16] = p.position.y, to[32] = p.position.z, to[48] = p.gap;
    own[i] = p.own;
  }
  for (const RayPacket& p : packets) records.push_back({p.block, p.light, p.lanes, 0});
  std::vector<uint8_t> taps(packets.size() * 16);
  if (packets.empty()) return taps;
  const cl::Buffer on_device[] = {uploaded(device_, places), uploaded(device_, own),
                                  uploaded(device_, records), device_buffer(device_, taps.size())};
  kernel("look_up", rays)
      .launch(device_, "look_up", cl::NDRange(packets.size()), cl::NullRange,
              rays.arguments() + arguments() +
                  ClArguments{{"points", on_device[0]},
                              {"own", on_device[1]},
                              {"packets", on_device[2]},
                              {"taps", on_device[3]}});
  read_buffer(device_, "shadow maps: look up", on_device[3], taps.data(), taps.size());
  return taps;
}

ClArguments ShadowMaps::arguments() const {
  return {{"shadow_lights", lights_.buffer()},
          {"shadow_faces", faces_.buffer()},
          {"shadow_texels", texels_.get()}};
}

std::string ShadowMaps::defines() const {
  return fmt::format("-DSHADOW_BITS={} -DSHADOW_TAPS={}", options_.bits, taps_a_side(options_.filter));
}

size_t ShadowMaps::memory_bytes() const { return faces_.bytes() + lights_.bytes() + texels_.bytes(); }

}  // namespace lightgrid
