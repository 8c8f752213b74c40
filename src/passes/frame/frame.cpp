#include "passes/frame/frame.h"

#include <cmath>

#include "base/error.h"
#include "cl/transfer.h"
#include "passes/frame/light_texels.h"

namespace lightgrid {
namespace {

cl::Buffer& grown(Devices& devices, SharedTexture& shared, size_t bytes, GLenum format) {
  if (!shared.buffer || shared.buffer->size() < bytes) {
    GLint texels = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
    const size_t texel_bytes = format == GL_RG32UI ? 8 : format == GL_R32UI ? 4 : 2;
    if (bytes / texel_bytes > size_t(texels)) {
      throw machine_error("light grid: {} bytes are more than the {} texels that a buffer texture may have in this OpenGL; use "
                          "larger tiles, fewer slices or fewer lights", bytes, texels);
    }
    shared.texture = GlTexture();
    shared.buffer.reset();  // first, so that both need not fit at once
    shared.buffer.emplace(*devices.cl, devices.bridge, bytes);
    shared.texture = make_buffer_texture(format, shared.buffer->gl_buffer());
  }
  return shared.buffer->cl_buffer();
}

// A uniform block of shared/slices.h: std140 gives each float a vec4's room.
GlBuffer block_of_keys(std::span<const float> keys) {
  std::vector<glm::vec4> block;
  for (const float key : keys) block.emplace_back(key, 0, 0, 0);
  return make_buffer(block.size() * sizeof block[0], block.data());
}

FramePlan tuned_plan(FramePlan plan, const TunedSizes& tuned) {
  plan.settings = with_tuned(std::move(plan.settings), tuned);
  return plan;
}

ViewParams params_of(const View& view, const FramePlan& plan, const glm::vec3& ambient) {
  ViewParams p = view_params(cull_view(view), plan.settings.tile);
  p.light_count = uint(plan.local.size()), p.directional_count = uint(plan.directional_lights.size());
  p.ambient_r = ambient.r, p.ambient_g = ambient.g, p.ambient_b = ambient.b;
  return p;
}

}  // namespace

CullView cull_view(const View& view) {
  return {view.width, view.height, view.clip_from_view, view.view_from_world, view.eye, {}, {}};
}

CullView cull_view(const View& view, const FramePlan& plan) {
  CullView culled = cull_view(view);
  culled.slice_edges = slice_edges(plan.settings.slice_spacing, plan.slices, plan.slice_near_m, plan.slice_far_m);
  culled.z_bin_edges = slice_edges(plan.settings.slice_spacing, plan.z_bins, plan.slice_near_m, plan.slice_far_m);
  return culled;
}

std::vector<CullLight> cull_lights_of(const Scene& scene, std::span<const int> indices) {
  std::vector<CullLight> lights;
  for (int i : indices) {
    const Light& light = scene.lights[i];
    lights.push_back({light.position, light.radius_m, glm::normalize(glm::dvec3(light.direction)),
                      light.type == LightType::spot ? std::cos(double(light.outer_cone_rad)) : -1.0});
  }
  return lights;
}

Devices open_devices(const std::string& cl_substring, GlBackend backend) {
  Devices devices;
  devices.gl = GlContext::create(backend);
  devices.cl = std::make_unique<ClDevice>(cl_substring);
  devices.programs = std::make_unique<ProgramCache>(*devices.cl);
  devices.bridge = choose_bridge(*devices.cl, *devices.gl);
  devices.tuned = read_tuned_sizes(devices.cl->info());
  return devices;
}

cl::Buffer& SharedGridStorage::cells(size_t bytes) { return grown(devices_, cells_, bytes, GL_RG32UI); }

cl::Buffer& SharedGridStorage::indices(size_t bytes) {
  return grown(devices_, indices_, bytes, index_bits_ == 16 ? GL_R16UI : GL_R32UI);
}

cl::Buffer& SharedGridStorage::masks(size_t bytes) { return grown(devices_, masks_, bytes, GL_R32UI); }

cl::Buffer& SharedGridStorage::z_bins(size_t bytes) { return grown(devices_, z_bins_, bytes, GL_R32UI); }

size_t SharedGridStorage::allocated_bytes() const {
  size_t bytes = 0;
  for (const SharedTexture* shared : {&cells_, &indices_, &masks_, &z_bins_}) bytes += shared->buffer ? shared->buffer->size() : 0;
  return bytes;
}

Frame::Frame(Devices& devices, const Scene& scene, const View& view, FramePlan plan_of_frame)
    : devices(devices),
      scene(scene),
      view(view),
      plan(tuned_plan(std::move(plan_of_frame), devices.tuned)),
      gpu(scene, plan, devices.gl->software),
      params(params_of(view, plan, scene.ambient)),
      timer([this](const std::string& on) {
        if (on == "cl") {
          finish_queue(*this->devices.cl, "timing a pass");
        } else {
          glFinish();
        }
      }),
      targets(view.width, view.height, plan.stencil) {
  view_block_ = make_buffer(sizeof params, &params);
  const CullView culled = cull_view(view, plan);
  if (plan.light_grid && plan.slices > 1) slice_block_ = block_of_keys(slice_keys(culled));
  if (plan.z_bins > 1) z_bin_block_ = block_of_keys(z_bin_keys(culled));
  const LightTexels texels = light_texels(scene, view, plan);
  const std::vector<glm::vec4>* arrays[4] = {&texels.places, &texels.colors, &texels.cones,
                                             &texels.directional};
  const bool needed[4] = {plan.local_lights, plan.local_lights, plan.spots, plan.directional};
  for (int i = 0; i < 4; ++i) {
    if (!needed[i]) continue;
    const size_t bytes = arrays[i]->size() * sizeof(glm::vec4);
    light_buffers_[i] = make_buffer(bytes, arrays[i]->data());
    light_textures_[i] = make_buffer_texture(GL_RGBA32F, light_buffers_[i].name());
    light_bytes_ += bytes;
  }
}

const GlProgram& Frame::program(const std::string& vertex, const std::string& fragment,
                                std::vector<std::string> defines) {
  if (view.orthographic) defines.emplace_back("ORTHOGRAPHIC");
  if (plan.settings.everything_on) defines.emplace_back("EVERYTHING_ON");
  std::string key = vertex + " " + fragment;
  for (const std::string& name : defines) key += " " + name;
  const auto found = programs_.find(key);
  if (found != programs_.end()) return found->second;
  return programs_.try_emplace(key, vertex, fragment, defines).first->second;
}

GLuint Frame::color_framebuffer() {
  return targets.framebuffer({targets.texture("color", GL_RGBA32F)}, targets.depth());
}

SharedBuffer& Frame::depth_copy() {
  if (!depth_copy_) depth_copy_.emplace(*devices.cl, devices.bridge, (size_t(view.width) * view.height + spare_pixels) * 4);
  return *depth_copy_;
}

void Frame::bind_lights() const {
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, view_block_.name());
  if (slice_block_) glBindBufferBase(GL_UNIFORM_BUFFER, 2, slice_block_.name());
  if (z_bin_block_) glBindBufferBase(GL_UNIFORM_BUFFER, 3, z_bin_block_.name());
  for (int i = 0; i < 4; ++i) {
    if (light_textures_[i]) glBindTextureUnit(8 + i, light_textures_[i].name());
  }
}

