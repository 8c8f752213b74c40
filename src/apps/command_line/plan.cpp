// lightgrid plan SCENE: the effects that this view needs, and why.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "command_line/commands.h"
#include "command_line/options.h"
#include "compare/contestants.h"
#include "oracle/blend_order.h"
#include "oracle/leaks.h"
#include "plan/coarse_shadows.h"
#include "plan/settings/model.h"
#include "plan/settings/samples.h"
#include "techniques/technique.h"

namespace lightgrid::app {
using namespace lab;
namespace {

struct PlanOptions {
  SceneChoice scene;
  std::string technique = "forward_plus", json;
  bool leaks = false, blend_order = false;
};

nlohmann::ordered_json leaks_json(const Leaks& leaks, const Scene& scene) {
  nlohmann::ordered_json json = {{"pixels", leaks.pixels},
                                 {"lit", leaks.lit},
                                 {"leaked", leaks.leaked},
                                 {"either", leaks.either},
                                 {"through", nlohmann::ordered_json::array()}};
  for (const Leak& leak : leaks.leaks) {
    json["through"].push_back({{"light", leak.light},
                               {"name", scene.lights[size_t(leak.light)].name},
                               {"node", leak.instance},
                               {"node_name", scene.instances[size_t(leak.instance)].name},
                               {"pixels", leak.pixels}});
  }
  json["received"] = nlohmann::ordered_json::array();
  for (const Leaks::Received& received : leaks.received) {
    json["received"].push_back({{"light", received.light},
                                {"node", received.instance},
                                {"node_name", scene.instances[size_t(received.instance)].name},
                                {"seen", received.seen},
                                {"leaked", received.leaked}});
  }
  return json;
}

int plan(PlanOptions o) {
  take_own_settings(o.technique, o.scene.set);
  const Technique& technique = find_technique(o.technique);
  const Settings settings = chosen_settings(o.scene);
  check_given_settings(settings, {{&technique, settings}});
  check_samples(technique, settings);
  if (!o.json.empty()) check_output_file("--json", o.json);
  const ChosenScene chosen = load_chosen_scene(o.scene);
  check_given_settings(settings, {{&technique, settings}},
                       {.casts = std::ranges::any_of(chosen.scene.lights, &Light::casts_shadow)});
  const FramePlan plan = plan_frame(chosen.scene, chosen.view, settings, technique.needs);
  std::optional<Leaks> leaks;
  if (o.leaks) leaks = find_leaks(chosen.scene, chosen.view, ranges_of(settings));
  std::optional<BlendOrder> order;
  if (o.blend_order) order = find_blend_order(chosen.scene, chosen.view, plan.surfaces.blended);
  if (o.json.empty()) {
    std::fputs(describe(plan, chosen.scene).c_str(), stdout);
    constexpr size_t max_leaks = 20;
    if (leaks) std::fputs(describe(*leaks, chosen.scene, max_leaks).c_str(), stdout);
    if (order) std::fputs(describe(*order).c_str(), stdout);
    return 0;
  }
  nlohmann::ordered_json json = {{"scene", chosen.scene.name},
                                 {"technique", technique.name},
                                 {"decisions", nlohmann::ordered_json::array()}};
  if (plan.lights.any_virtual) json["lights_virtual"] = plan.lights.virtual_count;
  for (const Decision& d : plan.decisions) {
    json["decisions"].push_back({{"effect", d.effect}, {"needed", d.needed}, {"why", d.why}});
  }
  for (const LightShadow& light : plan.shadows.casting) {
    const auto by = [&](const char* what) {
      return light.need == ShadowNeed::rays && plan.shadows.found_by == std::string(what);
    };
    json["shadows"].push_back({{"light", light.light},
                               {"name", chosen.scene.lights[size_t(light.light)].name},
                               {"rays", by("rays")},
                               {"map", by("maps")},
                               {"volume", by("shadow volumes")},
                               {"why", words_of(light, chosen.scene)}});
  }
  const CoarseShadows coarse = coarse_shadows(chosen.scene, ranges_of(plan.settings));
  if (coarse.lights + coarse.instances > 0)
    json["coarse_shadows"] = {{"lights", coarse.lights},
                              {"first_light", coarse.first_light},
                              {"instances", coarse.instances},
                              {"first_instance", coarse.first_instance},
                              {"gap_m", coarse.gap_m}};
  if (leaks) json["leaks"] = leaks_json(*leaks, chosen.scene);
  if (order)
    json["blend_order"] = {{"blended", order->blended}, {"several", order->several}, {"wrong", order->wrong}};
  write_json(o.json, json.dump(1));
  return 0;
}

}  // namespace

void add_plan(CommandLine& line) {
  auto o = std::make_shared<PlanOptions>();
  Subcommand command =
      line.add("plan", "the effects that this view needs, and why", [o] { return plan(*o); });
  add_scene_options(command, o->scene);
  add_technique_option(command, o->technique, technique_names());
  add_exposure_option(command, o->scene);
  command.flag("--leaks", o->leaks, "lists the light that goes through walls, by light and wall");
  command.flag("--blend-order", o->blend_order,
               "counts the pixels whose blended surfaces are blended in a wrong order");
  command.option("--json", o->json, "as JSON into a file, - for stdout");
}

}  // namespace lightgrid::app
