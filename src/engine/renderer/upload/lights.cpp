#include "renderer/upload/lights.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <span>

#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"
#include "plan/settings/model.h"
#include "renderer/pass_context.h"
#include "renderer/upload/culler_input.h"

namespace lightgrid {
namespace {

// A column's values, one per light of plan.lights.local.
struct LightColumn {
  bool needed = false;  // by the plan; no values if not
  Sampler sampler{};    // of its buffer texture
  GLenum format = 0;    // of a texel
  std::vector<std::byte> values;
};

struct LightTable {
  std::array<LightColumn, light_column_count> columns;  // in the order of LIGHT_TABLE
  // Beside the table, two a directional light: direction to the light in view space, and illuminance.
  std::vector<glm::vec4> directional;
};

constexpr double max_float = std::numeric_limits<float>::max();

// The columns' values for one light, by the names of LIGHT_TABLE.

glm::vec4 position(const ViewLight& light) {
  // A light without a range gets a range of 7e18 m. Past it the squared distance overflows float, and the
  // window is 0 instead of infinity times 0.
  const double inverse_radius_squared = std::clamp(1.0 / (light.radius_m * light.radius_m), 2e-38, 3e38);
  return {glm::vec3(glm::clamp(light.position, -max_float, max_float)), float(inverse_radius_squared)};
}

glm::vec4 color(const ViewLight& light) {
  // A light of radius 0 lights nothing, not even its own position.
  return {light.radius_m > 0 ? glm::vec3(light.radiant_intensity) : glm::vec3(0),
          float(std::min(light.min_falloff, max_float))};
}

glm::vec4 cone(const ViewLight& light) {
  if (!has_cone(light)) return {0, 0, 0, 1};
  // KHR_lights_punctual: clamp((cos(angle) - cos(outer)) / (cos(inner) - cos(outer)), 0, 1), as a product and
  // a sum.
  const double scale = 1.0 / (light.cos_inner - light.cos_outer);
  return {glm::vec3(light.direction * scale), float(-light.cos_outer * scale)};
}

float max_falloff(const ViewLight& light) { return float(light.max_falloff); }

// The conditions of LIGHT_TABLE.
constexpr auto IF_LIGHTS = [](const FramePlan& plan) { return plan.lights.any_local; };
constexpr auto IF_SPOTS = [](const FramePlan& plan) { return plan.lights.spots; };
constexpr auto IF_VIRTUAL = [](const FramePlan& plan) { return plan.lights.any_virtual; };

constexpr GLenum format_of(const glm::vec4&) { return GL_RGBA32F; }
constexpr GLenum format_of(float) { return GL_R32F; }

template <typename T>
LightColumn column(T (*value)(const ViewLight&), bool needed, Sampler sampler,
                   std::span<const ViewLight> lights, const std::vector<int>& local) {
  LightColumn made{needed, sampler, format_of(T()), {}};
  if (!needed) return made;
  made.values.resize(local.size() * sizeof(T));
  for (size_t i = 0; i < local.size(); ++i) {
    const T of_light = value(lights[size_t(local[i])]);
    std::memcpy(made.values.data() + i * sizeof(T), &of_light, sizeof(T));
  }
  return made;
}

LightTable light_table(const FramePlan& plan, std::span<const ViewLight> lights) {
#define LIGHT_COLUMN(condition, type, member, array, texels) \
  column(member, (condition)(plan), Sampler::array, lights, plan.lights.local),
  LightTable table{{LIGHT_TABLE(LIGHT_COLUMN)}, {}};
#undef LIGHT_COLUMN
  for (int i : plan.lights.directional) {
    table.directional.emplace_back(glm::vec3(-lights[i].direction), 0);
    table.directional.emplace_back(glm::vec3(lights[i].radiant_intensity), 0);
  }
  return table;
}

// The uniform block: arrays of std140, in which each value takes the place of four floats.
std::vector<glm::vec4> block_of(const LightTable& table, size_t lights) {
  std::vector<glm::vec4> block(light_column_count * LIGHTS_OF_BLOCK);
  for (size_t c = 0; c < light_column_count; ++c) {
    const std::vector<std::byte>& values = table.columns[c].values;
    const size_t size = lights > 0 ? values.size() / lights : 0;
    for (size_t i = 0; i < std::min<size_t>(lights, LIGHTS_OF_BLOCK); ++i)
      std::memcpy(&block[c * LIGHTS_OF_BLOCK + i], values.data() + i * size, size);
  }
  return block;
}

LightTable light_table(const ViewState& seen) {
  return light_table(seen.plan, lights_in_view(seen.scene, seen.view, ranges_of(seen.plan.settings)));
}

}  // namespace

std::vector<const char*> light_table_defines(const FramePlan& plan) {
  std::vector<const char*> defines;
  if (plan.lights.in_block) defines.push_back("LIGHTS_IN_BLOCK");
  if (plan.lights.spots) defines.push_back("SPOTS");
  if (plan.lights.any_virtual) defines.push_back("VIRTUAL_LIGHTS");
  const LightRanges ranges = ranges_of(plan.settings);
  if (window_of(ranges) == RangeWindow::smooth) defines.push_back("WINDOW_SMOOTH");
  if (window_of(ranges) == RangeWindow::none) defines.push_back("WINDOW_NONE");
  if (ranges.range == LightRange::stochastic) defines.push_back("LEAST_FALLOFF");
  return defines;
}

std::vector<std::string> reach_defines(const FramePlan& plan) {
  const std::vector<const char*> shadows = shadow_defines(plan);
  std::vector<std::string> defines(shadows.begin(), shadows.end());
  for (const Effect* effect : plan.effects) {
    if (effect->reach || effect->lit) defines.push_back(define_of(*effect));
  }
  return defines;
}

std::vector<const char*> shadow_defines(const FramePlan& plan) {
  std::vector<const char*> defines;
  if (plan.shadows.light_reaches) defines.push_back("SHADOWS");
  if (plan.shadows.directional) defines.push_back("DIRECTIONAL_SHADOWS");
  if (plan.shadows.light_reaches && plan.shadows.bytes) defines.push_back("SHADOW_BYTES");
  return defines;
}

bool GlLights::Sized::put(size_t size, const void* data) {
  if (buffer && bytes == size) {
    if (size > 0) glNamedBufferSubData(buffer.name(), 0, GLsizeiptr(size), data);
    return false;
  }
  buffer = make_buffer(size, data, GL_DYNAMIC_STORAGE_BIT);
  bytes = size;
  return true;
}

void GlLights::upload(const ViewState& seen) {
  const FramePlan& plan = seen.plan;
  view_block_.put(sizeof seen.params, &seen.params);
  const CullView culled = cull_view(seen.view, plan);
  const auto put_keys = [](Sized& block, bool needed, std::span<const float> keys) {
    if (!needed) {
      block = {};
      return;
    }
    std::vector<glm::vec4> values;  // a block of shared/slices.h: std140 pads each float to a vec4
    for (const float key : keys) values.emplace_back(key, 0, 0, 0);
    block.put(values.size() * sizeof values[0], values.data());
  };
  put_keys(slice_block_, plan.lists.light_grid && plan.lists.slices > 1, slice_keys(culled));
  put_keys(z_bin_block_, plan.lists.z_bins > 1, z_bin_keys(culled));
  const LightTable table = light_table(seen);
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
    put_lights(lights_[i], column.needed && !plan.lights.in_block, column.sampler, column.format,
               column.values);
  }
  if (plan.lights.in_block) {
    const std::vector<glm::vec4> block = block_of(table, plan.lights.local.size());
    lights_block_.put(block.size() * sizeof block[0], block.data());
    light_bytes_ += lights_block_.bytes;
  }
  put_lights(lights_[light_column_count], plan.lights.any_directional, Sampler::directional_lights,
             GL_RGBA32F, table.directional);
}

