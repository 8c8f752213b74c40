#include "rays/ray_arrays.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"

namespace lightgrid {
namespace {

constexpr uint64_t most_triangles = 0x7fffffffu;  // the top bit is RAY_MASKED
constexpr float most_extent = 0x1p50f;            // metres: products of three stay finite
constexpr uint32_t triangles_a_task = 4096;

bool all_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// kernels/rays/refit_triangles.cl has the same arithmetic from here to triangle_of.
glm::dvec3 placed(const RayMoved& m, const glm::vec3& v) {
  glm::dvec3 p;
  for (int k = 0; k < 3; ++k)
    p[k] = m.x[k] * double(v.x) + m.y[k] * double(v.y) + m.z[k] * double(v.z) + m.at[k];
  return p;
}

// Divided by its greatest component, so that it stays in float's range for any size of triangle.
glm::dvec3 normal_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 n = glm::cross(b - a, c - a);
  const double greatest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
  return greatest > 0 ? n / greatest : glm::dvec3(0);
}

RayTriangle triangle_of(const glm::vec3 (&corners)[3], uint32_t number) {
  RayTriangle t{.number = number};
  const glm::dvec3 normal = normal_of(corners[0], corners[1], corners[2]);
  for (int k = 0; k < 3; ++k) {
    t.normal[k] = normal[k];
    for (int i = 0; i < 3; ++i) t.corners[3 * i + k] = corners[i][k];
  }
  return t;
}

RayBox box_of(const RayTriangle& t) {
  RayBox box;
  for (int i = 0; i < 3; ++i) box.add({t.corners[3 * i], t.corners[3 * i + 1], t.corners[3 * i + 2]});
  return box;
}

bool fits(const RayTriangle& t) {
  return std::all_of(t.corners, t.corners + 9, [](float v) { return std::abs(v) <= most_extent; });
}

// Calls body(instance's number, first triangle of its mesh, last + 1, number of the first) on all cores.
template <typename Body>
void for_triangles(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes,
                   const Body& body) {
  struct Part {
    size_t instance;
    uint32_t first, end, number;
  };
  std::vector<Part> parts;
  uint32_t number = 0;
  for (size_t i = 0; i < instances.size(); ++i) {
    const uint32_t count = meshes[instances[i].mesh].triangles();
    for (uint32_t first = 0; first < count; first += triangles_a_task)
      parts.push_back({i, first, std::min(count, first + triangles_a_task), number + first});
    number += count;
  }
  parallel_for(int(parts.size()), [&](int i) {
    const Part& p = parts[i];
    body(p.instance, p.first, p.end, p.number);
  });
}

}  // namespace

std::vector<RayMeshData> ray_meshes(std::span<const RayMesh> meshes) {
  std::vector<RayMeshData> made;
  size_t indices = 0, vertices = 0;
  for (size_t m = 0; m < meshes.size(); ++m) {
    const RayMesh& mesh = meshes[m];
    if (mesh.indices.size() % 3 != 0)
      throw input_error("rays: mesh {}: {} indices are no triangles", m, mesh.indices.size());
    RayMeshData& data =
        made.emplace_back(RayMeshData{.first_index = uint32_t(indices), .first_vertex = uint32_t(vertices)});
    indices += mesh.indices.size(), vertices += mesh.positions.size();
    if (std::max(indices, vertices) > 0xffffffffu)
      throw machine_error("rays: meshes have 2^32 indices or vertices or more");
    for (const uint32_t i : mesh.indices) {
      if (i >= mesh.positions.size())
        throw input_error("rays: mesh {}: index {} is past its {} positions", m, i, mesh.positions.size());
      const glm::dvec3 p(mesh.positions[i]);
      if (!all_finite(p))
        data.finite = false;
      else
        data.low = glm::min(data.low, p), data.high = glm::max(data.high, p);
    }
    data.positions.assign(mesh.positions.begin(), mesh.positions.end());
    data.indices.assign(mesh.indices.begin(), mesh.indices.end());
  }
  return made;
}

void check_ray_instances(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes) {
  uint64_t triangles = 0;
  for (size_t i = 0; i < instances.size(); ++i) {
    const RayInstance& instance = instances[i];
    if (instance.mesh < 0 || size_t(instance.mesh) >= meshes.size())
      throw input_error("rays: instance {} has mesh {} of {}", i, instance.mesh, meshes.size());
    const glm::dmat4& m = instance.world_from_object;
    for (int column = 0; column < 4; ++column) {
      if (!all_finite(glm::dvec3(m[column])) || m[column][3] != (column == 3 ? 1 : 0))
        throw input_error("rays: instance {}: world_from_object is not finite and affine", i);
    }
    triangles += meshes[instance.mesh].triangles();
  }
  if (triangles > most_triangles)
    throw machine_error("rays: instances have {} triangles, 2^31 or more", triangles);
}

