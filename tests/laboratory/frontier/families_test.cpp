// Families of lights: what is equal in each, by counts of its own; and what their records say.
#include "frontier/families.h"

#include <gmock/gmock.h>

#include <cmath>

#include "accuracy/oracle.h"
#include "frontier/answer.h"
#include "frontier/synthetic_records.h"
#include "scene/light_rigs.h"
#include "support/devices.h"
#include "support/temp_folder.h"

namespace lightgrid::lab {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

TEST(FamilyScale, IsWhereTheOverlapIsReachedWithinItsTolerance) {
  for (const double power : {0.5, 2.0, 3.0}) {
    for (const double factor : {1e-3, 1.0, 400.0}) {
      const auto overlap = [&](double scale) { return factor * std::pow(scale, power); };
      const auto scale = scale_of_overlap(10, overlap);
      if (overlap(1e4) < 10) continue;  // beyond what is tried
      ASSERT_TRUE(scale) << power << " " << factor;
      EXPECT_NEAR(overlap(*scale), 10, 10 * overlap_tolerance);
    }
  }
  const auto in_steps = scale_of_overlap(10, [](double scale) { return scale < 3 ? 0.0 : 10.05; });
  ASSERT_TRUE(in_steps) << "nothing below a range";
  EXPECT_GE(*in_steps, 3);
  EXPECT_FALSE(scale_of_overlap(10, [](double scale) { return std::min(scale, 9.0); }));
}

// In world space, from the pixel's centre and its distance along the view: no code of the oracle.
double counted_overlap(const Scene& scene, const View& view, const std::vector<float>& depth) {
  const glm::dmat4 world_from_clip = glm::inverse(view.clip_from_view * view.view_from_world);
  double lit = 0, covered = 0;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const float d = depth[size_t(y) * size_t(view.width) + size_t(x)];
      if (!(d > 0)) continue;
      ++covered;
      const glm::dvec4 clip(2 * (x + 0.5) / view.width - 1, 2 * (y + 0.5) / view.height - 1, double(d), 1);
      const glm::dvec4 world = world_from_clip * clip;
      const glm::dvec3 at = glm::dvec3(world) / world.w;
      for (const Light& light : scene.lights) {
        const glm::dvec3 offset = at - glm::dvec3(light.position);
        const bool in_range = glm::length(offset) < double(light.radius_m);
        const bool in_cone =
            light.type != LightType::spot || glm::dot(glm::normalize(offset), glm::dvec3(light.direction)) >
                                                 std::cos(double(light.outer_cone_rad));
        lit += in_range && in_cone;
      }
    }
  }
  return lit / covered;
}

struct SmallFamily : testing::Test {
  SmallFamily() : chosen(load_chosen_scene(choice())) {
    job.families = FamilyPlan{.lights = {40, 160}, .overlap = 6, .overlaps = {2, 30}, .number = 160};
    job.points = chosen_points({"forward_plus", "visibility", "visibility:range=infinite"}, {}, {}, true);
    job.baseline = baseline_point({}, true);
  }
  static SceneChoice choice() {
    SceneChoice choice;
    choice.scene = "terrain";
    choice.size = "48x27";
    return choice;
  }
  std::vector<float> depth() {
    TechniqueRun run(software_devices(), chosen.scene, chosen.view, {}, find_technique("forward_plus"));
    run.run_frame(true);
    return read_depth(run);
  }
  std::vector<FrontierRecord> measured() {
    const TempFolder folder;
    FrontierPart part;
    part.baseline = job.baseline.label;
    RecordFile file(folder.path / "part.jsonl", part, nullptr);
    const size_t own = chosen.scene.lights.size();
    measure_families(software_devices(), chosen.scene, choice(), job, file);
    EXPECT_EQ(chosen.scene.lights.size(), own) << "left as it was";
    return file.part().records;
  }
  ChosenScene chosen;
  FrontierJob job;
};

TEST_F(SmallFamily, CountsTheOverlapThatItsLightsHave) {
  const std::vector<float> of_surfaces = depth();
  chosen.scene.lights = scatter_lights(chosen.scene, {.count = 160});
  for (const float scale : {0.5f, 1.0f, 3.0f}) {
    Scene scaled = chosen.scene;
    for (Light& light : scaled.lights) light.radius_m *= scale;
    const double counted = counted_overlap(scaled, chosen.view, of_surfaces);
    EXPECT_GT(counted, 0.5);
    EXPECT_NEAR(overlap_of(scaled, chosen.view, of_surfaces), counted, 1e-3 * counted) << scale;
  }
}