void GlLights::bind() const {
  bind_block(UniformBlock::ViewParamsBlock, view_block_.buffer.name());
  if (slice_block_.buffer) bind_block(UniformBlock::SliceEdgesBlock, slice_block_.buffer.name());
  if (z_bin_block_.buffer) bind_block(UniformBlock::ZBinEdgesBlock, z_bin_block_.buffer.name());
  if (lights_block_.buffer) bind_block(UniformBlock::LightsBlock, lights_block_.buffer.name());
  for (const Lights& lights : lights_) {
    if (lights.texture) bind_texture(lights.sampler, lights.texture.name());
  }
}

static constexpr const char* what = "uploading lights";

static void put(UploadedBuffer (&columns)[light_column_count], ClDevice& device, const LightTable& table) {
  for (size_t i = 0; i < light_column_count; ++i) {
    // A column that no kernel of this view has read yet stays a null argument.
    const LightColumn& column = table.columns[i];
    if (column.needed || columns[i].bytes() > 0) columns[i].put(device, what, column.values);
  }
}

void ClLightColumns::upload(ClDevice& device, const FramePlan& plan, std::span<const ViewLight> lights) {
  put(columns_, device, light_table(plan, lights));
}

void ClLights::upload(ClDevice& device, const ViewState& seen) {
  const LightTable table = light_table(seen);
  put(columns_, device, table);
  directional.put(device, what, table.directional);
  view.put(device, what, std::vector<ViewParams>{seen.params});
  const auto put_edges = [&](UploadedBuffer& to, int count, const auto& keys_of) {
    std::vector<float> edges;
    if (count > 1) {
      const auto keys = keys_of(cull_view(seen.view, seen.plan));
      edges.assign(keys.begin(), keys.end());
    }
    to.put(device, what, edges);
  };
  put_edges(bin_edges, seen.plan.lists.z_bins, z_bin_keys);
  put_edges(slice_edges, seen.plan.lists.slices, slice_keys);
}

