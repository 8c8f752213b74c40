#include "base/error.h"
#include "base/text.h"
#include "techniques/technique.h"

namespace lightgrid {

extern const Technique forward, forward_multipass, forward_zprepass, forward_plus, clustered,
    forward_plus_compute, deferred, deferred_tiled, light_prepass, lidr, visibility, voxel_lights, world_grid;

const std::vector<const Technique*>& techniques() {
  static const std::vector<const Technique*> all = {
      &forward,   &forward_multipass, &forward_zprepass, &forward_plus, &clustered,  &forward_plus_compute,
      &deferred,  &deferred_tiled,    &light_prepass,    &lidr,         &visibility, &voxel_lights,
      &world_grid};
  return all;
}

std::string technique_names() {
  std::string names;
  for (const Technique* technique : techniques())
    names += (names.empty() ? "" : ", ") + std::string(technique->name);
  return names;
}

const Technique& find_technique(const std::string& name) {
  for (const Technique* technique : techniques()) {
    if (technique->name == name) return *technique;
  }
  std::vector<std::string> names;
  for (const Technique* technique : techniques()) names.emplace_back(technique->name);
  throw input_error("technique \"{}\": unknown name{}; techniques are {}", name, did_you_mean(name, names),
                    technique_names());
}

}  // namespace lightgrid
