// Soups as scenes of one mesh and some instances, their answers, and what the oracle says of them.
#pragma once

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "rays/ray_oracle.h"

namespace lightgrid {

// A mesh of its own for each placement; triangles come out relative to the scene's origin.
struct Placed {
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
  std::vector<RayInstance> instances;
  std::vector<Corners> relative(const glm::dvec3& origin) const {
    std::vector<Corners> made;
    for (const RayInstance& instance : instances) {
      for (size_t i = 0; i < indices.size(); i += 3) {
        Corners& c = made.emplace_back();
        for (int k = 0; k < 3; ++k) {
          const glm::dvec4 at(glm::dvec3(positions[indices[i + k]]), 1);
          c[k] = glm::vec3(glm::dvec3(instance.world_from_object * at) - origin);
        }
      }
    }
    return made;
  }
};

inline Placed placed(const std::vector<Corners>& triangles,
                     std::vector<glm::dmat4> places = {glm::dmat4(1)}) {
  Placed made;
  for (const Corners& c : triangles) {
    for (const glm::vec3& p : c) {
      made.indices.push_back(uint32_t(made.positions.size()));
      made.positions.push_back(p);
    }
  }
  for (const glm::dmat4& m : places) made.instances.push_back({0, m});
  return made;
}

inline void set(RayScene& scene, const Placed& p) {
  const RayMesh mesh{p.positions, p.indices};
  scene.set_meshes({&mesh, 1});
  scene.set_instances(p.instances);
}

inline RayScene scene_of(const Placed& p, const RayOptions& options = {}) {
  RayScene scene(rays_device(), rays_programs(), options);
  set(scene, p);
  return scene;
}

inline std::vector<uint32_t> answers(const Placed& p, const Queries& q,
                                     KernelShape shape = KernelShape::lanes) {
  RayScene scene = scene_of(p, {.shape = shape});
  return scene.occlusion(q.points, q.lights, q.packets);
}

struct Tally {
  size_t hidden = 0, seen = 0, either = 0, leaked = 0, acned = 0;
  Tally& operator+=(const Tally& t) {
    hidden += t.hidden;
    seen += t.seen;
    either += t.either;
    leaked += t.leaked;
    acned += t.acned;
    return *this;
  }
};

inline Tally against_oracle(const std::vector<Corners>& triangles, const Queries& q,
                            const std::vector<uint32_t>& bits) {
  std::vector<Tally> tallies(q.packets.size());
  parallel_for(int(q.packets.size()), [&](int i) {
    const RayPacket& packet = q.packets[i];
    Tally& t = tallies[i];
    for (int lane = 0; lane < 16; ++lane) {
      const bool hidden = bits[i] >> lane & 1;
      if (!(packet.lanes >> lane & 1)) {
        t.acned += hidden;  // was not asked for
        continue;
      }
      const Answer answer =
          RayOracle::all(triangles, q.lights[packet.light], q.points[packet.block * 16 + lane]);
      ++(answer == Answer::either ? t.either : answer == Answer::yes ? t.hidden : t.seen);
      t.leaked += answer == Answer::yes && !hidden;
      t.acned += answer == Answer::no && hidden;
    }
  });
  Tally sum;
  for (const Tally& t : tallies) sum += t;
  return sum;
}

inline void expect_exact(const Tally& t, double max_either) {
  const size_t pairs = t.hidden + t.seen + t.either;
  EXPECT_EQ(t.leaked, 0u);
  EXPECT_EQ(t.acned, 0u);
  EXPECT_GT(t.hidden, pairs / 200);
  EXPECT_GT(t.seen, pairs / 200);
  EXPECT_LT(double(t.either), max_either * double(pairs));
}

}  // namespace lightgrid
