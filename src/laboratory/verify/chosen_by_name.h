// Choices by a filter of names.
#pragma once

#include <regex>
#include <string>
#include <vector>

#include "base/error.h"

namespace lightgrid::lab::verify {

// Returns the items of `all` in whose name_of the regular expression is found. Throws Error(input) if it is
// invalid or found in no name; `what` and `like` are for that message.
template <typename All, typename Name>
auto chosen_by_name(const All& all, const std::string& filter, const Name& name_of, const char* what,
                    const char* like) {
  std::vector<std::decay_t<decltype(*std::begin(all))>> chosen;
  try {
    const std::regex pattern(filter);
    for (const auto& one : all) {
      if (std::regex_search(std::string(name_of(one)), pattern)) chosen.push_back(one);
    }
  } catch (const std::regex_error&) {
    throw input_error("filter: \"{}\" is not a regular expression", filter);
  }
  if (chosen.empty())
    throw input_error("filter: no {} matches \"{}\"; names are like {}", what, filter, like);
  return chosen;
}

}  // namespace lightgrid::lab::verify
