// Every texel of maps of a soup of triangles against the nearest triangle in double, and the two shapes of
// kernels against each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "cl/transfer.h"
#include "shadow_maps/card_over_floor.h"

namespace lightgrid {
namespace {

using glm::dvec3;

// Around the origin: slivers, needles, specks, large ones that cross a light's planes, neighbours that share
// an edge, and two of everything in one place.
std::vector<glm::vec3> soup() {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(-1, 1);
  const auto point = [&](float scale) { return scale * glm::vec3(any(random), any(random), any(random)); };
  std::vector<glm::vec3> corners;
  for (int i = 0; i < 160; ++i) {
    const float size = std::exp2(float(i % 8) - 6);
    const glm::vec3 at = point(5), along = point(size), aside = point(i % 3 == 0 ? size * 1e-3f : size);
    for (const glm::vec3& p : {at, at + along, at + aside}) corners.push_back(p);
    if (i % 4 == 0)
      for (const glm::vec3& p : {at + along, at, at - aside}) corners.push_back(p);
    if (i % 5 == 0)
      for (int k = 0; k < 3; ++k) corners.push_back(corners[corners.size() - 3]);
  }
  for (int i = 0; i < 24; ++i)
    for (int k = 0; k < 3; ++k) corners.push_back(point(20));
  return corners;
}

RayScene scene_of_soup() {
  const std::vector<glm::vec3> corners = soup();
  std::vector<uint32_t> indices(corners.size());
  for (uint32_t i = 0; i < indices.size(); ++i) indices[i] = i;
  return scene_of(corners, indices);
}

std::vector<Light> lights_in_soup() {
  std::vector<Light> lights;
  for (const LightType type : {LightType::point, LightType::spot, LightType::directional})
    lights.push_back(lamp(type));
  lights[0].position = {0.1f, 0.2f, -0.3f};
  return lights;
}

const WorldBox soup_box{glm::dvec3(-20), glm::dvec3(20)};

ShadowAtlas atlas_of_soup(const ShadowMapOptions& options) {
  return plan_shadow_atlas(lights_in_soup(), view_from(5), glm::dvec3(0), soup_box, options);
}

std::vector<uint8_t> texels_of(ProgramCache& kernels, const ShadowMapOptions& options) {
  ShadowMaps maps(device(), kernels, options);
  const ShadowAtlas atlas = atlas_of_soup(options);
  const RayScene rays = scene_of_soup();
  maps.draw(rays, atlas);
  std::vector<uint8_t> bytes(atlas.bytes);
  read_buffer(device(), "texels", maps.texels(), bytes.data(), bytes.size());
  return bytes;
}

// The nearest triangle's distance is at least `low`, and no more than `high`.
struct Distances {
  double low = HUGE_VAL, high = HUGE_VAL;
};

// In the face's axes.
struct SeenTriangle {
  dvec3 edges[3];  // dot(edge, r) > 0 inside, for a direction r of z 1, or where parallel a place
  double margins[3];
  dvec3 normal;
  double offset, nearest, furthest, error_m;
};

// False: the face's light sees nothing of it.
bool see(const dvec3 (&corners)[3], const ShadowFace& face, SeenTriangle* t) {
  const auto& [a, b, c] = corners;
  t->normal = glm::normalize(glm::cross(b - a, c - a));
  t->offset = glm::dot(t->normal, a);
  t->nearest = std::max(std::min({a.z, b.z, c.z}), 0.0);
  t->furthest = std::max({a.z, b.z, c.z});
  const double facing = face.parallel ? t->normal.z : t->offset;
  for (int k = 0; k < 3; ++k) {
    dvec3 p = corners[k], q = corners[(k + 1) % 3];
    if (face.parallel) p.z = q.z = 1;
    t->edges[k] = glm::cross(p, q) * (facing < 0 ? -1.0 : 1.0);
    t->margins[k] = 1e-6 * glm::length(p - q) * (glm::length(p) + glm::length(q));
  }
  t->error_m = 1e-5 * (glm::length(a) + glm::length(b) + glm::length(c));
  return t->furthest > 0 && t->nearest <= double(face.range_m);
}

// A texel next to an edge may be in or out.
void add_triangle(const SeenTriangle& t, const dvec3& r, const ShadowFace& face, Distances* d) {
  const double length = glm::length(r);
  bool inside = true;
  for (int k = 0; k < 3; ++k) {
    const double side = glm::dot(t.edges[k], r), margin = t.margins[k] * length;
    if (side < -margin) return;
    inside &= side > margin;
  }
  const double towards = face.parallel ? t.normal.z : glm::dot(t.normal, r);
  const double sine = std::abs(towards) / (face.parallel ? 1 : length), margin = t.error_m / sine;
  const double at =
      face.parallel ? (t.offset - t.normal.x * r.x - t.normal.y * r.y) / t.normal.z : t.offset / towards;
  const bool sure = sine > 1e-4;  // its distance is certain, else somewhere in the triangle
  const double low = sure ? std::clamp(at - margin, t.nearest, t.furthest) : t.nearest,
               high = sure ? std::clamp(at + margin, t.nearest, t.furthest) : t.furthest;
  d->low = std::min(d->low, low);
  if (inside && sure && high < double(face.range_m) * (1 - 1e-5)) d->high = std::min(d->high, high);
}

struct Checked {
  size_t wrong = 0, sure = 0, covered = 0;
};

Checked check(const std::vector<uint8_t>& bytes, const ShadowMapOptions& options) {
  const ShadowAtlas atlas = atlas_of_soup(options);
  const std::vector<glm::vec3> corners = soup();
  Checked checked;
  for (const ShadowFace& face : atlas.faces) {
    const dvec3 right = axis(face.right), up = axis(face.up), ahead = axis(face.ahead),
                from = axis(face.from);
    std::vector<SeenTriangle> triangles;
    for (size_t i = 0; i < corners.size(); i += 3) {
      dvec3 in_face[3];
      for (size_t k = 0; k < 3; ++k) {
        const dvec3 p = dvec3(corners[i + k]) - from;
        in_face[k] = {glm::dot(right, p), glm::dot(up, p), glm::dot(ahead, p)};
      }
      SeenTriangle t;
      if (see(in_face, face, &t)) triangles.push_back(t);
    }
    for (uint y = 0; y < face.size; ++y) {
      for (uint x = 0; x < face.size; ++x) {
        const dvec3 r(((x + 0.5) * 2 / face.size - 1) * double(face.extent),
                      ((y + 0.5) * 2 / face.size - 1) * double(face.extent), 1);
        Distances d;
        for (const SeenTriangle& t : triangles) add_triangle(t, r, face, &d);
        float texel;
        memcpy(&texel, &bytes[(face.first + y * face.size + x) * sizeof texel], sizeof texel);
        checked.covered += std::isfinite(texel);
        checked.sure += std::isfinite(d.high) && d.high - d.low < 1e-2;
        // Beyond the light's range, but not so far ahead, a triangle may be left out.
        const double reach = double(face.range_m) / (face.parallel ? 1 : glm::length(r));
        checked.wrong += double(texel) < d.low || (double(texel) > d.high && d.high < reach);
      }
    }
  }
  return checked;
}

constexpr ShadowMapOptions small_faces{.size = 128, .cascades = 2};

TEST(DrawFaces, EachTexelHoldsTheNearestTriangle) {
  const Checked checked = check(texels_of(programs(), small_faces), small_faces);
  EXPECT_EQ(checked.wrong, 0u);
  EXPECT_GT(checked.covered, 20000u);
  EXPECT_GT(checked.sure, checked.covered * 9 / 10);
}

// Which the card over a floor does not tell from what is right.
TEST(DrawFaces, FaultsOfTilesAreFound) {
  struct {
    const char *right, *wrong;
  } constexpr faults[] = {
      {"(float)(t->x + t->side - 1)", "(float)t->x"},  // a tile ends where it begins
      {"farthest = lane_max(farthest,", "farthest = lane_min(farthest,"},
      {"d->nearest = lane_max(nearest, REAL(0.0f));", "d->nearest = d->furthest;"},
      {"if (any_lane(crossing))", "if (any_lane(crossing & 0))"},
      {"p.x > 0.0f ? d->right : d->left", "p.x > 0.0f ? d->left : d->right"},
  };
  for (const auto& fault : faults) {
    ProgramCache faulty(device());
    faulty.alter([&](std::string text) {
      const size_t at = text.find(fault.right);
      EXPECT_NE(at, std::string::npos) << fault.right;
      return at == std::string::npos ? text : text.replace(at, strlen(fault.right), fault.wrong);
    });
    EXPECT_GT(check(texels_of(faulty, small_faces), small_faces).wrong, 0u) << fault.right;
  }
}

// Cells of 2 mm, 5 m away in the corner of a face, whose edges a product of their ends would round to half a
// millimetre.
TEST(DrawFaces, AFineMeshHasNoHoles) {
  constexpr int side = 200;
  constexpr glm::vec2 middle(2.8f, 2.7f);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> any(-0.3f, 0.3f);
  std::vector<glm::vec3> corners;
  std::vector<uint32_t> indices;
  for (int i = 0; i < side * side; ++i) {
    const glm::vec2 cell(float(i % side) + any(random), float(i / side) + any(random));
    const glm::vec2 at = middle + turned((cell - 0.5f * side) * 2e-3f, 0.3);
    corners.push_back({at.x, 1e-3f * any(random), at.y});
    if (i % side == side - 1 || i / side == side - 1) continue;
    const uint32_t k = uint32_t(i);
    for (const uint32_t j : {k, k + 1, k + side, k + 1, k + side + 1, k + side}) indices.push_back(j);
  }
  const RayScene rays = scene_of(corners, indices);
  const Light light = lamp(LightType::point);
  const ShadowMapOptions options{.size = 2048};
  const ShadowAtlas atlas = plan_shadow_atlas({&light, 1}, view_from(5), rays.origin(), room, options);
  ShadowMaps maps(device(), programs(), options);
  maps.draw(rays, atlas);
  std::vector<float> texels(atlas.texels);
  read_buffer(device(), "texels", maps.texels(), texels.data(), atlas.bytes);
  const ShadowFace& below = atlas.faces[3];
  int seen = 0, holes = 0;
  for (uint y = 0; y < below.size; ++y) {
    for (uint x = 0; x < below.size; ++x) {
      const auto place = [&](uint k) { return (double(2 * k + 1) / below.size - 1) * light_height_m; };
      const dvec3 at = axis(below.right) * place(x) + axis(below.up) * place(y);
      if (glm::length(glm::dvec2(at.x, at.z) - glm::dvec2(middle)) > 0.19) continue;
      ++seen;
      holes += !(std::abs(texels[below.first + y * below.size + x] - light_height_m) < 1e-3);
    }
  }
  EXPECT_GT(seen, 10000);
  EXPECT_EQ(holes, 0);
}

TEST(DrawFaces, BothShapesWriteTheSameBytes) {
  for (const int bits : {16, 24, 32}) {
    ShadowMapOptions lanes{.size = 256, .bits = bits, .taps = 3, .shape = KernelShape::lanes}, group = lanes;
    group.shape = KernelShape::group;
    EXPECT_EQ(texels_of(programs(), lanes), texels_of(programs(), group)) << bits;
  }
}

TEST(DrawFaces, FacesOfEachSizeAreDrawn) {
  for (const int size : {16, 32, 64}) {
    const ShadowMapOptions options{.size = size};
    EXPECT_EQ(check(texels_of(programs(), options), options).wrong, 0u) << size;
  }
}

// Where a device gives the larger buffer the old one's handle, its texels are still lost.
TEST(DrawFaces, KeptFacesAreDrawnAgainInABufferThatGrew) {
  const ShadowMapOptions options{.size = 256};
  const RayScene rays = scene_of_soup();
  const Light light = lights_in_soup()[0];
  ShadowAtlas atlas = plan_shadow_atlas({&light, 1}, view_from(5), glm::dvec3(0), soup_box, options);
  const size_t faces = atlas.faces.size(), bytes = atlas.bytes;
  ShadowMaps maps(device(), programs(), options);
  const auto texels = [&] {
    std::vector<uint8_t> read(bytes);
    read_buffer(device(), "texels", maps.texels(), read.data(), bytes);
    return read;
  };
  maps.draw(rays, atlas);
  const std::vector<uint8_t> drawn = texels();
  for (int growth = 0; growth < 12; ++growth) {
    const uint32_t first = uint32_t(atlas.texels);
    for (size_t face = 0; face < faces; ++face) {
      atlas.faces.push_back(atlas.faces[face]);
      atlas.faces.back().first += first;
    }
    atlas.texels += bytes / sizeof(float);
    atlas.bytes += bytes;
    maps.draw(rays, atlas, std::vector<uint8_t>(faces, 1));
    EXPECT_EQ(texels() == drawn, true) << growth;
  }
}

}  // namespace
}  // namespace lightgrid
