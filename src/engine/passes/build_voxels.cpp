#include "passes/build_voxels.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <optional>

#include <glm/gtc/packing.hpp>

#include "cl/launch.h"
#include "cl/transfer.h"
#include "passes/voxels/voxel_inputs.h"
#include "passes/voxels/voxel_settings.h"
#include "plan/settings/kernels.h"
#include "plan/settings/surfaces.h"
#include "renderer/upload/lights.h"

namespace lightgrid {
namespace {

constexpr float largest_float_voxel = 1e15f;  // LARGEST_VOXEL of kernels/voxels/voxel_light.h
constexpr float largest_half_voxel = 6e4f;
constexpr float brightest_half = 1024;  // the brightest light's largest stored value: room for sums

}  // namespace

struct FilledWith {
  VoxelGrid grid;
  std::vector<VoxelSlice> slices;
  int lights;
};

namespace {

bool same(const FilledWith& a, const FilledWith& b) {
  return a.lights == b.lights && std::memcmp(&a.grid, &b.grid, sizeof a.grid) == 0 &&
         a.slices.size() == b.slices.size() &&
         std::memcmp(a.slices.data(), b.slices.data(), a.slices.size() * sizeof a.slices[0]) == 0;
}

}  // namespace

static const Setting<int> voxel_bits{500,
                                     "voxel-bits",
                                     "bits per value in voxel_lights' volume, float in both cases",
                                     {{"32", 32}, {"16", 16}}};
static const Setting<bool> voxel_reuse{
    520,
    "voxel-reuse",
    "voxel_lights' volume is filled in each frame, or only if its place or a light changed",
    {{"off", false}, {"on", true}}};

class VoxelBuffers : public PassCache {
 public:
  explicit VoxelBuffers(PassContext& work) : kernels(work, "voxels") { follow(work); }

  bool follow(PassContext& work) override {
    axes = voxel_axes(work.view, work.plan.settings[setting::voxel_space]);
    lights.update(work, axes);
    if (kernels.use(defines_of(work))) filled.reset();
    return true;
  }

  size_t memory_bytes() const override {
    size_t bytes = lights.memory_bytes() + grid.bytes() + slices.bytes() + lookup.bytes();
    for (const auto* volume : {&irradiance, &directions}) bytes += *volume ? (*volume)->size() : 0;
    return bytes + texture_bytes;
  }

  std::string lookup_defines(const ViewState& seen) const {
    return fmt::format(" -DVOXEL_BITS={}{}", seen.plan.settings[voxel_bits],
                       axes.log_depth ? " -DVOXELS_LOG" : "");
  }

  PassKernels kernels;
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
  bool lookup_stale = true;   // it was placed since the uniform block was written
  size_t texture_bytes = 0;