LightCuller& Frame::culler() {
  if (!culler_) {
    CullerOptions options;
    options.cull_test = plan.settings.cull_test;
    options.depth_bounds = plan.settings.depth_bounds;
    options.shape = plan.settings.kernel_shape;
    options.tile = plan.settings.tile;
    options.portable = plan.settings.portable;
    options.group_size = plan.settings.group_size;
    options.blend = plan.blend_grid;
    options.lists = plan.settings.grid_lists;
    options.index_bits = plan.index_bits;
    culler_.emplace(*devices.cl, *devices.programs, options);
    if (plan.light_grid) {
      culler_->set_lights(cull_lights_of(scene, plan.local));
    }
    culler_->set_view(cull_view(view, plan));
  }
  return *culler_;
}

SharedGridStorage& Frame::opaque_grid() {
  if (!grids_[0]) grids_[0].emplace(devices, plan.index_bits);
  return *grids_[0];
}

SharedGridStorage& Frame::blend_grid() {
  if (!grids_[1]) grids_[1].emplace(devices, plan.index_bits);
  return *grids_[1];
}

size_t Frame::light_grid_bytes() const {
  size_t bytes = targets.bytes(TargetUse::light_index);
  for (const LightGrid* grid : {&opaque_grid_last, &blend_grid_last}) {
    bytes += grid->cell_bytes + grid->index_bytes + grid->mask_bytes + grid->z_bin_bytes;
  }
  return bytes;
}

size_t Frame::memory_bytes() const {
  size_t bytes = gpu.geometry_bytes() + gpu.reversed_triangle_bytes() + gpu.texture_bytes() + targets.bytes() + light_bytes_;
  for (const auto& [type, kept] : kept_) bytes += kept->memory_bytes();
  for (const auto& grid : grids_) bytes += grid ? grid->allocated_bytes() : 0;
  if (depth_copy_) bytes += depth_copy_->size();
  if (culler_) bytes += culler_->memory_bytes();
  return bytes;
}

}  // namespace lightgrid
