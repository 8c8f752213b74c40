// Records of all parts become one answer.
#include "frontier/answer.h"

#include <set>

#include "base/error.h"
#include "frontier/answer_steps.h"
#include "frontier/one_machine.h"
#include "frontier/record_file.h"

namespace lightgrid {
namespace {

void check_one_sweep(const std::vector<FrontierPart>& parts) {
  if (parts.empty()) throw input_error("frontier: no part to answer from");
  const FrontierPart& first = parts.front();
  for (const FrontierPart& part : parts) {
    if (part.commit != first.commit) {
      throw input_error(
          "frontier: shard {}/{} was measured by commit {}, shard {}/{} by {}: measure both by one commit",
          part.shard, part.shards, part.commit, first.shard, first.shards, first.commit);
    }
    if (part.request != first.request) {
      throw input_error(
          "frontier: shards {}/{} and {}/{} are of different requests (scenes, points, views, size or seed)",
          first.shard, first.shards, part.shard, part.shards);
    }
  }
}

// Records of all parts; of those with one key, the first.
std::vector<FrontierRecord> joined(const std::vector<FrontierPart>& parts) {
  std::vector<FrontierRecord> records;
  std::set<std::string> keys;
  for (const FrontierPart& part : parts) {
    for (const FrontierRecord& record : part.records) {
      if (keys.insert(record_key(record)).second) records.push_back(record);
    }
  }
  return records;
}

}  // namespace

FrontierAnswer answer_of(const std::vector<FrontierPart>& parts) {
  check_one_sweep(parts);
  FrontierAnswer answer;
  answer.part = parts.front();
  answer.part.records = joined(parts);
  for (const FrontierPart& part : parts) answer.machines.push_back(part.machine);
  const std::vector<FrontierRecord> records = on_one_machine(answer.part.records, answer.machines);
  answer.points = figures_of(records);
  rank_points(answer.points);
  answer.best_within = best_within_of(answer.points);
  answer.break_even = break_evens_of(records);
  answer.shading_costs = shading_costs_of(records);
  answer.growth = growth_of(records);
  answer.failures = failures_of(records);
  answer.sentences = sentences_of(answer);
  return answer;
}

}  // namespace lightgrid
