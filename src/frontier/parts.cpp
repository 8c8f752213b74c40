#include "frontier/parts.h"

#include <algorithm>
#include <map>

#include "base/error.h"

namespace lightgrid {
namespace {

namespace fs = std::filesystem;

bool is_part_name(const std::string& name) {
  return name.starts_with("records-") && name.ends_with(".jsonl");
}

std::vector<fs::path> part_files(const fs::path& folder) {
  std::error_code failure;
  if (!fs::is_directory(folder, failure)) throw input_error("{}: no such folder", folder.string());
  std::vector<fs::path> files;
  fs::directory_iterator entries(folder, failure);
  if (failure) throw input_error("{}: cannot be read: {}", folder.string(), failure.message());
  for (const auto& entry : entries) {
    if (is_part_name(entry.path().filename().string())) files.push_back(entry.path());
  }
  if (files.empty()) {
    throw input_error("{}: holds no part of a frontier ({})", folder.string(), "records-I-of-N.jsonl");
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string list_of(const std::vector<int>& shards) {
  constexpr size_t most = 10;
  std::string text;
  for (size_t i = 0; i < std::min(shards.size(), most); ++i)
    text += fmt::format("{}{}", i > 0 ? ", " : "", shards[i]);
  if (shards.size() > most) text += fmt::format(" and {} more", shards.size() - most);
  return text;
}

// How many views a part measured depends on the time that its machine had.
void tell_different_views(const std::vector<FrontierPart>& parts, const Notice& notice) {
  struct Views {
    int count = 0, shard = 0;
  };
  std::map<std::string, std::pair<Views, Views>> least_and_most;  // by scene
  for (const FrontierPart& part : parts) {
    std::map<std::string, int> views;
    for (const FrontierRecord& r : part.records) {
      if (r.series.empty()) views[r.point.scene] = std::max(views[r.point.scene], r.view + 1);
    }
    for (const auto& [scene, count] : views) {
      const Views here = {count, part.shard};
      auto& [least, most] = least_and_most.try_emplace(scene, here, here).first->second;
      if (count < least.count) least = here;
      if (count > most.count) most = here;
    }
  }
  for (const auto& [scene, range] : least_and_most) {
    const auto& [least, most] = range;
    if (least.count == most.count) continue;
    notice(fmt::format("{}: {} views in shard {}, {} in shard {}: points of different views are compared",
                       scene, least.count, least.shard, most.count, most.shard));
  }
}

}  // namespace

std::vector<FrontierPart> read_parts(const std::vector<fs::path>& folders, const Notice& notice) {
  if (folders.empty()) throw input_error("no folder of parts is named");
  std::map<int, std::pair<fs::path, FrontierPart>> by_shard;
  for (const fs::path& folder : folders) {
    for (const fs::path& file : part_files(folder)) {
      FrontierPart part = read_part(file, notice);
      if (!by_shard.empty()) {
        const auto& [first_file, first] = by_shard.begin()->second;
        check_same_sweep(file, part, first, first_file.string());
      }
      const int shard = part.shard;
      const auto [place, added] = by_shard.try_emplace(shard, file, std::move(part));
      if (!added) {
        throw input_error("{}: shard {} is there twice, also in {}", file.string(), shard,
                          place->second.first.string());
      }
    }
  }

  std::vector<FrontierPart> parts;
  std::vector<int> missing, unfinished;
  const int shards = by_shard.begin()->second.second.shards;
  for (int shard = 0; shard < shards; ++shard) {
    const auto found = by_shard.find(shard);
    if (found == by_shard.end()) {
      missing.push_back(shard);
      continue;
    }
    if (!found->second.second.finished) unfinished.push_back(shard);
    parts.push_back(std::move(found->second.second));
  }
  if (notice && !missing.empty()) notice(fmt::format("missing of {} shards: {}", shards, list_of(missing)));
  if (notice && !unfinished.empty())
    notice(fmt::format("not finished of {} shards: {}", shards, list_of(unfinished)));
  if (notice) tell_different_views(parts, notice);
  return parts;
}

}  // namespace lightgrid
