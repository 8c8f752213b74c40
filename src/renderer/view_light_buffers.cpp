#include "renderer/view_light_buffers.h"

#include <span>

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
  const LightTable table = light_table(scene, view, plan);
  light_bytes_ = 0;
  const auto put_lights = [&](Lights& lights, bool needed, Sampler sampler, GLenum format,
                              const auto& values) {
    if (!needed) {
      lights = {};
      return;
    }
    const size_t bytes = values.size() * sizeof values[0];
    lights.sampler = sampler;
    if (lights.buffer.put(bytes, values.data()))
      lights.texture = make_buffer_texture(format, lights.buffer.buffer.name());
    light_bytes_ += bytes;
  };
  for (size_t i = 0; i < light_column_count; ++i) {
    const LightColumn& column = table.columns[i];
    put_lights(lights_[i], column.needed, column.sampler, column.format, column.values);
  }
  put_lights(lights_[light_column_count], plan.directional, Sampler::directional_lights, GL_RGBA32F,
             table.directional);
}

void ViewLightBuffers::bind() const {
  bind_block(UniformBlock::ViewParamsBlock, view_block_.buffer.name());
  if (slice_block_.buffer) bind_block(UniformBlock::SliceEdgesBlock, slice_block_.buffer.name());
  if (z_bin_block_.buffer) bind_block(UniformBlock::ZBinEdgesBlock, z_bin_block_.buffer.name());
  for (const Lights& lights : lights_) {
    if (lights.texture) bind_texture(lights.sampler, lights.texture.name());
  }
}

}  // namespace lightgrid
