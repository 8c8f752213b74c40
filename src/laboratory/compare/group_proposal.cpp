#include "compare/group_proposal.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "scene/light_groups.h"

namespace lightgrid {
namespace {

using Names = std::set<std::string>;

// The nodes of one light, or of the lights of a group.
struct Lit {
  std::vector<int> lights;
  Names seen, hidden;  // hidden: leaked at every sample
  uint64_t leaked = 0;
};

bool meet(const Names& a, const Names& b) {
  return std::ranges::any_of(a, [&](const std::string& name) { return b.contains(name); });
}

size_t shared(const Names& a, const Names& b) {
  return size_t(std::ranges::count_if(a, [&](const std::string& name) { return b.contains(name); }));
}

void join(Lit& group, const Lit& light) {
  group.lights.insert(group.lights.end(), light.lights.begin(), light.lights.end());
  group.seen.insert(light.seen.begin(), light.seen.end());
  group.hidden.insert(light.hidden.begin(), light.hidden.end());
  group.leaked += light.leaked;
}

std::vector<Lit> lit_by_each(const Leaks& leaks, const Scene& scene) {
  struct Pairs {
    uint64_t seen = 0, leaked = 0;
  };
  std::map<int, std::map<std::string, Pairs>> nodes;
  for (const Leaks::Received& r : leaks.received) {
    Pairs& pairs = nodes[r.light][scene.instances[size_t(r.instance)].name];
    pairs.seen += r.seen, pairs.leaked += r.leaked;
  }
  std::vector<Lit> all;
  for (const auto& [light, of] : nodes) {
    if (scene.lights[size_t(light)].groups != all_groups) continue;
    Lit lit{.lights = {light}};
    for (const auto& [name, pairs] : of) {
      if (pairs.seen > 0 || name.empty()) {
        lit.seen.insert(name);
      } else {
        lit.hidden.insert(name), lit.leaked += pairs.leaked;
      }
    }
    if (lit.leaked > 0) all.push_back(std::move(lit));
  }
  std::ranges::stable_sort(all, std::ranges::greater(), &Lit::leaked);
  return all;
}

// A name of them in words, and how many more.
std::string first_of(const std::string& what, const std::string& name, size_t count) {
  return fmt::format("{} \"{}\"{}", what, name, count > 1 ? fmt::format(" and {} more", count - 1) : "");
}

}  // namespace

GroupProposal propose_groups(const Leaks& leaks, const Scene& scene) {
  size_t room = size_t(most_groups) - 1;  // one stays for what is in no list
  room -=
      std::min(room, size_t(std::ranges::count_if(scene.group_names, [](auto& n) { return !n.empty(); })));
  std::vector<Lit> groups;
  for (const Lit& light : lit_by_each(leaks, scene)) {
    Lit* best = nullptr;
    for (Lit& group : groups) {
      if (meet(group.seen, light.hidden) || meet(group.hidden, light.seen)) continue;
      if (!best || shared(group.seen, light.seen) > shared(best->seen, light.seen)) best = &group;
    }
    if (best) {
      join(*best, light);
    } else if (groups.size() < room) {
      groups.push_back(light);
    }
  }
  std::ranges::stable_sort(groups, std::ranges::greater(), &Lit::leaked);
  GroupProposal proposal{.groups = {}, .leaked = leaks.leaked, .left = leaks.leaked};
  for (Lit& group : groups) {
    std::ranges::sort(group.lights);
    proposal.left -= group.leaked;
    proposal.groups.push_back(
        {std::move(group.lights), {group.hidden.begin(), group.hidden.end()}, group.leaked});
  }
  return proposal;
}

Scene with_groups(Scene scene, const GroupProposal& proposal) {
  std::vector<GroupLists> lists;
  for (const ProposedGroup& group : proposal.groups) {
    for (const int light : group.lights)
      lists.push_back({.owner = light,
                       .where = first_of("light", scene.lights[size_t(light)].name, 1),
                       .groups = {},
                       .include = {},
                       .exclude = group.exclude});
  }
  compile_groups(scene, lists, {});
  return scene;
}

std::string describe(const GroupProposal& proposal, const Scene& scene) {
  if (proposal.groups.empty()) return "";
  std::string text =
      fmt::format("light groups in place of shadows: {} would take away {} of {} leaked pairs\n",
                  proposal.groups.size(), proposal.leaked - proposal.left, proposal.leaked);
  for (const ProposedGroup& group : proposal.groups) {
    const Light& light = scene.lights[size_t(group.lights[0])];
    text += fmt::format("  {} without {}: {} pairs\n", first_of("light", light.name, group.lights.size()),
                        first_of("node", group.exclude[0], group.exclude.size()), group.leaked);
  }
  return text;
}

}  // namespace lightgrid
