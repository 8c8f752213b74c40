#include "renderer/render_view.h"

#include <fmt/format.h>

#include "cl/transfer.h"
#include "plan/settings.h"

namespace lightgrid {
namespace {

PassTimer::Clock clock_of(Renderer& renderer) {
  PassTimer::Clock clock;
  clock.start = [&renderer](const std::string& on) {
    if (on == "cl") renderer.cl->profiler().time_launches(true);
  };
  clock.stop = [&renderer](const std::string& on) {
    std::vector<KernelTime> kernels;
    if (on != "cl") {
      glFinish();
      return kernels;
    }
    finish_queue(*renderer.cl, "timing a pass");
    ClProfiler& profiler = renderer.cl->profiler();
    for (const ClProfiler::Row& row : profiler.collect()) kernels.push_back({row.label, row.ms});
    profiler.time_launches(false);
    return kernels;
  };
  return clock;
}

ViewParams params_of(const View& view, const FramePlan& plan, const glm::vec3& ambient) {
  ViewParams p = view_params(cull_view(view), plan.settings.tile);
  p.light_count = uint(plan.local.size());
  p.directional_count = uint(plan.directional_lights.size());
  p.ambient_r = ambient.r;
  p.ambient_g = ambient.g;
  p.ambient_b = ambient.b;
  return p;
}

bool same_culler(const FramePlan& a, const FramePlan& b) {
  return a.blend_grid == b.blend_grid && a.index_bits == b.index_bits && a.light_grid == b.light_grid;
}

}  // namespace

RenderView::RenderView(Renderer& renderer, GpuScene& gpu, const View& view, const Settings& settings,
                       const TechniqueNeeds& needs, std::shared_ptr<TargetPool> pool)
    : renderer(renderer),
      gpu(gpu),
      scene(gpu.scene()),
      view(view),
      plan(plan_frame(scene, view, with_tuned(settings, renderer.tuned), needs)),
      params(params_of(view, plan, scene.ambient)),
      timer(clock_of(renderer)),
      targets(pool ? pool : std::make_shared<TargetPool>(), view.width, view.height, plan.stencil),
      settings_(with_tuned(settings, renderer.tuned)),
      needs_(needs),
      opengl_(draws_with_opengl(needs, settings)),
      shared_pool_(std::move(pool)) {
  if (opengl_) renderer.require_gl();
  if (opengl_ && plan.reversed_triangles) gpu.in_gl().add_reversed_triangles();
  follow_view();
}

void RenderView::look(const View& next) { look(next, PlannedInstances::in_view); }

void RenderView::look(const View& next, PlannedInstances instances) {
  const bool resized = next.width != view.width || next.height != view.height;
  const FramePlan before = std::move(plan);
  if (next.orthographic != view.orthographic) programs_.clear();
  view = next;
  plan = plan_frame(scene, view, settings_, needs_, instances);
  params = params_of(view, plan, scene.ambient);
  if (resized || plan.stencil != before.stencil) {
    const auto pool = shared_pool_ ? shared_pool_ : std::make_shared<TargetPool>();
    targets = Targets(pool, view.width, view.height, plan.stencil);
    states_.clear();
  }
  follow_view();
  follow_plan(before);
}

void RenderView::prepare(const std::function<void()>& draw) {
  const View here = view;
  preparing_ = true;
  try {
    const auto draw_planned = [&](PlannedInstances instances) {
      look(here, instances);
      draw();
    };
    draw_planned(PlannedInstances::every);
    const bool coats = plan.clearcoat;
    draw_planned(PlannedInstances::plain);
    for (const PlannedInstances instances : {PlannedInstances::plain_or_coated, PlannedInstances::uncoated}) {
      if (coats) draw_planned(instances);
    }
  } catch (...) {
    preparing_ = false;
    throw;
  }
  preparing_ = false;
  drop_states();
  look(here);
}

void RenderView::release() {
  drop_states();
  targets.clear();
}

void RenderView::drop_states() {
  states_.clear();
  cl_lights_.reset();
  culler_.reset();
  for (auto& grid : grids_) grid.reset();
}

void RenderView::lights_changed() {
  if (culler_ && plan.light_grid)
    culler_->set_lights(cull_lights_of(scene, plan.local, plan.settings.ranges));
}

void RenderView::draw_ranges(uint32_t seed) {
  settings_.ranges.seed = seed;
  look(view);
  lights_changed();
}

void RenderView::follow_view() {
  transforms.resize(scene.instances.size());
  for (const auto* instances : {&plan.opaque, &plan.blended}) {
    for (const int i : *instances) transforms[i] = instance_transform(view, scene.instances[i]);
  }
  cl_lights_stale_ = true;
  if (!opengl_) return;
  lights.update(scene, view, plan, params);
  if (preparing_) {
    opaque.clear(), blended.clear();
    return;
  }
  const GlScene& in_gl = gpu.in_gl();
  opaque = make_draw_list(in_gl, view, plan.opaque, transforms, plan.slice_far_m, DrawOrder::front_to_back);
  blended = make_draw_list(in_gl, view, plan.blended, transforms, plan.slice_far_m, DrawOrder::as_given);
}

// Keeps resources that still fit; drops the others, to be created again at their next use.
void RenderView::follow_plan(const FramePlan& before) {
  if (!same_culler(before, plan)) culler_.reset();
  if (before.index_bits != plan.index_bits) {
    for (auto& grid : grids_) grid.reset();
  }
  if (!plan.blend_grid) grids_[1].reset();
  if (culler_) culler_->set_view(cull_view(view, plan));
  std::erase_if(states_, [&](const auto& entry) { return !entry.second->follow(*this); });
}

std::vector<std::string> RenderView::view_defines(std::vector<std::string> defines) const {
  if (view.orthographic) defines.emplace_back("ORTHOGRAPHIC");
  if (plan.settings.everything_on) defines.emplace_back("EVERYTHING_ON");
  return defines;
}

ScenePrograms& RenderView::programs(SurfaceShaders shaders) {
  std::string key = fmt::format("{} {}", shaders.vertex, shaders.fragment);
  for (const std::string& name : shaders.defines) key += " " + name;
  auto found = programs_.find(key);
  if (found == programs_.end()) {
    shaders.defines = view_defines(std::move(shaders.defines));
    found = programs_.try_emplace(key, renderer, shaders).first;
  }
  if (preparing_) {
    for (const int i : shaders.blended ? plan.blended : plan.opaque)
      found->second.of(plan.features_of_instance[i]);
  }
  return found->second;
}

const GlProgram& RenderView::program(const std::string& vertex, const std::string& fragment,
                                     std::vector<std::string> defines) {
  return renderer.program(vertex, fragment, view_defines(std::move(defines)));
}

GLuint RenderView::color_framebuffer() {
  return targets.framebuffer({targets.texture("color", GL_RGBA32F)}, targets.depth());
}

SharedBuffer& RenderView::shared_pixels(const std::string& name, size_t pixel_bytes, TargetUse use) {
  return targets.buffer(*renderer.cl, renderer.bridge, name, (pixels() + spare_pixels) * pixel_bytes, use);
}

void RenderView::upload_states() {
  for (auto& [type, state] : states_) state->upload(*this);
}

const ClLights& RenderView::cl_lights() {
  if (!cl_lights_) cl_lights_stale_ = true, cl_lights_.emplace();
  if (cl_lights_stale_) cl_lights_->upload(*renderer.cl, scene, view, plan, params);
  cl_lights_stale_ = false;
  return *cl_lights_;
}

LightCuller& RenderView::culler() {
  if (!culler_) {
    culler_.emplace(*renderer.cl, *renderer.kernels, culler_options(plan));
    lights_changed();
    culler_->set_view(cull_view(view, plan));
  }
  return *culler_;
}

SharedGridStorage& RenderView::opaque_grid() {
  if (!grids_[0]) grids_[0].emplace(renderer, plan.index_bits);
  return *grids_[0];
}

SharedGridStorage& RenderView::blend_grid() {
  if (!grids_[1]) grids_[1].emplace(renderer, plan.index_bits);
  return *grids_[1];
}

size_t RenderView::memory_bytes() const {
  size_t bytes = targets.bytes() + lights.light_bytes() + (cl_lights_ ? cl_lights_->memory_bytes() : 0);
  if (opengl_) bytes += gpu.in_gl().geometry_bytes() + gpu.in_gl().texture_bytes();
  if (opengl_ && plan.reversed_triangles) bytes += gpu.in_gl().reversed_triangle_bytes();
  for (const auto& [type, state] : states_) bytes += state->memory_bytes();
  for (const auto& grid : grids_) bytes += grid ? grid->allocated_bytes() : 0;
  if (culler_) bytes += culler_->memory_bytes();
  return bytes;
}

}  // namespace lightgrid
