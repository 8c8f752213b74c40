// Light groups: which lights light which instances (Stone, "The Dark Side of Deferred Shading: Light Groups",
// 2009). Lights and instances have masks of 32 groups; a light lights an instance where they share one.
// Files say so by names and numbers of groups, or by lists of instances, which compile to masks.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "scene/scene.h"

namespace lightgrid {

inline constexpr int max_groups = 32;
inline constexpr uint32_t all_groups = 0xffffffffu;

// Masks of a Light or an Instance: fields "groups", "include" and "exclude" of files.
extern const Property<uint32_t> group_masks;
template <typename Owner>
uint32_t groups_of(const Owner& owner) {
  return group_masks.of(owner);
}
inline void set_groups(auto& owner, uint32_t mask) { group_masks.set(owner, mask); }

inline bool groups_meet(uint32_t light, uint32_t instance) { return (light & instance) != 0; }

// Some mask of the scene lacks a group. Without, all lights light everything.
bool calls_for_groups(const Scene& scene);

// The lists that a file gives for one light or instance.
struct GroupLists {
  using Names = std::optional<std::vector<std::string>>;

  int owner = 0;      // index of the light or the instance
  std::string where;  // for messages: `lights.json: light 3 "lamp"`
  Names groups;       // names, and numbers 0 to 31 as text; empty: in no group; none: in every group
  // For a light, names of instances: those that it lights, and those that it does not. None: all, and none.
  Names include, exclude;
};

// The elements of a JSON array of names and numbers, of a text that separates them by commas, or one number.
// None if it is anything else.
GroupLists::Names names_of_groups(const nlohmann::json& value);

// Sets the masks of the scene's lights and instances, and names of groups (Scene::group_names): a new name
// takes the lowest number that no other has. A list of instances takes a group of its own, which all
// instances outside it lose; lists of the same instances share it. Throws Error(input) that names the owner:
// a number past 31, a 33rd group, a list with a name that no instance has, groups and a list of one light,
// and instances that lists leave without any group.
void compile_groups(Scene& scene, const std::vector<GroupLists>& of_lights,
                    const std::vector<GroupLists>& of_instances);

// "0, 3 and kitchen"; "no group", "every group".
std::string words_of_groups(const Scene& scene, uint32_t mask);

}  // namespace lightgrid
