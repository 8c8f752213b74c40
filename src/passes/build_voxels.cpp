#include "passes/build_voxels.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <optional>

#include <glm/gtc/packing.hpp>

#include "cl/launch.h"
#include "cl/transfer.h"
#include "passes/voxels/grouped_lights.h"
#include "passes/voxels/listed_voxels.h"
#include "renderer/cl_lights.h"

namespace lightgrid {
namespace {

constexpr float largest_float_voxel = 1e15f;  // LARGEST_VOXEL of kernels/voxels/voxel_light.h
constexpr float largest_half_voxel = 6e4f;
constexpr float brightest_half = 1024;  // what the brightest light is stored as, at most: room for sums

struct FilledWith {
  VoxelGrid grid;
  std::vector<VoxelSlice> slices;
  int lights;
};

bool same(const FilledWith& a, const FilledWith& b) {
  return a.lights == b.lights && std::memcmp(&a.grid, &b.grid, sizeof a.grid) == 0 &&
         a.slices.size() == b.slices.size() &&
         std::memcmp(a.slices.data(), b.slices.data(), a.slices.size() * sizeof a.slices[0]) == 0;
}

GlTexture make_volume(GLenum format, glm::uvec3 size) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_3D, 1, &name);
  GlTexture texture(name);
  glTextureStorage3D(name, 1, format, GLsizei(size.x), GLsizei(size.y), GLsizei(size.z));
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTextureParameteri(name, wrap, GL_CLAMP_TO_EDGE);
  return texture;
}

class VoxelBuffers : public PassState {
 public:
  explicit VoxelBuffers(RenderView& v) : lanes(shades_in_lanes(v)) { follow(v); }

  bool follow(RenderView& v) override {
    axes = voxel_axes(v.view, v.plan.settings.voxel_space);
    lights.update(v, axes);
    std::string defines = defines_of(v);
    if (defines != defines_) {
      defines_ = std::move(defines);
      kernel_ = cl::Kernel();
      filled.reset();
    }
    return true;
  }

  size_t memory_bytes() const override {
    size_t bytes = lights.memory_bytes() + grid.bytes() + slices.bytes() + lookup.bytes();
    for (const auto* volume : {&irradiance, &directions}) bytes += *volume ? (*volume)->size() : 0;
    return bytes + texture_bytes;
  }

  cl::Kernel& kernel(RenderView& v) {
    if (!kernel_())
      kernel_ =
          v.renderer.kernels->kernel(lanes ? "voxels/cpu/build_voxels" : "voxels/gpu/build_voxels", defines_);
    return kernel_;
  }

  std::string lookup_defines(const RenderView& v) const {
    return fmt::format(" -DVOXEL_BITS={}{}", v.plan.settings.voxel_bits,
                       axes.log_depth ? " -DVOXELS_LOG" : "");
  }

  const bool lanes;
  VoxelAxes axes;
  GroupedLights lights;
  PlacedVoxels placed;
  DepthBuffer shaded_from;  // in the last frame, if not the depth image
  UploadedBuffer grid, slices, lookup;
  std::optional<SharedBuffer> irradiance, directions;
  std::optional<FilledWith> filled;  // the volume holds this
  GlTexture irradiance_texture, directions_texture;
  GlBuffer lookup_block;
  bool texture_stale = true;  // the volume was filled since the textures were
  size_t texture_bytes = 0;

 private:
  std::string defines_of(const RenderView& v) const {
    std::string defines = lookup_defines(v);
    if (lanes && v.plan.settings.portable) defines += " -DPORTABLE";
    if (v.plan.spots) defines += " -DSPOTS";
    for (const char* define : range_defines(v.plan.settings.ranges)) defines += fmt::format(" -D{}", define);
    return defines;
  }

  std::string defines_;
  cl::Kernel kernel_;
};

size_t volume_bytes(const RenderView& v) {
  const glm::uvec3 size = voxel_size(v.plan.settings.voxel_size);
  return size_t(size.x) * size.y * size.z * 4 * size_t(v.plan.settings.voxel_bits) / 8;
}

// A power of two, so that it rounds nothing. In half precision the brightest light at its core is well below
// the largest value.
float stored_scale(const VoxelBuffers& s, int bits) {
  if (bits == 32 || s.lights.brightest() <= 0) return 1;
  float core = s.placed.slices[0].core_squared;
  for (const VoxelSlice& slice : s.placed.slices) core = std::min(core, slice.core_squared);
  const double most = std::min(double(s.lights.brightest()) / core, double(largest_float_voxel));
  return float(std::exp2(std::floor(std::log2(brightest_half / most))));
}

void place(RenderView& v, VoxelBuffers& s, const TileDistances& distances) {
  auto pass = v.timer.pass("place_voxels", "cl");
  s.placed = place_voxels(v, s.axes, visible_box(v, distances));
  const int bits = v.plan.settings.voxel_bits;
  VoxelGrid& grid = s.placed.grid;
  grid.groups = s.lights.groups();
  grid.scale = stored_scale(s, bits);
  grid.largest = bits == 32 ? largest_float_voxel : largest_half_voxel;
  s.placed.lookup.inverse_scale = 1 / grid.scale;
  ClDevice& device = *v.renderer.cl;
  constexpr const char* what = "placing voxels";
  s.grid.put(device, what, std::vector<VoxelGrid>{grid});
  s.slices.put(device, what, s.placed.slices);
  s.lookup.put(device, what, std::vector<VoxelLookup>{s.placed.lookup});
  pass.moves(distances.intervals.size() * sizeof(DepthInterval),
             s.grid.bytes() + s.slices.bytes() + s.lookup.bytes());
}

}  // namespace

