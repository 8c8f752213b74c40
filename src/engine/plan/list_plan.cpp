#include "plan/list_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "plan/settings/grid.h"

namespace lightgrid {
namespace {

void check_sampled_lists(const ListNeeds& needs, const Settings& s) {
  if (!samples_lists(s)) return;
  const bool tree = s[setting::list_cap_order] == ListCapOrder::tree;
  if (!needs.sampled)
    throw input_error(
        "set list-cap-order={}: the technique's lists do not say how many times a light counts; choose "
        "forward_plus, clustered, forward_plus_compute, deferred_tiled or visibility, or another order",
        tree ? "tree" : "sampled");
  if (tree && needs.z_bins && s[setting::z_bins] > 1)
    throw input_error(
        "set z-bins={}: with list-cap-order=tree no light is sorted into bins; choose z-bins=off",
        s[setting::z_bins]);
  if (tree && s[setting::view_cap] > 0)
    throw input_error("set view-cap={}: list-cap-order=tree draws from all lights; choose view-cap=off",
                      s[setting::view_cap]);
}

void plan_sampled_lists(const Settings& settings, const LightPlan& lights, ListPlan& plan,
                        Decisions& decisions) {
  if (!samples_lists(settings)) return;
  plan.sampled = plan.light_grid && lights.local.size() > size_t(settings[setting::list_cap]);
  decisions.push_back({"sampled lists", plan.sampled,
                       fmt::format("list-cap={}, {} point and spot lights", settings[setting::list_cap],
                                   lights.local.size())});
  plan.light_tree = plan.sampled && settings[setting::list_cap_order] == ListCapOrder::tree;
  decisions.push_back({"light tree", plan.light_tree,
                       plan.light_tree ? "list-cap-order=tree, in place of culling"
                       : plan.sampled  ? "list-cap-order=sampled"
                                       : "nothing is drawn"});
}

// From the near plane to the farthest surface in view.
void plan_slices(const View& view, const ListNeeds& needs, const Settings& settings, double farthest_m,
                 ListPlan& plan, Decisions& decisions) {
  plan.slices = needs.slices ? settings[setting::slices] : 1;
  const double far_m = std::min(farthest_m, view.far_m);
  plan.near_m = view.near_m;
  plan.far_m = far_m > view.near_m ? far_m : view.near_m + 1;
  plan.z_bins = needs.z_bins && plan.light_grid ? settings[setting::z_bins] : 1;
  const bool needed = plan.light_grid && plan.slices > 1;
  decisions.push_back({"depth slices", needed,
                       needed
                           ? fmt::format("{} from {:.3g} m to {:.3g} m", plan.slices, plan.near_m, plan.far_m)
                       : !needs.slices   ? needs.no_slices
                       : plan.light_grid ? "slices=1"
                                         : "no light grid"});
  decisions.push_back({"z-bins", plan.z_bins > 1,
                       plan.z_bins > 1   ? fmt::format("{} between the same distances", plan.z_bins)
                       : !needs.z_bins   ? "the technique's shading reads none"
                       : plan.light_grid ? "z-bins=off"
                                         : "no light grid"});
}

}  // namespace

void check_lists(const ListNeeds& needs, const Settings& s) {
  if (needs.light_grid && s[setting::list_cap] > 0 && s[setting::grid_lists] == GridLists::masks)
    throw input_error(
        "set list-cap={}: masks have a bit for each light, and no length; choose grid-lists=lists, or "
        "view-cap",
        s[setting::list_cap]);
  if (needs.capped) check_sampled_lists(needs, s);
}

ListPlan plan_lists(const Scene& scene, const View& view, const ListNeeds& needs, const Settings& settings,
                    const SurfacePlan& surfaces, const LightPlan& lights, Decisions& decisions) {
  ListPlan plan;
  plan.light_grid = needs.light_grid && lights.any_local;
  const bool bounded = settings[setting::depth_bounds] != DepthBoundsMode::none;
  plan.blend_grid = plan.light_grid && surfaces.blend && bounded;
  decisions.push_back({"light grid", plan.light_grid,
                       !needs.light_grid   ? needs.no_light_grid
                       : !lights.any_local ? "no light has a place"
                                           : light_witness(scene, lights.local[0])});
  decisions.push_back({"blended light grid", plan.blend_grid,
                       plan.blend_grid    ? blend_witness(scene, surfaces)
                       : !plan.light_grid ? "no light grid"
                       : !surfaces.blend  ? "no blended material in view"
                                          : "without depth bounds, one grid serves all surfaces"});
  plan_sampled_lists(settings, lights, plan, decisions);
  plan.world_grid = needs.world_grid && lights.any_local;
  if (needs.world_grid) {
    decisions.push_back({"world grid", plan.world_grid,
                         plan.world_grid ? light_witness(scene, lights.local[0]) : "no light has a place"});
  }
  plan_slices(view, needs, settings, surfaces.farthest_m, plan, decisions);
  return plan;
}

void plan_every_list(const ListNeeds& needs, ListPlan& plan) {
  plan.light_grid = plan.blend_grid = needs.light_grid;
  plan.world_grid = needs.world_grid;
}

}  // namespace lightgrid