TEST_F(SmallFamily, TurnsOneKnobAndLosesNoLight) {
  const std::vector<FrontierRecord> records = measured();
  ASSERT_THAT(records, SizeIs(4 * 3));
  std::map<std::string, std::vector<std::pair<int, double>>> steps;
  for (const FrontierRecord& r : records) {
    EXPECT_EQ(r.refused, "") << r.point.label;
    EXPECT_EQ(r.pairs.lost, 0u) << r.point.label;
    EXPECT_EQ(r.pairs.wrong, 0u) << r.point.label;
    EXPECT_EQ(r.frame_ms.size(), 4u);
    EXPECT_FALSE(r.pass_ms.empty());
    EXPECT_EQ(r.pass_ms.size(), r.pass_bytes.size());
    const double total = r.errors.total.displayed->mean, authored = r.errors.authored->total.displayed->mean;
    if (r.point.label == "visibility:range=infinite") {
      EXPECT_EQ(total, 0) << "it is the truth";
      EXPECT_GT(authored, 0.01) << "ranges are seen";
      continue;
    }
    EXPECT_LT(authored, 1e-4) << r.point.label << ": exact lists";
    EXPECT_GT(total, 0.01) << r.point.label;
    // By the lists' oracle, another one than that which found the scale; OpenGL's surfaces and the
    // rasterizer's differ at edges.
    const double lit = double(r.pairs.lit) / double(r.covered_pixels);
    EXPECT_NEAR(lit, *r.overlap, 0.02 * *r.overlap) << r.point.label;
    if (r.point.label == "visibility") steps[r.series].emplace_back(r.lights, *r.overlap);
  }
  const auto within = [](double overlap) {
    return testing::DoubleNear(overlap, overlap_tolerance * overlap);
  };
  EXPECT_THAT(steps["equal overlap"],
              ElementsAre(testing::Pair(40, within(6)), testing::Pair(160, within(6))));
  EXPECT_THAT(steps["overlap"], ElementsAre(testing::Pair(160, within(2)), testing::Pair(160, within(30))));
}

TEST_F(SmallFamily, RefusesWhatTakesTooLongAndDoesNotTryItOnMoreLights) {
  job.families->max_frame_s = 0;
  job.families->overlaps = {};
  const std::vector<FrontierRecord> records = measured();
  ASSERT_THAT(records, SizeIs(2 * 3));
  for (const FrontierRecord& r : records)
    EXPECT_THAT(r.refused, HasSubstr("a frame of 40 lights, ")) << r.lights << " " << r.point.label;
}

FrontierRecord of_family(const std::string& label, int lights, double ms, double flip) {
  FrontierRecord r = synthetic_record(synthetic_point("terrain", "visibility"), 1, flip, 0, 4);
  r.point.label = label;
  r.series = equal_overlap_series;
  r.overlap = 10;
  r.lights = lights;
  r.frame_ms = {ms, 3 * ms, ms, 3 * ms};  // picked on the first and third
  return r;
}

TEST(EqualFlips, AreTheCheapestPointsWithinTheErrorOnTheOtherRounds) {
  std::vector<FrontierRecord> records = {
      of_family("exact", 100, 5, 0),     of_family("rough", 100, 1, 0.05),
      of_family("exact", 1000, 50, 0),   of_family("rough", 1000, 2, 0.05),
      of_family("exact", 10000, 500, 0), of_family("rough", 10000, 4, 0.1)};
  records.push_back(of_family("refused", 100, 0.1, 0));
  records.back().refused = "too slow";
  records.push_back(of_family("of a series", 100, 0.1, 0));
  records.back().series = "lights";
  const FrontierAnswer answer = answer_from(records);
  std::vector<std::string> told;
  for (const EqualFlip& e : answer.equal_flip) {
    EXPECT_EQ(e.of, "total") << "there is no authored error";
    std::string text = fmt::format("{:g}:", e.error);
    for (const EqualFlip::Sample& s : e.samples) text += fmt::format(" {:g} {} {:g}", s.x, s.label, s.ms);
    told.push_back(text);
  }
  EXPECT_THAT(told, ElementsAre("0.001: 100 exact 15 1000 exact 150 10000 exact 1500",
                                "0.01: 100 exact 15 1000 exact 150 10000 exact 1500",
                                "0.06: 100 rough 3 1000 rough 6 10000 exact 1500",
                                "0.2: 100 rough 3 1000 rough 6 10000 rough 12"));
  EXPECT_NEAR(answer.equal_flip[0].exponent, 1, 1e-9);
  EXPECT_NEAR(answer.equal_flip[3].exponent, std::log10(2), 1e-9);
}

// By the devices' clocks another point is the cheapest; times are theirs.
TEST(EqualFlips, AreAlsoOfTheDevicesClocks) {
  std::vector<FrontierRecord> records = {of_family("exact", 100, 5, 0), of_family("rough", 100, 1, 0.05)};
  EXPECT_TRUE(answer_from(records).device_equal_flip.empty()) << "no device had a clock";
  for (FrontierRecord& r : records) {
    const double ms = r.point.label == "exact" ? 0.25 : 0.5;
    r.device_ms = {ms, 2 * ms, ms, 2 * ms};
    r.baseline_device_ms = {1, 1, 1, 1};
    r.hand_over_ms = r.copy_ms = r.read_back_ms = {0, 0, 0, 0};
  }
  const FrontierAnswer answer = answer_from(records);
  ASSERT_THAT(answer.device_equal_flip, SizeIs(4));  // one an error
  for (const EqualFlip& e : answer.device_equal_flip) {
    EXPECT_EQ(e.samples.front().label, "exact") << e.error;
    EXPECT_EQ(e.samples.front().ms, 0.5) << e.error;
  }
  EXPECT_EQ(answer.equal_flip.back().samples.front().label, "rough");
}

}  // namespace
}  // namespace lightgrid::lab