VoxelVolume build_voxels(RenderView& v, const TileDistances& distances, const DepthBuffer& depth) {
  VoxelBuffers& s = v.state<VoxelBuffers>();
  s.shaded_from = depth;
  cl::Kernel& kernel = s.kernel(v);
  place(v, s, distances);
  const size_t bytes = volume_bytes(v);
  const BridgeKind bridge =
      v.plan.settings.raster == RasterApi::opencl ? BridgeKind::none : v.renderer.bridge;
  if (!s.irradiance) s.irradiance.emplace(*v.renderer.cl, bridge, bytes);
  if (!s.directions) s.directions.emplace(*v.renderer.cl, bridge, bytes);
  VoxelVolume volume{&*s.irradiance, &*s.directions, s.lookup.buffer(), s.lookup_defines(v), 2 * bytes};
  FilledWith needed{s.placed.grid, s.placed.slices, s.lights.version()};
  if (v.plan.settings.voxel_reuse && s.filled && same(*s.filled, needed)) return volume;
  auto pass = v.timer.pass("build_voxels", "cl");
  const VoxelGrid& g = s.placed.grid;
  const cl::NDRange bricks(g.size_x / VOXEL_BRICK_X, g.size_y / VOXEL_BRICK_Y, g.size_z / VOXEL_BRICK_Z);
  const cl::NDRange items(g.size_x / VOXEL_GROUP_X * VOXEL_GROUP_ITEMS, g.size_y / VOXEL_GROUP_Y, g.size_z);
  launch(*v.renderer.cl, "build_voxels", kernel, s.lanes ? bricks : items,
         s.lanes ? cl::NDRange(1, 1, 1) : cl::NDRange(VOXEL_GROUP_ITEMS, 1, 1), s.lights.boxes.buffer(),
         s.lights.places.buffer(), s.lights.colors.buffer(),
         v.plan.spots ? s.lights.cones.buffer() : cl::Buffer(), s.grid.buffer(), s.slices.buffer(),
         s.irradiance->cl_buffer(), s.directions->cl_buffer());
  s.filled = std::move(needed);
  s.texture_stale = true;
  pass.moves(s.lights.memory_bytes(), volume.bytes);
  return volume;
}

VoxelTextures voxels_to_gl(RenderView& v, const VoxelVolume& volume) {
  VoxelBuffers& s = v.state<VoxelBuffers>();
  auto pass = v.timer.pass("voxels_to_gl", "gl");
  const VoxelGrid& g = s.placed.grid;
  const bool half = v.plan.settings.voxel_bits == 16, first = !s.irradiance_texture;
  if (first) {
    const glm::uvec3 size(g.size_x, g.size_y, g.size_z);
    const GLenum format = half ? GL_RGBA16F : GL_RGBA32F;
    s.irradiance_texture = make_volume(format, size), s.directions_texture = make_volume(format, size);
    s.lookup_block = make_buffer(sizeof(VoxelLookup), nullptr, GL_DYNAMIC_STORAGE_BIT);
    s.texture_bytes = volume.bytes;
  }
  glNamedBufferSubData(s.lookup_block.name(), 0, sizeof(VoxelLookup), &s.placed.lookup);
  if (s.texture_stale) {
    const SharedBuffer::Written written[] = {{volume.irradiance, volume.bytes / 2},
                                             {volume.directions, volume.bytes / 2}};
    SharedBuffer::hand_to_gl(written);
    const auto copy = [&](SharedBuffer& from, const GlTexture& to) {
      v.renderer.pixel_copies.to_texture(from.gl_buffer(), GL_RGBA, half ? GL_HALF_FLOAT : GL_FLOAT,
                                         int(g.size_x), int(g.size_y), to.name(), int(g.size_z));
    };
    copy(*volume.irradiance, s.irradiance_texture), copy(*volume.directions, s.directions_texture);
    s.texture_stale = false;
    pass.moves(volume.bytes, volume.bytes);
  }
  return {s.irradiance_texture.name(), s.directions_texture.name(), s.lookup_block.name(), s.axes.log_depth,
          volume.bytes};
}

ReadVoxels read_voxels(RenderView& v) {
  VoxelBuffers& s = v.state<VoxelBuffers>();
  ReadVoxels read{s.axes, s.placed, {}, {}};
  const size_t samples = size_t(s.placed.grid.size_x) * s.placed.grid.size_y * s.placed.grid.size_z;
  const auto values = [&](SharedBuffer& from) {
    std::vector<glm::vec4> all(samples);
    if (v.plan.settings.voxel_bits == 32) {
      read_buffer(*v.renderer.cl, "reading voxels", from.cl_buffer(), all.data(), samples * sizeof all[0]);
    } else {
      std::vector<uint64_t> halves(samples);
      read_buffer(*v.renderer.cl, "reading voxels", from.cl_buffer(), halves.data(),
                  samples * sizeof halves[0]);
      for (size_t i = 0; i < samples; ++i) all[i] = glm::unpackHalf4x16(halves[i]);
    }
    for (glm::vec4& value : all) value *= s.placed.lookup.inverse_scale;
    return all;
  };
  read.irradiance = values(*s.irradiance), read.directions = values(*s.directions);
  return read;
}

ListedLights listed_of_voxels(RenderView& v) {
  if (!v.plan.local_lights) return list_every_light(0);
  const VoxelBuffers& s = v.state<VoxelBuffers>();
  return list_voxels(v, {s.axes, s.placed, {}, {}}, s.shaded_from);
}

}  // namespace lightgrid
