// The pose of a glTF file at a time, computed independently: from the file's JSON and bytes by the text of
// glTF 2.0 alone, in double, with different formulas from the loader's if possible. Supports what the
// conformance models use: accessors with a view, not sparse; buffers as files, data URIs or a GLB's chunk.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "conformance/pose_math.h"

namespace lightgrid {

class PoseOracle {
 public:
  explicit PoseOracle(const std::filesystem::path& path);

  const nlohmann::json& root() const { return root_; }
  std::vector<Numbers> elements(int accessor) const;

  // Poses animation `animation`, or all at -1; at rest if `seconds` is negative.
  Affine world_of_node(int node, double seconds, int animation = -1) const;

  // World positions and unit normals (empty if the file has none) of a skinned primitive's vertices.
  struct Vertices {
    std::vector<Numbers> positions, normals;
  };
  Vertices skinned(const nlohmann::json& primitive, int skin, double seconds) const;

 private:
  using Key = std::pair<int, std::string>;  // node and path
  std::map<Key, Numbers> animated(double seconds, int animation) const;
  Affine world(int node, const std::map<Key, Numbers>& values) const;

  nlohmann::json root_;
  std::vector<std::vector<uint8_t>> buffers_;
  std::map<int, int> parent_of_;
};

Numbers transform(const Affine& m, const Numbers& point);

}  // namespace lightgrid
