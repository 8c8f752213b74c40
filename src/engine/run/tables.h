// Tables for front ends, as JSON.
#pragma once

#include <nlohmann/json.hpp>

namespace lightgrid {

// {"techniques": [{"name", "summary", "source", "settings"}], "common_settings", "settings": [{"key",
// "values", "meaning", "any_number"}]}; the first value is the default.
nlohmann::ordered_json techniques_json();

}  // namespace lightgrid