 private:
  std::string defines_of(const ViewState& seen) const {
    std::string defines = lookup_defines(seen);
    if (kernels.lanes && seen.plan.settings[setting::portable]) defines += " -DPORTABLE";
    for (const char* define : light_table_defines(seen.plan)) defines += fmt::format(" -D{}", define);
    return defines;
  }
};

namespace {

size_t volume_bytes(const ViewState& seen) {
  const glm::uvec3 size = voxel_size(seen.plan.settings[setting::voxel_size]);
  return size_t(size.x) * size.y * size.z * 4 * size_t(seen.plan.settings[voxel_bits]) / 8;
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

void place(PassContext& work, VoxelBuffers& s, const TileDistances& distances) {
  auto pass = work.timer.pass("place_voxels", "cl");
  s.placed = place_voxels(work, s.axes, visible_box(work, distances));
  const int bits = work.plan.settings[voxel_bits];
  VoxelGrid& grid = s.placed.grid;
  grid.groups = s.lights.groups();
  grid.scale = stored_scale(s, bits);
  grid.largest = bits == 32 ? largest_float_voxel : largest_half_voxel;
  s.placed.lookup.inverse_scale = 1 / grid.scale;
  ClDevice& device = *work.renderer.cl;
  constexpr const char* what = "placing voxels";
  s.grid.put(device, what, std::vector<VoxelGrid>{grid});
  s.slices.put(device, what, s.placed.slices);
  s.lookup.put(device, what, std::vector<VoxelLookup>{s.placed.lookup});
  s.lookup_stale = true;
  pass.moves(distances.intervals.size() * sizeof(DepthInterval),
             s.grid.bytes() + s.slices.bytes() + s.lookup.bytes());
}

}  // namespace

VoxelVolume build_voxels(PassContext& work, Cached<VoxelBuffers>& cache, const TileDistances& distances,
                         const DepthBuffer& depth) {
  VoxelBuffers& s = cache.of(work);
  s.shaded_from = depth;
  NamedKernel& kernel = s.kernels.of("build_voxels");
  place(work, s, distances);
  const size_t bytes = volume_bytes(work);
  const BridgeKind bridge =
      work.plan.settings[setting::raster] == RasterApi::opencl ? BridgeKind::none : work.renderer.bridge;
  if (!s.irradiance) s.irradiance.emplace(*work.renderer.cl, bridge, bytes);
  if (!s.directions) s.directions.emplace(*work.renderer.cl, bridge, bytes);
  VoxelVolume volume{&*s.irradiance, &*s.directions, s.lookup.buffer(), s.lookup_defines(work), 2 * bytes};
  FilledWith needed{s.placed.grid, s.placed.slices, s.lights.version()};
  if (work.plan.settings[voxel_reuse] && s.filled && same(*s.filled, needed)) return volume;
  auto pass = work.timer.pass("build_voxels", "cl");
  const VoxelGrid& g = s.placed.grid;
  const cl::NDRange bricks(g.size_x / VOXEL_BRICK_X, g.size_y / VOXEL_BRICK_Y, g.size_z / VOXEL_BRICK_Z);
  const cl::NDRange items(g.size_x / VOXEL_GROUP_X * VOXEL_GROUP_ITEMS, g.size_y / VOXEL_GROUP_Y, g.size_z);
  kernel.launch(*work.renderer.cl, "build_voxels", s.kernels.lanes ? bricks : items,
                s.kernels.lanes ? cl::NDRange(1, 1, 1) : cl::NDRange(VOXEL_GROUP_ITEMS, 1, 1),
                {{"boxes", s.lights.boxes.buffer()},
                 {"places", s.lights.places.buffer()},
                 {"colors", s.lights.colors.buffer()},
                 {"cones", work.plan.lights.spots ? s.lights.cones.buffer() : cl::Buffer()},
                 {"grid", s.grid.buffer()},
                 {"slices", s.slices.buffer()},
                 {"irradiance", s.irradiance->cl_buffer()},
                 {"directions", s.directions->cl_buffer()}});
  s.filled = std::move(needed);
  s.texture_stale = true;
  pass.moves(s.lights.memory_bytes(), volume.bytes);
  return volume;
}

// Two 3D textures, interpolated between samples, and a uniform block; once a frame.
static void voxels_to_gl(PassContext& work, const VoxelVolume& volume, VoxelBuffers& s) {
  if (!s.lookup_stale) return;
  auto pass = work.timer.pass("voxels_to_gl", "gl");
  const VoxelGrid& g = s.placed.grid;
  const bool half = work.plan.settings[voxel_bits] == 16;
  if (!s.irradiance_texture) {
    const auto make_volume = [&] {
      return make_texture_3d(half ? GL_RGBA16F : GL_RGBA32F, int(g.size_x), int(g.size_y), int(g.size_z));
    };
    s.irradiance_texture = make_volume();
    s.directions_texture = make_volume();
    s.lookup_block = make_buffer(sizeof(VoxelLookup), nullptr, GL_DYNAMIC_STORAGE_BIT);
    s.texture_bytes = volume.bytes;
  }
  glNamedBufferSubData(s.lookup_block.name(), 0, sizeof(VoxelLookup), &s.placed.lookup);
  s.lookup_stale = false;
  if (!s.texture_stale) return;
  const SharedBuffer::Written written[] = {{volume.irradiance, volume.bytes / 2},
                                           {volume.directions, volume.bytes / 2}};
  SharedBuffer::hand_to_gl(written);
  const auto copy = [&](SharedBuffer& from, const GlTexture& to) {
    work.renderer.pixel_copies.to_texture(from.gl_buffer(), GL_RGBA, half ? GL_HALF_FLOAT : GL_FLOAT,
                                          {int(g.size_x), int(g.size_y)}, to.name(), int(g.size_z));
  };
  copy(*volume.irradiance, s.irradiance_texture);
  copy(*volume.directions, s.directions_texture);
  s.texture_stale = false;
  pass.moves(volume.bytes, volume.bytes);
}

// The lights of any of the eight samples around each pixel of the last frame.
static ListedLights listed_of_voxels(PassContext& work, Cached<VoxelBuffers>& cache) {
  const VoxelBuffers& s = cache.of(work);
  return list_voxels(work, {s.axes, s.placed, {}, {}}, s.shaded_from);
}

LightSource from_voxels(PassContext& work, Cached<VoxelBuffers>& cache, const VoxelVolume& volume,
                        const LightSource* grid) {
  const std::string exact = std::to_string(work.plan.settings[setting::voxel_lights_exact]);
  const auto in_gl = [&work, &cache, volume, exact, grid = grid ? std::optional(*grid) : std::nullopt] {
    VoxelBuffers& s = cache.of(work);
    voxels_to_gl(work, volume, s);
    GlLightLoop loop = light_loop(work);
    loop.defines.emplace_back("LIGHTS_VOXELS");
    if (s.axes.log_depth) loop.defines.emplace_back("VOXELS_LOG");
    loop.textures = {{Sampler::voxel_irradiance, s.irradiance_texture.name()},
                     {Sampler::voxel_directions, s.directions_texture.name()}};
    if (grid) {
      loop.defines.emplace_back("VOXEL_EXACT " + exact);
      for (const GlLightLoop::Binding& lists : grid->in_gl().textures) loop.textures.push_back(lists);
    }
    loop.blocks = {{UniformBlock::VoxelLookupBlock, s.lookup_block.name()}};
    return loop;
  };
  ClLightLoop in_cl = grid ? *grid->in_cl : ClLightLoop();
  in_cl.defines = " -DLIGHTS_VOXELS" + volume.kernel_defines + (grid ? " -DVOXEL_EXACT=" + exact : "");
  in_cl.more = {{"irradiance", volume.irradiance->cl_buffer()},
                {"directions", volume.directions->cl_buffer()},
                {"voxels", volume.lookup}};
  return LightSource(in_gl, in_cl, volume.bytes + (grid ? grid->bytes : 0),
                     [&work, &cache](auto&) { return listed_of_voxels(work, cache); });
}

ReadVoxels read_voxels(PassContext& work, Cached<VoxelBuffers>& cache) {
  VoxelBuffers& s = cache.of(work);
  ReadVoxels read{s.axes, s.placed, {}, {}};
  const size_t samples = size_t(s.placed.grid.size_x) * s.placed.grid.size_y * s.placed.grid.size_z;
  const auto values = [&](SharedBuffer& from) {
    std::vector<glm::vec4> all(samples);
    if (work.plan.settings[voxel_bits] == 32) {
      read_buffer(*work.renderer.cl, "reading voxels", from.cl_buffer(), all.data(), samples * sizeof all[0]);
    } else {
      std::vector<uint64_t> halves(samples);
      read_buffer(*work.renderer.cl, "reading voxels", from.cl_buffer(), halves.data(),
                  samples * sizeof halves[0]);
      for (size_t i = 0; i < samples; ++i) all[i] = glm::unpackHalf4x16(halves[i]);
    }
    for (glm::vec4& value : all) value *= s.placed.lookup.inverse_scale;
    return all;
  };
  read.irradiance = values(*s.irradiance);
  read.directions = values(*s.directions);
  return read;
}

}  // namespace lightgrid
