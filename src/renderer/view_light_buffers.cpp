#include "renderer/view_light_buffers.h"

#include <span>

#include "gl/bindings.h"
#include "renderer/culler_input.h"

namespace lightgrid {
namespace {

// A uniform block of shared/slices.h: std140 pads each float to a vec4.
std::vector<glm::vec4> block_of_keys(std::span<const float> keys) {
  std::vector<glm::vec4> block;
  for (const float key : keys) block.emplace_back(key, 0, 0, 0);
  return block;
}

}  // namespace

bool ViewLightBuffers::Sized::put(size_t size, const void* data) {
  if (buffer && bytes == size) {
    if (size > 0) glNamedBufferSubData(buffer.name(), 0, GLsizeiptr(size), data);
    return false;
  }
  buffer = make_buffer(size, data, GL_DYNAMIC_STORAGE_BIT);
  bytes = size;
  return true;
}

void ViewLightBuffers::update(const Scene& scene, const View& view, const FramePlan& plan,
                              const ViewParams& params) {
  view_block_.put(sizeof params, &params);
  const CullView culled = cull_view(view, plan);
  const auto put_keys = [](Sized& block, bool needed, std::span<const float> keys) {
    if (!needed) {
      block = {};
      return;
    }
    const std::vector<glm::vec4> values = block_of_keys(keys);
    block.put(values.size() * sizeof values[0], values.data());
  };
  put_keys(slice_block_, plan.light_grid && plan.slices > 1, slice_keys(culled));
  put_keys(z_bin_block_, plan.z_bins > 1, z_bin_keys(culled));
  const LightTexels texels = light_texels(scene, view, plan);
  const std::vector<glm::vec4>* arrays[4] = {&texels.positions, &texels.colors, &texels.cones,
                                             &texels.directional};
  const bool needed[4] = {plan.local_lights, plan.local_lights, plan.spots, plan.directional};
  light_bytes_ = 0;
  for (int i = 0; i < 4; ++i) {
    if (!needed[i]) {
      light_textures_[i] = {};
      light_buffers_[i] = {};
      continue;
    }
    const size_t bytes = arrays[i]->size() * sizeof(glm::vec4);
    if (light_buffers_[i].put(bytes, arrays[i]->data())) {
      light_textures_[i] = make_buffer_texture(GL_RGBA32F, light_buffers_[i].buffer.name());
    }
    light_bytes_ += bytes;
  }
}

void ViewLightBuffers::bind() const {
  constexpr Sampler samplers[4] = {Sampler::light_positions, Sampler::light_colors, Sampler::light_cones,
                                   Sampler::directional_lights};
  bind_block(UniformBlock::ViewParamsBlock, view_block_.buffer.name());
  if (slice_block_.buffer) bind_block(UniformBlock::SliceEdgesBlock, slice_block_.buffer.name());
  if (z_bin_block_.buffer) bind_block(UniformBlock::ZBinEdgesBlock, z_bin_block_.buffer.name());
  for (int i = 0; i < 4; ++i) {
    if (light_textures_[i]) bind_texture(samplers[i], light_textures_[i].name());
  }
}

}  // namespace lightgrid
