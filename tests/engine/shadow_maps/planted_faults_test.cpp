// Faults planted into the text of the kernels that draw shadow maps and look them up: the card over a floor
// tells each of them from what is right.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "shadow_maps/card_over_floor.h"

namespace lightgrid {
namespace {

struct PlantedFault {
  const char *name, *kernel, *right, *wrong;
  int bits = 32, taps = 1;
  float radius_m = 8;
};

constexpr PlantedFault faults[] = {
    {"none", "look_up", "hidden += nearer", "hidden += nearer"},
    {"no bias", "look_up", "< expected - bias", "< expected"},
    {"no step of the format", "look_up", "texel_step(f->range_m, expected)", "0.0f", 16, 1, 2000},
    {"the point's distance for its plane's", "look_up", "lane_min(at_plane, p->furthest)", "p->z"},
    {"the plane of a filter's middle tap for all", "look_up", "const real across = p->nx * u + p->ny * v;",
     "const real across = p->nx * p->u + p->ny * p->v;", 32, 5},
    {"the face of the other side", "look_up", "< 0.0f ? (whole)(1) : (whole)(0)",
     "< 0.0f ? (whole)(0) : (whole)(1)"},
    {"the next face", "look_up", "const uint live = left & lane_bits(of.y == 6 ? face == (whole)((int)i)",
     "const uint live = left & lane_bits(of.y == 6 ? face == (whole)((int)(i ^ 2))"},
    {"rows for columns", "look_up", "y * (whole)((int)size) + x", "x * (whole)((int)size) + y"},
    {"a texel beside", "look_up", "lane_floor(p->u * p->to_texels + p->half_size)",
     "lane_floor(p->u * p->to_texels + p->half_size + 1.0f)"},
    {"the farthest triangle", "draw_faces", "(value < *texel)",
     "((value > *texel) | (*texel == TEXEL_NOTHING))"},
    {"back faces alone", "draw_faces", "(facing > 0.0f) | (facing < 0.0f)", "facing < 0.0f"},
    {"centres half a texel aside", "draw_faces", "(0.5f - 0.5f * (float)t->size) * t->step",
     "(0.0f - 0.5f * (float)t->size) * t->step"},
    {"an edge's other side", "draw_faces", "lane_min(lane_min(e0, e1), e2)",
     "lane_min(lane_min(e0, e1), -e2)"},
};

std::string planted(const PlantedFault& fault, std::string text) {
  if (text.find(fmt::format("kernel void {}(", fault.kernel)) == std::string::npos) return text;
  const size_t at = text.find(fault.right);
  EXPECT_NE(at, std::string::npos) << fault.name;
  EXPECT_EQ(at, text.rfind(fault.right)) << fault.name;
  return at == std::string::npos ? text : text.replace(at, strlen(fault.right), fault.wrong);
}

TEST(ShadowMapFaults, EachIsFound) {
  const RayScene rays = card_over_floor();
  for (const PlantedFault& fault : faults) {
    Light light = lamp(LightType::point);
    light.radius_m = fault.radius_m;
    const ShadowMapOptions options{.size = 256, .bits = fault.bits, .taps = fault.taps};
    ProgramCache faulty(device());
    faulty.alter([&](std::string text) { return planted(fault, std::move(text)); });
    ShadowMaps maps(device(), faulty, options);
    maps.draw(rays, plan_shadow_atlas({&light, 1}, view_from(5), rays.origin(), room, options));
    const Wrong wrong = wrong_points(light, options, taps_at(maps, rays, floor_points()));
    const bool found = wrong.furthest_m > max_wrong_m(light, options);
    EXPECT_EQ(found, std::string(fault.name) != "none")
        << fault.name << ": " << wrong.leaked << " leaked, " << wrong.acned << " acned, up to "
        << wrong.furthest_m << " m from the edge";
  }
}

}  // namespace
}  // namespace lightgrid
