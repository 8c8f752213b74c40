// The hunt finds no loss in the library; it finds, saves and reduces the losses of a culler without slack.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "reference/lit_set.h"
#include "capture/frame_lists.h"
#include "verify/hunt.h"
#include "verify/hunt_save.h"
#include "support/run_program.h"
#include "support/temp_folder.h"

namespace lightgrid::verify {
namespace {

// Subtracts the slack of docs/hard_cases.md#slack from each light before the library adds it.
class WithoutSlack : public CullEngine {
 public:
  WithoutSlack() : library_(device_engine("")) {}
  std::string name() const override { return "without slack"; }
  bool is_the_library() const override { return false; }

  HostGrid cull(const CullerOptions& options, const CullView& view, std::span<const CullLight> lights,
                std::span<const DepthInterval> bounds) override {
    return library_->cull(options, view, smaller(view, lights), bounds);
  }
  std::vector<DepthInterval> depth_bounds(const CullerOptions& options, const CullView& view, const DepthImage& depth,
                                          bool blend) override {
    return library_->depth_bounds(options, view, depth, blend);
  }
  HostGrid cull_depth(const CullerOptions& options, const CullView& view, std::span<const CullLight> lights,
                      const DepthImage& depth, bool blend) override {
    return library_->cull_depth(options, view, smaller(view, lights), depth, blend);
  }

 private:
  static std::vector<CullLight> smaller(const CullView& view, std::span<const CullLight> lights) {
    std::vector<CullLight> made(lights.begin(), lights.end());
    for (CullLight& light : made) {
      const glm::dvec3 p = glm::abs(to_view(view, light.position));
      light.radius_m = std::max(0.0, light.radius_m - 64 * 0x1p-24 * (p.x + p.y + p.z + light.radius_m));
    }
    return made;
  }

  std::unique_ptr<CullEngine> library_;
};

TEST(Hunt, LosesNothing) {
  const auto library = device_engine("");
  const HuntReport report = hunt(*library, {.contacts = 600'000, .few_settings = true, .lights_a_view = 4096});
  EXPECT_GE(report.total().contacts, 600'000u);
  for (const HuntTally& tally : report.classes) {
    EXPECT_GT(tally.contacts, 0u) << tally.name;
    EXPECT_EQ(tally.lost, 0u) << tally.name << ": " << tally.why;
    EXPECT_EQ(tally.refused, 0u) << tally.name << ": " << tally.refusal;
  }
}

TEST(Hunt, CountsTheSameForTheSameSeed) {
  WithoutSlack engine;
  const HuntOptions options{.contacts = 20'000, .seed = 7, .few_settings = true, .lights_a_view = 1024};
  auto first = to_json(hunt(engine, options)), second = to_json(hunt(engine, options));
  for (auto* json : {&first, &second}) {
    json->erase("seconds");
    for (auto& tally : (*json)["classes"]) tally.erase("seconds"), tally.erase("cpu_ns_each");
  }
  EXPECT_EQ(first, second);
  EXPECT_GE(first["contacts"], 20'000);
  EXPECT_GT(first["lost"], 0);
}

TEST(Hunt, FindsSavesAndShrinksWhatACullerWithoutSlackLoses) {
  WithoutSlack engine;
  const TempFolder folder;
  const HuntReport report = hunt(engine, {.contacts = 50'000, .filter = "^(ordinary|narrow|wide)$", .few_settings = true,
                                          .lights_a_view = 2048, .save = folder.path});
  EXPECT_TRUE(report.failed());
  for (const HuntTally& tally : report.classes) {
    EXPECT_GT(tally.lost, 0u) << tally.name;
    EXPECT_LT(tally.lost, tally.contacts) << tally.name;
    EXPECT_NE(tally.why, "");
  }
  ASSERT_GE(report.saved.size(), 3u);
  for (const std::string& saved : report.saved) {
    const CapturedFrame frame = read_frame(saved);
    EXPECT_EQ(frame.lights.size(), 1u) << saved;
    const auto grid = read_frame_grid(saved, frame);
    ASSERT_TRUE(grid) << saved;
    const LitPairs pairs = count_pairs(frame.view, covered_depth(frame), local_lights(frame), listed_lights(frame, *grid));
    EXPECT_GT(pairs.lost, 0u) << saved;
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(saved) / "hunt.txt"));
  }
}

TEST(HuntCommand, TellsItsTallyAsJson) {
  const ProgramRun run = run_program({"verify", "--hunt", "1", "--contacts", "10000", "--filter", "^narrow$", "--json", "-"});
  ASSERT_EQ(run.status, 0) << run.err << run.out;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_GE(json["contacts"], 10'000);
  EXPECT_EQ(json["lost"], 0);
  ASSERT_EQ(json["classes"].size(), 1u);
  EXPECT_EQ(json["classes"][0]["name"], "narrow");
  for (const char* key : {"seconds", "saved", "seed", "device", "refused"}) EXPECT_TRUE(json.contains(key)) << key;
}

TEST(HuntCommand, RefusesWhatIsNoHunt) {
  EXPECT_EQ(run_program({"verify", "--hunt", "soon"}).status, 2);
  EXPECT_EQ(run_program({"verify", "--hunt", "0"}).status, 2);
  EXPECT_EQ(run_program({"verify", "--hunt", "1", "--filter", "no such class"}).status, 2);
  EXPECT_EQ(run_program({"verify", "--hunt", "1", "--nightly"}).status, 2);
}

}  // namespace
}  // namespace lightgrid::verify