RayBounds ray_bounds(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes) {
  RayBounds all{glm::dvec3(HUGE_VAL), glm::dvec3(-HUGE_VAL)};
  for (const RayInstance& instance : instances) {
    const RayMeshData& mesh = meshes[instance.mesh];
    all.finite = all.finite && mesh.finite;
    if (!(mesh.low.x <= mesh.high.x)) continue;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 p(corner & 1 ? mesh.high.x : mesh.low.x, corner & 2 ? mesh.high.y : mesh.low.y,
                         corner & 4 ? mesh.high.z : mesh.low.z);
      const glm::dvec3 q(instance.world_from_object * glm::dvec4(p, 1));
      if (!all_finite(q))
        all.finite = false;
      else
        all.low = glm::min(all.low, q), all.high = glm::max(all.high, q);
    }
  }
  if (!(all.low.x <= all.high.x)) all.low = all.high = glm::dvec3(0);
  return all;
}

// A little more than the bounds, which are of other sums than corners are.
static double reach_of(const RayBounds& bounds, const glm::dvec3& origin) {
  const glm::dvec3 far = glm::max(glm::abs(bounds.low - origin), glm::abs(bounds.high - origin));
  return std::max({far.x, far.y, far.z}) * (1 + 0x1p-20);
}

bool all_are_valid(const RayBounds& bounds, const glm::dvec3& origin) {
  return bounds.finite && reach_of(bounds, origin) <= most_extent;
}

float ray_extent(const RayBounds& bounds, const glm::dvec3& origin) {
  const double reach = reach_of(bounds, origin);
  return reach <= most_extent ? float(std::exp2(std::ceil(std::log2(std::max(reach, 0x1p-60)))))
                              : most_extent;
}

RayMoved ray_placement(const RayInstance& instance, const RayMeshData& mesh, const glm::dvec3& origin,
                       uint32_t first_triangle) {
  RayMoved moved{.first_triangle = first_triangle,
                 .triangles = mesh.triangles(),
                 .first_index = mesh.first_index,
                 .first_vertex = mesh.first_vertex};
  const glm::dmat4& m = instance.world_from_object;
  for (int k = 0; k < 3; ++k)
    moved.x[k] = m[0][k], moved.y[k] = m[1][k], moved.z[k] = m[2][k], moved.at[k] = m[3][k] - origin[k];
  return moved;
}

RayArrays ray_arrays(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes,
                     const glm::dvec3& origin) {
  size_t count = 0;
  bool masked = false;
  for (const RayInstance& instance : instances) {
    count += meshes[instance.mesh].triangles();
    masked = masked || (instance.casts && instance.alpha_material >= 0);
  }
  std::vector<RayTriangle> by_number(count);
  std::vector<std::array<uint32_t, 4>> masks(masked ? count : 0);
  enum Kind : uint8_t { in_tree, no_caster, invalid };
  std::vector<Kind> kinds(count);
  for_triangles(instances, meshes, [&](size_t i, uint32_t first, uint32_t end, uint32_t number) {
    const RayInstance& instance = instances[i];
    const RayMeshData& mesh = meshes[instance.mesh];
    const RayMoved place = ray_placement(instance, mesh, origin, 0);
    const bool is_masked = instance.casts && instance.alpha_material >= 0;
    for (uint32_t t = first; t < end; ++t, ++number) {
      const uint32_t* at = &mesh.indices[3 * size_t(t)];
      glm::vec3 corners[3];
      for (int k = 0; k < 3; ++k) corners[k] = glm::vec3(placed(place, mesh.positions[at[k]]));
      by_number[number] = triangle_of(corners, is_masked ? number | RAY_MASKED : number);
      kinds[number] = !fits(by_number[number]) ? invalid : instance.casts ? in_tree : no_caster;
      if (!is_masked) continue;
      const uint32_t v = mesh.first_vertex;
      masks[number] = {uint32_t(instance.alpha_material), v + at[0], v + at[1], v + at[2]};
    }
  });

  RayArrays arrays;
  std::vector<RayBox> boxes;
  std::vector<uint32_t> numbers, others;
  for (uint32_t number = 0; number < count; ++number) {
    arrays.invalid += kinds[number] == invalid;
    if (kinds[number] != in_tree) {
      others.push_back(number);
      continue;
    }
    numbers.push_back(number);
    boxes.push_back(box_of(by_number[number]));
  }
  RayTree tree = ray_tree(boxes);
  arrays.nodes = std::move(tree.nodes);
  arrays.places.resize(count);
  arrays.triangles.reserve(count);
  const auto append = [&](uint32_t number) {
    arrays.places[number] = uint32_t(arrays.triangles.size());
    arrays.triangles.push_back(by_number[number]);
    if (masked) arrays.masks.push_back(masks[number]);
  };
  for (const uint32_t i : tree.order) append(numbers[i]);
  for (const uint32_t number : others) append(number);
  return arrays;
}

}  // namespace lightgrid
