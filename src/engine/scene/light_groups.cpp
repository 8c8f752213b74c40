#include "scene/light_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "scene/property_rows.h"

namespace lightgrid {
namespace {

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

// Gives groups their numbers.
class Numbers {
 public:
  explicit Numbers(std::vector<std::string>& names) : names_(names) { names_.resize(size_t(max_groups)); }

  // A group that is given by its number keeps it: no name may take it.
  void reserve(const GroupLists& lists) {
    for (const std::string& name : lists.groups.value_or(std::vector<std::string>())) {
      const auto number = parse_number<int64_t>(name);
      if (!number) continue;
      if (*number < 0 || *number >= max_groups)
        throw input_error("{}: group {} is not a number from 0 to {}", lists.where, name, max_groups - 1);
      std::string& taken = names_[size_t(*number)];
      if (taken.empty()) taken = name;
    }
  }

  uint32_t mask_of(const GroupLists& lists) {
    uint32_t mask = 0;
    for (const std::string& name : *lists.groups) {
      const auto number = parse_number<int>(name);
      mask |= uint32_t(1) << (number ? *number : number_of(name, lists.where));
    }
    return mask;
  }

  int number_of(const std::string& name, const std::string& where) {
    auto at = std::ranges::find(names_, name);
    if (at == names_.end()) at = std::ranges::find(names_, std::string());
    if (at == names_.end())
      throw input_error("{}: \"{}\" is one group too many: there are at most {}", where, name, max_groups);
    *at = name;
    return int(at - names_.begin());
  }

 private:
  std::vector<std::string>& names_;
};

// The instances of each name.
using Named = std::map<std::string, std::vector<int>>;

void mark(const Named& named, const GroupLists::Names& names, const std::string& where, const char* list,
          bool value, std::vector<bool>& lit) {
  for (const std::string& name : names.value_or(std::vector<std::string>())) {
    const auto found = named.find(name);
    if (found == named.end()) {
      std::vector<std::string> all;
      for (const auto& [known, instances] : named) all.push_back(known);
      throw input_error("{}: {}: no node \"{}\" shows a mesh{}", where, list, name, did_you_mean(name, all));
    }
    for (const int instance : found->second) lit[size_t(instance)] = value;
  }
}

std::vector<bool> lit_instances(const Scene& scene, const Named& named, const GroupLists& lists) {
  std::vector<bool> lit(scene.instances.size(), !lists.include.has_value());
  mark(named, lists.include, lists.where, "include", true, lit);
  mark(named, lists.exclude, lists.where, "exclude", false, lit);
  return lit;
}

void compile_lists(Scene& scene, const std::vector<GroupLists>& of_lights, Numbers& numbers) {
  Named named;
  for (size_t i = 0; i < scene.instances.size(); ++i) named[scene.instances[i].name].push_back(int(i));
  std::map<std::vector<bool>, uint32_t> mask_of_lit;
  for (const GroupLists& lists : of_lights) {
    if (!lists.include && !lists.exclude) continue;
    if (lists.groups) throw input_error("{}: has groups and a list of nodes; give one of them", lists.where);
    const std::vector<bool> lit = lit_instances(scene, named, lists);
    auto [known, is_new] = mask_of_lit.try_emplace(lit, 0);
    if (is_new) {
      known->second = uint32_t(1) << numbers.number_of("the list of " + lists.where, lists.where);
      for (size_t i = 0; i < lit.size(); ++i) {
        const uint32_t mask = groups_of(scene.instances[i]);
        set_groups(scene.instances[i], lit[i] ? mask | known->second : mask & ~known->second);
      }
    }
    set_groups(scene.lights[size_t(lists.owner)], known->second);
  }
}

// Instances that are in no group although nothing says so.
void require_groups(const Scene& scene, const std::vector<bool>& dark) {
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    if (groups_of(scene.instances[i]) != 0 || dark[i]) continue;
    throw input_error(
        "node \"{}\": the lists of {} lights leave it in none of the {} groups, so that no light would light "
        "it: use fewer lists, or groups",
        scene.instances[i].name, scene.lights.size(), max_groups);
  }
}

bool accepts_names(const nlohmann::json& value, const PropertyOptions&) {
  return names_of_groups(value).has_value();
}

bool accepts_groups(const nlohmann::json& value, const PropertyOptions& options) {
  const auto is_group = [](const nlohmann::json& element) {
    return !element.is_number() || (element.get<double>() >= 0 && element.get<double>() < max_groups);
  };
  return accepts_names(value, options) &&
         (value.is_array() ? std::ranges::all_of(value, is_group) : is_group(value));
}

std::vector<GroupLists> lists_of(const std::vector<GivenProperties>& given) {
  std::vector<GroupLists> all;
  for (const GivenProperties& owner : given) {
    const auto names = [&](const char* key) {
      const auto field = owner.fields.find(key);
      return field == owner.fields.end() ? GroupLists::Names() : names_of_groups(field->second);
    };
    all.push_back({owner.owner, owner.where, names("groups"), names("include"), names("exclude")});
  }
  return all;
}

nlohmann::ordered_json numbers_of(const PropertyValue& mask) {
  nlohmann::ordered_json numbers = nlohmann::ordered_json::array();
  for (int i = 0; i < max_groups; ++i)
    if (std::get<uint32_t>(mask) >> i & 1) numbers.push_back(i);
  return numbers;
}

PropertyRow row() {
  constexpr const char* names = "a list of names and whole numbers";
  return {
      .keys = {{"groups", "light_groups", std::string(names) + " from 0 to 31", accepts_groups, true, true},
               {"include", "light_include", names, accepts_names, false, true},
               {"exclude", "light_exclude", names, accepts_names, false, true}},
      .options = {.inherited = true},
      .apply =
          [](Scene& scene, const GivenByFile& given) {
            compile_groups(scene, lists_of(given.lights), lists_of(given.instances));
          },
      .write = numbers_of};
}

}  // namespace

