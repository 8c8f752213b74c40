#include "shadow_maps/shadow_maps.h"

#include <fmt/format.h>

#include "base/error.h"
#include "cl/transfer.h"
#include "rays/ray_packets.h"

namespace lightgrid {

constexpr size_t tiles_a_group = 64;  // for an atlas on a GPU

ShadowMaps::ShadowMaps(ClDevice& device, ProgramCache& programs, const ShadowMapOptions& options)
    : device_(device), programs_(programs), options_(options) {}

bool ShadowMaps::lanes() const {
  return options_.shape == KernelShape::automatic ? device_.info().cpu : options_.shape == KernelShape::lanes;
}

NamedKernel& ShadowMaps::kernel(const std::string& name, const RayScene& rays) {
  const std::string defines =
      fmt::format("{} {} -DLANES={}", rays.defines(), this->defines(), lanes() ? 16 : 1);
  NamedKernel& kernel = kernels_[name + defines];
  if (!kernel) kernel = NamedKernel(programs_, "shadow_maps/" + name, defines);
  return kernel;
}

void ShadowMaps::draw(const RayScene& rays, const ShadowAtlas& atlas, const std::vector<uint8_t>& kept,
                      const cl::Buffer& texels) {
  if (atlas.texels > 0xffffffffu)
    throw machine_error("shadow maps: {} texels, more than 2^32 - 1: a smaller shadow-size", atlas.texels);
  lights_.put(device_, "shadow maps: lights", atlas.lights);
  faces_.put(device_, "shadow maps: faces", atlas.faces);
  const bool lost = texels() || texels_.bytes() < atlas.bytes;
  const cl::Buffer& drawn = texels() ? texels : texels_.at_least(device_, atlas.bytes);
  light_count_ = atlas.lights.size();
  const uint side = lanes() ? FACE_TILE_LANES : FACE_TILE_GROUP;
  std::vector<std::array<uint32_t, 2>> tiles;  // for each drawn face: its first tile, and the face
  uint32_t count = 0;
  for (uint32_t face = 0; face < atlas.faces.size(); ++face) {
    if (!lost && face < kept.size() && kept[face]) continue;
    const uint across = std::max(atlas.faces[face].size / side, 1u);
    tiles.push_back({count, face});
    count += across * across;
  }
  if (count == 0) return;
  tiles_.put(device_, "shadow maps: tiles", tiles);
  const size_t group = lanes() ? 1 : tiles_a_group;
  kernel("draw_faces", rays)
      .launch(device_, "draw_faces", cl::NDRange((count + group - 1) / group * group), cl::NDRange(group),
              rays.arguments() + ClArguments{{"faces", faces_.buffer()},
                                             {"tiles", tiles_.buffer()},
                                             {"face_count", cl_uint(tiles.size())},
                                             {"tile_count", cl_uint(count)},
                                             {"texels", drawn}});
}

std::vector<uint8_t> ShadowMaps::look_up(const RayScene& rays, std::span<const RayPoint> points,
                                         std::span<const RayPacket> packets) {
  const PackedRays packed = packed_rays(points, light_count_, packets);
  std::vector<uint8_t> taps(packets.size() * 16);
  if (packets.empty()) return taps;
  UploadedBuffer on_device[3];
  constexpr const char* what = "shadow maps: look up";
  on_device[0].put(device_, what, packed.points);
  on_device[1].put(device_, what, packed.own);
  on_device[2].put(device_, what, packed.packets);
  const cl::Buffer answers = device_buffer(device_, taps.size());
  kernel("look_up", rays)
      .launch(device_, "look_up", cl::NDRange(packets.size()), cl::NullRange,
              rays.arguments() + arguments() +
                  ClArguments{{"points", on_device[0].buffer()},
                              {"own", on_device[1].buffer()},
                              {"packets", on_device[2].buffer()},
                              {"taps", answers}});
  read_buffer(device_, what, answers, taps.data(), taps.size());
  return taps;
}

ClArguments ShadowMaps::arguments() const {
  return {{"shadow_lights", lights_.buffer()},
          {"shadow_faces", faces_.buffer()},
          {"shadow_texels", texels_.get()}};
}

std::string ShadowMaps::defines() const {
  return fmt::format("-DSHADOW_BITS={} -DSHADOW_TAPS={}", options_.bits, options_.taps);
}

size_t ShadowMaps::memory_bytes() const { return faces_.bytes() + lights_.bytes() + texels_.bytes(); }

}  // namespace lightgrid
