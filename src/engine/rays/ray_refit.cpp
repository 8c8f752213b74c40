#include "rays/ray_refit.h"

#include <algorithm>

#include "cl/transfer.h"

namespace lightgrid {
namespace {

constexpr uint32_t run = 64;  // triangles: a work-group of refit_triangles.cl
constexpr uint32_t few = 64;  // nodes: levels of no more are done one after the other by one work-item

template <typename T>
void put(ClDevice& device, GrowingBuffer& buffer, const std::vector<T>& values) {
  buffer.at_least(device, values.size() * sizeof(T));
  write_buffer(device, "rays: refit", buffer.get(), values.data(), values.size() * sizeof(T));
}

}  // namespace

RayRefit::RayRefit(ClDevice& device, ProgramCache& programs, const RayArrays& arrays)
    : device_(device),
      programs_(programs),
      places_(arrays.places),
      parents_(arrays.nodes.size(), -1),
      levels_(arrays.nodes.size(), 0),
      node_of_place_(arrays.places.size(), -1) {
  for (int i = 0; i < int(arrays.nodes.size()); ++i) {  // parents come before their children
    const RayNode& node = arrays.nodes[i];
    const int child[] = {node.child_0, node.child_1}, count[] = {node.count_0, node.count_1};
    for (int side = 0; side < 2; ++side) {
      if (count[side] == 0) {
        parents_[child[side]] = i;
        levels_[child[side]] = levels_[i] + 1;
      }
      for (int t = 0; t < count[side]; ++t) node_of_place_[child[side] + t] = i;
    }
  }
}

void RayRefit::upload_meshes(std::span<const RayMeshData> meshes) {
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
  for (const RayMeshData& mesh : meshes) {
    positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
    if (!has_meshes_) indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
  }
  put(device_, positions_, positions);
  if (!has_meshes_) put(device_, indices_, indices);
  has_meshes_ = has_positions_ = true;
}

// The nodes above the moved triangles, the deepest first.
void RayRefit::find_nodes(std::span<const RayMoved> moved) {
  std::vector<uint32_t> list;
  std::vector<bool> seen(parents_.size());
  for (const RayMoved& m : moved) {
    for (uint32_t t = 0; t < m.triangles; ++t) {
      for (int n = node_of_place_[places_[m.first_triangle + t]]; n >= 0 && !seen[n]; n = parents_[n]) {
        seen[n] = true;
        list.push_back(uint32_t(n));
      }
    }
  }
  std::sort(list.begin(), list.end(), [&](uint32_t a, uint32_t b) {
    return levels_[a] != levels_[b] ? levels_[a] > levels_[b] : a < b;
  });
  launches_.clear();
  for (uint32_t first = 0, end; first < list.size(); first = end) {
    end = first;
    while (end < list.size() && levels_[list[end]] == levels_[list[first]]) ++end;
    const uint32_t count = end - first;
    if (count <= few && !launches_.empty() && launches_.back().a_work_item > 1) {
      launches_.back().count += count;
      launches_.back().a_work_item += count;
    } else {
      launches_.push_back({first, count, count <= few ? std::max(count, 2u) : 1});
    }
  }
  put(device_, list_, list);
}

void RayRefit::refit(std::span<const size_t> moved, std::span<const RayInstance> instances,
                     std::span<const RayMeshData> meshes, std::span<const uint32_t> first_triangles,
                     const glm::dvec3& origin, const RayTreeBuffers& tree) {
  std::vector<RayMoved> records;
  std::vector<std::array<uint32_t, 2>> runs;
  for (const size_t i : moved) {
    const RayMeshData& mesh = meshes[instances[i].mesh];
    for (uint32_t first = 0; first < mesh.triangles(); first += run)
      runs.push_back({uint32_t(records.size()), first});
    records.push_back(ray_placement(instances[i], mesh, origin, first_triangles[i]));
  }
  if (runs.empty()) return;
  if (!has_positions_) upload_meshes(meshes);
  put(device_, records_, records);
  put(device_, runs_, runs);
  if (!std::ranges::equal(moved, moved_)) {
    find_nodes(records);
    moved_.assign(moved.begin(), moved.end());
  }
  if (!triangles_kernel_) {
    triangles_kernel_ = NamedKernel(programs_, "rays/refit_triangles", "");
    nodes_kernel_ = NamedKernel(programs_, "rays/refit_nodes", "");
  }
  triangles_kernel_.launch(device_, "rays_refit_triangles", cl::NDRange(runs.size() * run), cl::NDRange(run),
                           {{"moved", records_.get()},
                            {"runs", runs_.get()},
                            {"positions", positions_.get()},
                            {"indices", indices_.get()},
                            {"places", tree.places},
                            {"triangles", tree.triangles}});
  for (const Launch& l : launches_) {
    nodes_kernel_.launch(device_, "rays_refit_nodes",
                         cl::NDRange((l.count + l.a_work_item - 1) / l.a_work_item), cl::NullRange,
                         {{"nodes", tree.nodes},
                          {"triangles", tree.triangles},
                          {"wide_nodes", tree.wide_nodes},
                          {"slots", tree.slots},
                          {"list", list_.get()},
                          {"first", l.first},
                          {"count", l.count},
                          {"a_work_item", l.a_work_item}});
  }
}

size_t RayRefit::memory_bytes() const {
  return positions_.bytes() + indices_.bytes() + records_.bytes() + runs_.bytes() + list_.bytes();
}

}  // namespace lightgrid