const Property<uint32_t> group_masks{add_property(row()), all_groups};

bool calls_for_groups(const Scene& scene) {
  const auto lacks = [](const auto& owner) { return groups_of(owner) != all_groups; };
  return std::ranges::any_of(scene.lights, lacks) || std::ranges::any_of(scene.instances, lacks);
}

GroupLists::Names names_of_groups(const nlohmann::json& value) {
  std::vector<std::string> names;
  const auto add = [&](const nlohmann::json& element) {
    if (element.is_string()) {
      names.push_back(element.get<std::string>());
      return true;
    }
    if (!element.is_number()) return false;
    const double number = element.get<double>();
    names.push_back(fmt::format("{}", number));
    return number == double(int64_t(number));
  };
  if (value.is_string()) {
    std::string rest = value.get<std::string>();
    while (!rest.empty()) {
      const size_t comma = std::min(rest.find(','), rest.size());
      if (const std::string name = trimmed(rest.substr(0, comma)); !name.empty()) names.push_back(name);
      rest = rest.substr(std::min(comma + 1, rest.size()));
    }
    return names;
  }
  if (!value.is_array()) return add(value) ? GroupLists::Names(names) : std::nullopt;
  for (const nlohmann::json& element : value)
    if (!add(element)) return {};
  return names;
}

void compile_groups(Scene& scene, const std::vector<GroupLists>& of_lights,
                    const std::vector<GroupLists>& of_instances) {
  if (of_lights.empty() && of_instances.empty()) return;
  Numbers numbers(scene.group_names);
  for (const auto* lists : {&of_instances, &of_lights})
    for (const GroupLists& owner : *lists) numbers.reserve(owner);
  for (const GroupLists& owner : of_instances)
    if (owner.groups) set_groups(scene.instances[size_t(owner.owner)], numbers.mask_of(owner));
  for (const GroupLists& owner : of_lights)
    if (owner.groups) set_groups(scene.lights[size_t(owner.owner)], numbers.mask_of(owner));
  std::vector<bool> dark;
  for (const Instance& instance : scene.instances) dark.push_back(groups_of(instance) == 0);
  compile_lists(scene, of_lights, numbers);
  require_groups(scene, dark);
}

std::string words_of_groups(const Scene& scene, uint32_t mask) {
  if (mask == 0) return "no group";
  if (mask == all_groups) return "every group";
  std::vector<std::string> words;
  for (size_t i = 0; i < size_t(max_groups); ++i) {
    if (!(mask >> i & 1)) continue;
    const bool named = i < scene.group_names.size() && !scene.group_names[i].empty();
    words.push_back(named ? scene.group_names[i] : fmt::format("{}", i));
  }
  if (words.size() == 1) return words[0];
  const std::string last = words.back();
  words.pop_back();
  return fmt::format("{} and {}", fmt::join(words, ", "), last);
}

}  // namespace lightgrid
