#include "cl/tuned_sizes.h"

#include <cstdlib>
#include <fstream>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/write_file.h"
#include "cl/program_cache.h"

namespace lightgrid {
namespace {

using Json = nlohmann::ordered_json;

// A driver update may change what is fastest: it is part of the key.
std::string key_of(const ClDeviceInfo& device) {
  return fmt::format("{} | {} | {} | {}", device.platform, device.name, device.version, device.driver);
}

// An object by device; empty if the file has none.
Json read_all(const std::filesystem::path& file) {
  std::error_code unreadable;
  if (file.empty() || !std::filesystem::is_regular_file(file, unreadable)) return Json::object();
  std::ifstream stream(file);
  Json json = Json::parse(stream, nullptr, false);
  return json.is_object() ? json : Json::object();
}

}  // namespace

std::filesystem::path tuned_sizes_file() {
  const char* named = std::getenv("LIGHTGRID_TUNED");
  if (named && *named)
    return std::string(named) == "off" ? std::filesystem::path() : std::filesystem::path(named);
  const std::filesystem::path programs = ProgramCache::default_folder();
  return programs.empty() ? programs : programs.parent_path() / "tuned.json";
}

TunedSizes read_tuned_sizes(const ClDeviceInfo& device, const std::filesystem::path& file) {
  const Json all = read_all(file);
  const auto found = all.find(key_of(device));
  TunedSizes sizes;
  if (found == all.end() || !found->is_object()) return sizes;
  for (const auto& [name, value] : found->items()) {
    if (value.is_string()) sizes[name] = value.get<std::string>();
  }
  return sizes;
}

void write_tuned_sizes(const ClDeviceInfo& device, const TunedSizes& sizes,
                       const std::filesystem::path& file) {
  if (file.empty()) throw input_error("LIGHTGRID_TUNED is off: there is no file for tuned sizes");
  Json all = read_all(file);
  all[key_of(device)] = sizes;
  if (file.has_parent_path()) make_folder(file.parent_path());
  write_file(file, all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace lightgrid
