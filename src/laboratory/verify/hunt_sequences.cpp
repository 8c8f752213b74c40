#include "verify/hunt_sequences.h"

#include <cmath>
#include <cstring>

#include <glm/gtc/matrix_transform.hpp>

#include "run/frames.h"
#include "scene/deform.h"

namespace lightgrid::lab::verify {
namespace {

using glm::dvec3;
using glm::dvec4;

constexpr SequenceKind kinds[] = {
    {"visibility", "shadow-reuse=on"},
    {"visibility", "shadow-reuse=on shadows=map", false},
    {"visibility", "shadow-reuse=on shadows=map shadow-filter=pcf3 shadow-bits=16 shadow-size=64", false},
    {"visibility", "shadow-reuse=on shadows=map shadow-blended=opaque shadow-bits=24 shadow-memory=1M",
     false},
    {"visibility", "shadow-reuse=on shadow-rays=4", false},
    {"visibility", "shadow-reuse=on shadow-pick=4", false},
    {"visibility", "shadow-reuse=on shadow-threshold=8", false},
    {"visibility", "shadow-reuse=on shadow-blended=alpha", false},
    {"visibility", "shadow-reuse=on shadow-memory=1M samples=4"},
    {"visibility", "shadow-cells=on"},
    {"visibility", "shadow-cells=on shadow-memory=1M"},
    {"visibility", "shadow-reuse=on far-light=512 range=cutoff cutoff=0.1", false},
    {"visibility", "shadow-reuse=on list-cap=4 list-cap-order=tree", false},
    {"visibility", "shadow-reuse=on list-cap=4 list-cap-order=brightest", false},
    {"deferred_tiled", "shadow-reuse=on raster=opencl"},
    {"light_prepass", "shadow-reuse=on raster=opencl"},
    {"world_grid", "shadow-reuse=on raster=opencl"},
    {"world_grid", "shadow-reuse=on raster=opencl world-grid=hashed"},
    {"world_grid", "shadow-reuse=on raster=opencl world-grid=2d shadows=map", false},
    {"voxel_lights", "shadow-reuse=on raster=opencl voxel-reuse=on voxel-size=16x16x4"},
    {"voxel_lights",
     "shadow-reuse=on raster=opencl voxel-reuse=on voxel-size=16x16x4 voxel-space=view voxel-lights-exact=2"},
    {"forward_plus", "shadow-reuse=on"},
    {"deferred", "shadow-reuse=on shadows=map", false},
    {"lidr", "shadow-reuse=on"},
    {"lidr", "lidr-packing=sort lidr-sort=still shadow-reuse=on"},
    {"lidr", "lidr-shadows=volumes", false},
    {"lidr", "lidr-shadows=prepass", false},
    {"lidr", "lidr-shadows=final lidr-maps=16", false},
};

void add_own(Scene& scene, Random& random) {
  if (random.next() % 3 == 0) {
    add_triangles(scene, quad_of({-1, -1, 0.3f}, {2, 0, 0.5f}, {0, 2, 0}), glm::dmat4(1), 2);
    scene.instances.back().world_from_object[3] = dvec4(scene.lights.front().position, 1);
  }
  if (random.next() % 4) return;
  Light& sun = scene.lights.emplace_back();
  sun.type = LightType::directional;
  sun.direction = any_direction(random);
  sun.casts_shadow = true;
}

// OpenGL's scene follows the meshes that a rig deforms.
std::shared_ptr<const Rig> rig_of(const Scene& scene) {
  const auto rig = std::make_shared<Rig>();
  rig->meshes.resize(scene.meshes.size());
  for (size_t i = 0; i < scene.meshes.size(); ++i) rig->meshes[i].mesh = int(i);
  return rig;
}

Scene to_move(Scene scene, Random& random) {
  add_own(scene, random);
  scene.rig = rig_of(scene);
  return scene;
}

}  // namespace

std::string difference(const SequenceFrame& a, const SequenceFrame& b) {
  const std::string in = difference(a.shadows, b.shadows);
  if (!in.empty()) return in;
  if (a.shadows.shadows.shares != b.shadows.shadows.shares) return "shares";
  const bool same = a.pixels.size() == b.pixels.size() &&
                    std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof a.pixels[0]) == 0;
  return same ? "" : "pixels";
}

std::span<const SequenceKind> sequence_kinds() { return kinds; }

MovingScene::MovingScene(HuntedScene made, bool deforms, Random& random)
    : views_(made.views),
      rest_(to_move(std::move(made.scene), random)),
      scene_(rest_),
      view_(views_.front()),
      deforms_(deforms),
      random_(random) {}

// From a thousandth of a millimetre on.
double MovingScene::step_m() { return std::exp2(double(random_.uniform(-20, 1))); }

SceneChanges MovingScene::move() {
  SceneChanges changes;
  for (uint64_t left = random_.next() % 4; left > 0; --left) {
    switch (random_.next() % 8) {
      case 0:
      case 1:
      case 2:
        move_light(changes);
        break;
      case 3:
        swap_lights(changes);
        break;
      case 4:
      case 5:
        move_instance(changes);
        break;
      case 6:
        if (deforms_) deform_mesh(changes);
        break;
      default:
        move_camera();
    }
  }
  return changes;
}

