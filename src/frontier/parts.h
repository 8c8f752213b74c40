// The parts of one sweep, which several processes or machines measured, read together.
#pragma once

#include "frontier/record_file.h"

namespace lightgrid {

// Reads every part (part_path) of the folders, in the order of shards. `notice` is told of half-written
// lines, of shards that are missing and of parts that are not finished, whose points are missing from the
// answer, and of scenes that parts measured on different numbers of views. Throws Error(input) that names the
// file if a folder is not there or holds no part, if two parts are of different requests, commits, seeds,
// baselines or numbers of shards, and if a shard is there twice.
std::vector<FrontierPart> read_parts(const std::vector<std::filesystem::path>& folders, const Notice& notice);

}  // namespace lightgrid
