// The hunt finds no loss in the library; it finds, saves and reduces the losses of a culler without slack.
// Some of its classes alone find what breaks only in them.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "frames/frame_lists.h"
#include "oracle/lit_set.h"
#include "oracle/position.h"
#include "support/read_files.h"
#include "support/run_program.h"
#include "support/temp_folder.h"
#include "verify/hunt.h"

namespace lightgrid::lab::verify {
namespace {

// The library with its input altered as a fault of naive code would.
class Altered : public CullEngine {
 public:
  Altered() : library_(device_engine("")) {}
  std::string name() const override { return "altered"; }
  bool is_the_library() const override { return false; }

  HostGrid cull(const CullerOptions& options, const CullView& view, std::span<const CullLight> lights,
                std::span<const DepthInterval> bounds) override {
    return library_->cull(options, altered(view), altered(view, lights), bounds);
  }
  std::vector<DepthInterval> depth_bounds(const CullerOptions& options, const CullView& view,
                                          const DepthImage& depth, bool blend) override {
    return library_->depth_bounds(options, altered(view), depth, altered(blend));
  }
  HostGrid cull_depth(const CullerOptions& options, const CullView& view, std::span<const CullLight> lights,
                      const DepthImage& depth, bool blend) override {
    return library_->cull_depth(options, altered(view), altered(view, lights), depth, altered(blend));
  }

 protected:
  virtual CullView altered(const CullView& view) const { return view; }
  virtual std::vector<CullLight> altered(const CullView&, std::span<const CullLight> lights) const {
    return {lights.begin(), lights.end()};
  }
  virtual bool altered(bool blend) const { return blend; }

 private:
  std::unique_ptr<CullEngine> library_;
};

// Subtracts the slack of docs/hard_cases.md#slack from each light before the library adds it.
class WithoutSlack : public Altered {
  using Altered::altered;
  std::vector<CullLight> altered(const CullView& view, std::span<const CullLight> lights) const override {
    std::vector<CullLight> made(lights.begin(), lights.end());
    for (CullLight& light : made) {
      const glm::dvec3 p = glm::abs(to_view(view, light.position));
      light.radius_m = std::max(0.0, light.radius_m - 64 * 0x1p-24 * (p.x + p.y + p.z + light.radius_m));
    }
    return made;
  }
};

// Blended surfaces use the lists of opaque ones.
class OpaqueListsForBlended : public Altered {
  using Altered::altered;
  bool altered(bool) const override { return false; }
};

// Only the distance term of the depth row is read.
class StraightNearPlane : public Altered {
  using Altered::altered;
  CullView altered(const CullView& view) const override {
    CullView straight = view;
    if (!is_orthographic(view)) straight.clip_from_view[0][2] = straight.clip_from_view[1][2] = 0;
    return straight;
  }
};

// A camera whose field of view is at least a degree.
class AtLeastOneDegree : public Altered {
  using Altered::altered;
  CullView altered(const CullView& view) const override {
    CullView wide = view;
    const double most = 1 / std::tan(glm::radians(0.5)),
                 scale = std::min(view.clip_from_view[0][0], view.clip_from_view[1][1]);
    if (is_orthographic(view) || scale <= most) return wide;
    for (int column = 0; column < 4; ++column) {
      for (int row = 0; row < 2; ++row) wide.clip_from_view[column][row] *= most / scale;
    }
    return wide;
  }
};

TEST(Hunt, LosesNothing) {
  const auto library = device_engine("");
  const HuntReport report =
      hunt(*library, {.contacts = 600'000, .few_settings = true, .lights_a_view = 4096});
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
    for (auto& tally : (*json)["classes"]) {
      tally.erase("seconds");
      tally.erase("cpu_ns_each");
    }
  }
  EXPECT_EQ(first, second);
  EXPECT_GE(first["contacts"], 20'000);
  EXPECT_GT(first["lost"], 0);
}

TEST(Hunt, FindsSavesAndShrinksWhatACullerWithoutSlackLoses) {
  WithoutSlack engine;
  const TempFolder folder;
  const HuntReport report = hunt(engine, {.contacts = 50'000,
                                          .filter = "^(ordinary|narrow|wide)$",
                                          .few_settings = true,
                                          .lights_a_view = 2048,
                                          .save = folder.path});
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
    const LitPairs pairs =
        count_pairs(frame.view, covered_depth(frame), local_lights(frame), listed_lights(frame, *grid));
    EXPECT_GT(pairs.lost, 0u) << saved;
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(saved) / "hunt.txt"));
  }
}

// `absent`: what hunt.txt says that the saved frames lack; empty: they can be read.
void expect_losses_in(const std::string& name, CullEngine& engine, const std::string& absent) {
  const TempFolder folder;
  const HuntReport report = hunt(engine, {.contacts = 60'000,
                                          .seed = 3,
                                          .filter = "^(?!mixed)",
                                          .few_settings = true,
                                          .lights_a_view = 512,
                                          .save = folder.path});
  for (const HuntTally& tally : report.classes) {
    EXPECT_GT(tally.contacts, 0u) << tally.name;
    EXPECT_EQ(tally.lost > 0, tally.name == name) << tally.name << ": " << tally.why;
  }
  ASSERT_FALSE(report.saved.empty());
  for (const std::string& saved : report.saved) {
    const std::string text = file_bytes(saved + "/hunt.txt");
    EXPECT_THAT(text, testing::HasSubstr(absent));
    if (absent.empty()) {
      EXPECT_EQ(read_frame(saved).lights.size(), 1u);
    }
  }
}

TEST(HuntClasses, OnlyBlendedFindsListsOfOpaqueSurfaces) {
  OpaqueListsForBlended engine;
  expect_losses_in("blended", engine, "the frame lacks the blended surface");
}

TEST(HuntClasses, OnlyObliqueFindsANearPlaneTakenForStraight) {
  StraightNearPlane engine;
  expect_losses_in("oblique", engine, "the frame has an oblique near plane");
}

TEST(HuntClasses, OnlyNarrowestFindsAFieldOfAtLeastOneDegree) {
  AtLeastOneDegree engine;
  expect_losses_in("narrowest", engine, "");
}

// With the oracle's own position of a pixel.
TEST(HuntClasses, ObliqueDepthsAreThoseOfTheOracle) {
  int compared = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const HuntSetting setting;
    const HuntView view = random_view(HuntClass::oblique, setting, seed);
    EXPECT_NE(view.view.clip_from_view[0][2], 0);
    for (const HuntContact& c : random_contacts(view, setting, 200, seed).contacts) {
      const glm::dvec3 expected = position_from_depth(oracle_view(view.view), c.x, c.y, c.depth);
      // The terms of u = depth + a - tilt, which is near / distance or half of it at least, come to less
      // than 8.
      const double rounding = 1e-14 * (1 - expected.z / view.near);
      EXPECT_LE(glm::distance(*position_of(view, c), expected), rounding * glm::length(expected));
      EXPECT_GE(-expected.z, view.near * (1 - 1e-6));
      ++compared;
    }
  }
  EXPECT_GT(compared, 2000);
}

