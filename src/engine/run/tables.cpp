#include "run/tables.h"

#include "techniques/technique.h"

namespace lightgrid {

nlohmann::ordered_json techniques_json() {
  nlohmann::ordered_json json = {{"techniques", nlohmann::ordered_json::array()},
                                 {"common_settings", common_settings()},
                                 {"settings", nlohmann::ordered_json::array()}};
  for (const Technique* t : techniques()) {
    json["techniques"].push_back(
        {{"name", t->name}, {"summary", t->summary}, {"source", t->source}, {"settings", t->settings}});
  }
  for (const SettingRow& s : setting_rows()) {
    json["settings"].push_back(
        {{"key", s.key}, {"values", s.values}, {"meaning", s.meaning}, {"any_number", s.flags.any_number}});
  }
  return json;
}

}  // namespace lightgrid