void MovingScene::move_light(SceneChanges& changes) {
  const size_t i = any_of(scene_.lights.size());
  Light& light = scene_.lights[i];
  const bool local = !is_directional(light);
  switch (random_.next() % 7) {
    case 0:
      light = rest_.lights[i];
      break;
    case 1:
      if (local) light.position = scene_.lights.front().position + any_direction(random_) * step_m();
      break;
    case 2:
      if (local) light.radius_m = random_.uniform(0.1f, 8);
      break;
    case 3:
      light.direction = any_direction(random_);
      break;
    case 4:  // as a hidden light has it
      light.intensity = 0;
      if (local) light.radius_m = 0;
      break;
    case 5:
      light.color = glm::vec3(random_.uniform(0.1f, 2), 1, random_.uniform(0.1f, 2));
      if (has_cone(light)) light.inner_cone_rad = light.outer_cone_rad *= random_.uniform(0.5f, 1);
      break;
    default:
      if (local) light.position += any_direction(random_) * step_m();
  }
  changes.lights.push_back(int(i));
}

// Swaps two lights of one type, both or neither of which cast shadows.
void MovingScene::swap_lights(SceneChanges& changes) {
  const size_t i = any_of(scene_.lights.size()), k = any_of(scene_.lights.size());
  Light &a = scene_.lights[i], &b = scene_.lights[k];
  if (i == k || a.type != b.type || a.casts_shadow != b.casts_shadow) return;
  std::swap(a, b);
  changes.lights.insert(changes.lights.end(), {int(i), int(k)});
}

void MovingScene::move_instance(SceneChanges& changes) {
  const size_t i = any_of(scene_.instances.size());
  glm::dmat4& m = scene_.instances[i].world_from_object;
  switch (random_.next() % 4) {
    case 0:
      m = rest_.instances[i].world_from_object;
      break;
    case 1:
      m = m * glm::rotate(glm::dmat4(1), double(random_.uniform(0, 6)), any_direction(random_));
      break;
    case 2:  // as a hidden instance has it
      m = glm::scale(glm::translate(glm::dmat4(1), dvec3(m[3])), dvec3(0x1p-40));
      break;
    default:
      m[3] += dvec4(any_direction(random_) * step_m(), 0);
  }
  changes.instances.push_back(int(i));
}

void MovingScene::deform_mesh(SceneChanges& changes) {
  const size_t i = any_of(scene_.meshes.size());
  Mesh& mesh = scene_.meshes[i];
  if (random_.next() % 4 == 0) {
    mesh = rest_.meshes[i];
  } else {
    const float by = float(step_m());
    const glm::vec3 towards(any_direction(random_));
    for (size_t k = random_.next() % 3; k < mesh.positions.size(); k += 1 + random_.next() % 16)
      mesh.positions[k] += towards * by * random_.uniform();
    mesh.normals.clear();
    complete_mesh(tangent_need(scene_.materials[size_t(mesh.material)]), mesh);
  }
  changes.meshes.push_back(int(i));
}

void MovingScene::move_camera() {
  switch (random_.next() % 3) {
    case 0:
      view_ = views_[any_of(views_.size())];
      break;
    case 1:
      view_.width = 1 + int(random_.next() % 130);
      view_.height = 1 + int(random_.next() % 90);
      break;
    default:
      move_eye(view_, any_direction(random_) * step_m());
  }
}

SequenceReport compare_sequence(CullEngine& engine, HuntedScene made, const SequenceKind& kind,
                                const Settings& settings, int frames, Random& random) {
  SequenceReport report;
  // OpenGL's order of a mesh's triangles, which decides between two in one place, follows its first shape.
  const bool deforms = !draws_with_opengl(find_technique(kind.technique).needs, settings);
  MovingScene moving(std::move(made), deforms, random);
  Settings of_tree = settings;
  apply_setting(of_tree, "shadow-cells=off");
  const std::unique_ptr<FrameSequence> keeping =
      engine.sequence(moving.scene(), kind.technique, moving.view(), settings);
  for (int i = 0; keeping && i < frames; ++i) {
    const SceneChanges changes = i ? moving.move() : SceneChanges();
    const SequenceFrame kept = keeping->draw(moving.view(), changes);
    const SequenceFrame fresh =
        engine.sequence(moving.scene(), kind.technique, moving.view(), of_tree)->draw(moving.view(), {});
    ++report.frames;
    if (const std::string in = difference(kept, fresh); !in.empty() && report.stale++ == 0)
      report.why = fmt::format("frame {} of {} {}: the kept {} differ", i, kind.technique, kind.settings, in);
    if (i + 1 == frames && kind.exact && !moving.has_sun() && !kept.shadows.triangles.empty())
      report.pairs =
          count_shadow_pairs(moving.scene(), Occlusion(moving.scene()), moving.view(), kept.shadows);
  }
  return report;
}

}  // namespace lightgrid::lab::verify