TEST(HuntClasses, BlendedSurfacesLieBetweenTheNearPlaneAndTheOpaqueSurface) {
  int before = 0, near = 0, before_sky = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const HuntSetting setting;
    const HuntView view = random_view(HuntClass::blended, setting, seed);
    const bool standard = has_standard_depth(view.view);
    for (const HuntContact& c : random_contacts(view, setting, 200, seed).contacts) {
      const float opaque = view.depth.values[size_t(c.y) * view.view.width + c.x];
      EXPECT_TRUE(standard ? c.depth <= opaque && c.depth >= 0 : c.depth >= opaque && c.depth <= 1)
          << c.depth;
      near += c.depth == (standard ? 0 : 1);
      before += c.depth != opaque;
      before_sky += opaque == depth_of_nothing(view.view);
    }
  }
  EXPECT_GT(before, 1000);
  EXPECT_GT(near, 100);
  EXPECT_GT(before_sky, 20);
}

TEST(HuntCommand, TellsItsTallyAsJson) {
  const ProgramRun run =
      run_program({"verify", "--hunt", "1", "--contacts", "10000", "--filter", "^narrow$", "--json", "-"});
  ASSERT_EQ(run.status, 0) << run.err << run.out;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_GE(json["contacts"], 10'000);
  EXPECT_EQ(json["lost"], 0);
  ASSERT_EQ(json["classes"].size(), 1u);
  EXPECT_EQ(json["classes"][0]["name"], "narrow");
  for (const char* key : {"seconds", "saved", "seed", "device", "refused"})
    EXPECT_TRUE(json.contains(key)) << key;
}

TEST(HuntCommand, RefusesWhatIsNoHunt) {
  EXPECT_EQ(run_program({"verify", "--hunt", "soon"}).status, 2);
  EXPECT_EQ(run_program({"verify", "--hunt", "0"}).status, 2);
  EXPECT_EQ(run_program({"verify", "--hunt", "1", "--filter", "no such class"}).status, 2);
  EXPECT_EQ(run_program({"verify", "--hunt", "1", "--nightly"}).status, 2);
}

}  // namespace
}  // namespace lightgrid::lab::verify
