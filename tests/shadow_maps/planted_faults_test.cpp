// Faults planted into the text of the kernels that draw shadow maps and look them up: the card over a floor
// tells each of them from what is right.
#include <gtest/gtest.h>

#include "base/embedded.h"
#include "cl/transfer.h"
#include "rays/ray_packets.h"
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
    {"the farthest triangle", "draw_faces", "(value < old)", "((value > old) | (old == TEXEL_NOTHING))"},
    {"back faces alone", "draw_faces", "if (!(facing > 0 || facing < 0)) return;",
     "if (!(facing < 0)) return;"},
    {"centres half a texel aside", "draw_faces", "(0.5f - 0.5f * (float)f->size) * step",
     "(0.0f - 0.5f * (float)f->size) * step"},
    {"an edge's other side", "draw_faces", "lane_min(lane_min(e0, e1), e2)",
     "lane_min(lane_min(e0, e1), -e2)"},
};

std::string planted(const PlantedFault& fault) {
  std::string text = with_includes(fmt::format("kernels/shadow_maps/{}.cl", fault.kernel));
  const size_t at = text.find(fault.right);
  EXPECT_NE(at, std::string::npos) << fault.name;
  EXPECT_EQ(at, text.rfind(fault.right)) << fault.name;
  return at == std::string::npos ? text : text.replace(at, strlen(fault.right), fault.wrong);
}

std::vector<uint8_t> faulty_taps(const PlantedFault& fault, ShadowMaps& maps, const RayScene& rays,
                                 size_t faces) {
  const std::string defines =
      fmt::format("{} {} -DLANES={}", rays.defines(), maps.defines(), device().info().cpu ? 16 : 1);
  cl::Kernel kernel = programs().kernel_of_source(fault.kernel, planted(fault), defines);
  const auto run = [&](size_t items, const ClArguments& arguments) {
    cl_uint index = 0;
    for (const ClArgument& a : arguments) kernel.setArg(index++, a.bytes, a.value);
    device().queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(items));
    device().queue().finish();
  };
  const std::vector<RayPoint> points = floor_points();
  if (std::string(fault.kernel) == "draw_faces") {
    const ClArguments of_maps = maps.arguments();
    run(faces, rays.arguments() + ClArguments{of_maps[1], of_maps[2]});
    return taps_at(maps, rays, points);
  }
  std::vector<RayPacket> packets;
  for (uint32_t block = 0; block < points.size() / 16; ++block) packets.push_back({block, 0});
  const PackedRays packed = packed_rays(points, 1, packets);
  UploadedBuffer on_device[3];
  on_device[0].put(device(), "points", packed.points), on_device[1].put(device(), "own", packed.own);
  on_device[2].put(device(), "packets", packed.packets);
  std::vector<uint8_t> taps(points.size());
  const cl::Buffer answers = device_buffer(device(), taps.size());
  run(packets.size(), rays.arguments() + maps.arguments() +
                          ClArguments{{"points", on_device[0].buffer()},
                                      {"own", on_device[1].buffer()},
                                      {"packets", on_device[2].buffer()},
                                      {"taps", answers}});
  read_buffer(device(), "taps", answers, taps.data(), taps.size());
  return taps;
}

TEST(ShadowMapFaults, EachIsFound) {
  const RayScene rays = card_over_floor();
  for (const PlantedFault& fault : faults) {
    Light light = lamp(LightType::point);
    light.radius_m = fault.radius_m;
    const ShadowMapOptions options{.size = 256, .bits = fault.bits, .taps = fault.taps};
    ShadowMaps maps(device(), programs(), options);
    const ShadowAtlas atlas = plan_shadow_atlas({&light, 1}, view_from(5), rays.origin(), room, options);
    maps.draw(rays, atlas);
    const Wrong wrong = wrong_points(light, options, faulty_taps(fault, maps, rays, atlas.faces.size()));
    const bool found = wrong.furthest_m > most_wrong_m(light, options);
    EXPECT_EQ(found, std::string(fault.name) != "none")
        << fault.name << ": " << wrong.leaked << " leaked, " << wrong.acned << " acned, up to "
        << wrong.furthest_m << " m from the edge";
  }
}

}  // namespace
}  // namespace lightgrid
