#include "renderer/render_view.h"

#include <algorithm>

#include "gl/objects.h"
#include "plan/settings.h"
#include "plan/settings/grid.h"
#include "plan/settings/model.h"

namespace lightgrid {
namespace {

ViewParams params_of(const View& view, const FramePlan& plan, const glm::vec3& ambient) {
  ViewParams p = view_params(cull_view(view), plan.settings[setting::tile]);
  p.light_count = uint(plan.lights.local.size());
  p.directional_count = uint(plan.lights.directional.size());
  p.ambient_r = ambient.r;
  p.ambient_g = ambient.g;
  p.ambient_b = ambient.b;
  return p;
}

bool same_culler(const FramePlan& a, const FramePlan& b) {
  return a.lists.blend_grid == b.lists.blend_grid && a.lights.index_bits == b.lights.index_bits &&
         a.lists.light_grid == b.lists.light_grid;
}

TechniqueNeeds with_opengl_samples(TechniqueNeeds needs, const Renderer& renderer, const Scene& scene) {
  if (scene.samples > 1 && renderer.gl) needs.samples.opengl = has_samples(scene.samples);
  return needs;
}

ViewState seen_by(const View& view, const Scene& scene, const Settings& settings,
                  const TechniqueNeeds& needs) {
  FramePlan plan = plan_frame(scene, view, settings, needs);
  const ViewParams params = params_of(view, plan, scene.ambient);
  return {scene, view, std::move(plan), params, {}, {}, {}};
}

}  // namespace

RenderView::RenderView(Renderer& renderer, GpuScene& gpu, const View& view, const Settings& settings,
                       const TechniqueNeeds& needs, std::shared_ptr<TargetPool> pool)
    : PassContext(seen_by(view, gpu.scene(), with_tuned(settings, renderer.tuned),
                          with_opengl_samples(needs, renderer, gpu.scene())),
                  renderer, gpu, pool ? pool : std::make_shared<TargetPool>()),
      settings_(with_tuned(settings, renderer.tuned)),
      needs_(with_opengl_samples(needs, renderer, gpu.scene())),
      shared_pool_(std::move(pool)) {
  if (plan.opengl) renderer.require_gl();
  if (plan.opengl && plan.reversed_triangles) gpu.in_gl().add_reversed_triangles();
  follow_view();
}

void RenderView::look(const View& next) { look(next, PlannedInstances::in_view, PlannedLights::in_view); }

void RenderView::look(const View& next, PlannedInstances instances, PlannedLights lights) {
  const bool resized = next.grid() != view.grid();
  const FramePlan before = std::move(plan);
  if (next.orthographic != view.orthographic) programs_.clear();
  view = next;
  plan = plan_frame(scene, view, settings_, needs_, instances, lights);
  params = params_of(view, plan, scene.ambient);
  if (resized || plan.stencil != before.stencil) {
    const auto pool = shared_pool_ ? shared_pool_ : std::make_shared<TargetPool>();
    targets = Targets(pool, grid(), plan.stencil);
    caches.clear();
  }
  follow_view();
  follow_plan(before);
}

// The kinds of lights that a scene has.
static std::vector<PlannedLights> kinds_of_lights(const FramePlan& plan, const Scene& scene) {
  if (!plan.lights.any_local) return {PlannedLights::every};
  const bool points = std::ranges::any_of(
      scene.lights, [](const Light& light) { return !is_directional(light) && !has_cone(light); });
  if (!points || !plan.lights.spots) return {PlannedLights::every, PlannedLights::none};
  return {PlannedLights::every, PlannedLights::points, PlannedLights::spots, PlannedLights::none};
}

void RenderView::prepare(const std::function<void()>& draw) {
  const View here = view;
  preparing_ = true;
  try {
    const auto draw_planned = [&](PlannedInstances instances) {
      for (const PlannedLights lights : kinds_of_lights(plan, scene)) {
        look(here, instances, lights);
        draw();
      }
    };
    draw_planned(PlannedInstances::every);
    const bool coats = plan.surfaces.clearcoat, masks = plan.surfaces.mask;
    draw_planned(PlannedInstances::plain);
    if (masks) draw_planned(PlannedInstances::plain_or_masked);
    for (const PlannedInstances instances : {PlannedInstances::plain_or_coated, PlannedInstances::uncoated}) {
      if (coats) draw_planned(instances);
    }
  } catch (...) {
    preparing_ = false;
    throw;
  }
  preparing_ = false;
  drop_caches();
  look(here);
}

void RenderView::release() {
  drop_caches();
  targets.clear();
}

void RenderView::restart() {
  drop_caches();
  look(View(view));
}

void RenderView::drop_caches() {
  caches.clear();
  cl_lights_.reset();
  shadows = {};
  effects.clear();
  culler_.reset();
  for (auto& grid : grids_) grid.reset();
}

void RenderView::lights_changed() {
  if (!culler_ || !plan.lists.light_grid) return;
  std::vector<CullLight> lights = cull_lights_of(scene, plan.lights.local, ranges_of(plan.settings));
  for (size_t i = 0; i < plan.lights.left_out.size(); ++i)
    if (plan.lights.left_out[i]) lights[i].radius_m = -1;  // listed nowhere
  culler_->set_lights(lights);
}

void RenderView::draw_random(uint32_t seed) {
  settings_.set(setting::list_seed, seed);
  plan.settings.set(setting::list_seed, seed);
  if (plan.settings[setting::range] != LightRange::stochastic) return;
  settings_.set(setting::light_seed, seed);
  look(view);
  lights_changed();
}

void RenderView::follow_view() {
  transforms.resize(scene.instances.size());
  for (const auto* instances : {&plan.surfaces.opaque, &plan.surfaces.blended}) {
    for (const int i : *instances) transforms[i] = instance_transform(view, scene.instances[i]);
  }
  cl_lights_stale_ = true;
  if (!plan.opengl) return;
  lights.upload(*this);
  if (preparing_) {
    opaque.clear();
    blended.clear();
    return;
  }
  const GlScene& in_gl = gpu.in_gl();
  opaque = make_draw_list(in_gl, view, plan.surfaces.opaque, transforms, plan.lists.far_m,
                          DrawOrder::front_to_back);
  blended =
      make_draw_list(in_gl, view, plan.surfaces.blended, transforms, plan.lists.far_m, DrawOrder::as_given);
}

// Keeps resources that still fit; drops the others, to be created again at their next use.
void RenderView::follow_plan(const FramePlan& before) {
  if (!same_culler(before, plan)) culler_.reset();
  if (before.lights.index_bits != plan.lights.index_bits) {
    for (auto& grid : grids_) grid.reset();
  }
  if (!plan.lists.blend_grid) grids_[1].reset();
  if (before.lights.left_out != plan.lights.left_out) lights_changed();
  if (culler_) culler_->set_view(cull_view(view, plan));
  caches.follow(*this);
  effects.follow(*this);
}

LightCuller& RenderView::culler() {
  if (!culler_) {
    culler_.emplace(*renderer.cl, *renderer.kernels, culler_options(plan));
    lights_changed();
    culler_->set_view(cull_view(view, plan));
  }
  return *culler_;
}

SharedGridStorage& RenderView::grid_storage(bool blended) {
  std::optional<SharedGridStorage>& storage = grids_[blended];
  return storage ? *storage : storage.emplace(renderer, plan.lights.index_bits);
}

size_t RenderView::memory_bytes() const {
  size_t bytes = targets.bytes() + lights.light_bytes() + shadows.bytes() + caches.memory_bytes() +
                 effects.memory_bytes();
  bytes += cl_lights_ ? cl_lights_->memory_bytes() : 0;
  if (plan.opengl) bytes += gpu.in_gl().geometry_bytes() + gpu.in_gl().texture_bytes();
  if (plan.opengl && plan.reversed_triangles) bytes += gpu.in_gl().reversed_triangle_bytes();
  for (const auto& grid : grids_) bytes += grid ? grid->allocated_bytes() : 0;
  if (culler_) bytes += culler_->memory_bytes();
  return bytes;
}

}  // namespace lightgrid