size_t ClLightColumns::memory_bytes() const {
  size_t bytes = 0;
  for (const UploadedBuffer& column : columns_) bytes += column.bytes();
  return bytes;
}

size_t ClLights::memory_bytes() const {
  return ClLightColumns::memory_bytes() + directional.bytes() + view.bytes() + bin_edges.bytes() +
         slice_edges.bytes();
}

ClArguments ClLightColumns::columns() const {
  ClArguments arguments;
#define LIGHT_NAMED(condition, type, member, array, texels) \
  arguments.emplace_back(#array, columns_[arguments.size()].buffer());
  LIGHT_TABLE(LIGHT_NAMED)
#undef LIGHT_NAMED
  return arguments;
}

void ShadowMemory::bind() const {
  if (tiles.texture) bind_texture(Sampler::shadow_tiles, tiles.texture.name());
  if (bits.texture) bind_texture(Sampler::shadow_bits, bits.texture.name());
  if (layers.texture) bind_texture(Sampler::shadow_layers, layers.texture.name());
}

ClArguments ShadowMemory::arguments() {
  return {{"shadow_tiles", tiles.buffer ? tiles.buffer->cl_buffer() : cl::Buffer()},
          {"shadow_bits", bits.buffer ? bits.buffer->cl_buffer() : cl::Buffer()}};
}

std::string light_defines(const ViewState& seen, bool lanes, Brdf brdf) {
  std::string defines;
  if (lanes) defines += fmt::format(" -DTILE={}", seen.plan.settings[setting::tile]);
  if (lanes && seen.plan.settings[setting::portable]) defines += " -DPORTABLE";
  if (seen.plan.lights.index_bits == 32) defines += " -DINDEX_32";
  if (seen.plan.lists.z_bins > 1) defines += " -DZ_BINS";
  for (const char* define : light_table_defines(seen.plan)) defines += fmt::format(" -D{}", define);
  for (const std::string& define : reach_defines(seen.plan)) defines += fmt::format(" -D{}", define);
  if (brdf == Brdf::blinn) defines += " -DBLINN";
  if (brdf == Brdf::lambert) defines += " -DLAMBERT";
  if (seen.view.orthographic) defines += " -DORTHOGRAPHIC";
  return defines;
}

}  // namespace lightgrid
