#include "frontier/answer.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "frontier/answer_steps.h"
#include "frontier/synthetic_records.h"
#include "measures/words.h"

namespace lightgrid::lab {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const double no_figure = std::nan("");

const PointFigures& point_named(const FrontierAnswer& answer, const std::string& label) {
  for (const PointFigures& p : answer.points) {
    if (p.point.label == label) return p;
  }
  throw std::runtime_error("no point " + label);
}

std::vector<std::string> front_of(const FrontierAnswer& answer) {
  std::vector<std::string> names;
  for (const PointFigures& p : answer.points) {
    if (p.fronts.at("total").on) names.push_back(p.point.label);
  }
  return names;
}

// The point that is faster in wall-clock time is slower in device time: its frames end with less read-back. A
// point without device times is on no such front.
TEST(Answer, FrontsByTheDevicesClocksAreTheirOwn) {
  const auto timed = [](const char* technique, double ratio, double device_ms, double error) {
    FrontierRecord r = synthetic_record(synthetic_point("hall", technique), ratio, error);
    for (size_t run = 0; run < r.frame_ms.size(); ++run) {
      r.device_ms.push_back(device_ms);
      r.baseline_device_ms.push_back(20);
      r.hand_over_ms.push_back(3);
      r.copy_ms.push_back(0.5);
      r.read_back_ms.push_back(double(run));
    }
    return r;
  };
  FrontierRecord unknown = timed("clustered", 0.2, 1, 0.001);
  unknown.device_ms.pop_back();  // one run has none
  FrontierPart part =
      synthetic_part({timed("forward_plus", 0.5, 10, 0.01), timed("deferred", 0.8, 5, 0.01), unknown});
  part.machine.cl_kind = "CPU";
  const FrontierAnswer answer = answer_of({part});
  ASSERT_THAT(answer.points, SizeIs(3));
  const DeviceFigures &first = answer.points[0].device, &second = answer.points[1].device;
  EXPECT_NEAR(first.relative_time.estimate, 0.5, 1e-12);
  EXPECT_NEAR(second.relative_time.estimate, 0.25, 1e-12);
  EXPECT_FALSE(first.fronts.at("total").on);
  EXPECT_TRUE(second.fronts.at("total").on);
  EXPECT_EQ(second.fronts.at("total").probability, 1);
  EXPECT_EQ(second.device_ms.median, 5);
  EXPECT_EQ(second.hand_over_ms.median, 3);
  EXPECT_EQ(second.copy_ms.median, 0.5);
  EXPECT_EQ(second.read_back_ms.median, 4.5);
  EXPECT_EQ(answer.points[2].device.relative_time.runs, 0);
  EXPECT_FALSE(answer.points[2].device.fronts.at("total").on);
  EXPECT_EQ(front_of(answer), std::vector<std::string>{"clustered"});
  ASSERT_THAT(answer.device_front_bands, SizeIs(1));
  EXPECT_NEAR(answer.device_front_bands[0].steps.back().low, 0.25, 1e-12);

  // The cheapest point differs likewise. Sentences state wall-clock time, except on a GPU.
  const auto cheapest = [&](const std::vector<CheapestWithin>& all) {
    return answer.points[size_t(all.back().point)].point.technique;
  };
  EXPECT_EQ(cheapest(answer.cheapest_within), "clustered");
  EXPECT_EQ(cheapest(answer.device_cheapest_within), "deferred");
  EXPECT_NEAR(answer.device_cheapest_within.back().relative_time.estimate, 0.25, 1e-12);
  EXPECT_THAT(answer.sentences,
              Contains(HasSubstr("up to 0.001 in hall: clustered, 0.201 times forward_plus (")));
  part.machine.cl_kind = "GPU";
  EXPECT_THAT(
      answer_of({part}).sentences,
      Contains(HasSubstr("up to 0.01 in hall: deferred, 0.250 times forward_plus by the devices' clocks (")));
  for (FrontierRecord& record : part.records) {
    record.device_ms.clear();
    record.baseline_device_ms.clear();
  }
  const FrontierAnswer without = answer_of({part});
  EXPECT_THAT(without.device_cheapest_within, IsEmpty());
  EXPECT_FALSE(without.by_device);
}

// However noisy the baseline is, it cancels between two points of a round.
TEST(Answer, HoldsOpenClTechniquesAgainstEachOther) {
  std::vector<FrontierRecord> records = {
      synthetic_record(synthetic_point("hall", "forward_plus"), 1, 0.01),
      synthetic_record(synthetic_point("hall", "visibility"), 0.25, 0.01),
      synthetic_record(synthetic_point("hall", "world_grid", {{"raster", "opencl"}}), 0.5, 0.02),
      synthetic_record(synthetic_point("hall", "world_grid"), 0.5, 0.02),
      synthetic_record(synthetic_point("street", "visibility"), 0.125, 0.01),
      synthetic_record(synthetic_point("street", "unheard_of"), 0.125, 0.01)};
  for (FrontierRecord& r : records) {
    for (size_t run = 0; run < r.baseline_ms.size(); ++run) r.baseline_ms[run] = run % 2 ? 50 : 200;
  }
  const FrontierAnswer answer = answer_from(records);
  ASSERT_THAT(answer.among_opencl, SizeIs(3));  // visibility itself, too
  const AmongOpenCl& world = answer.among_opencl[1];
  EXPECT_EQ(world.scene, "hall");
  EXPECT_EQ(answer.points[size_t(world.point)].point.label, "world_grid:raster=opencl");
  EXPECT_EQ(answer.points[size_t(world.over)].point.label, "visibility");
  EXPECT_NEAR(world.relative_time.estimate, 2, 1e-12);
  EXPECT_NEAR(world.relative_time.low, 2, 1e-12);
  EXPECT_EQ(world.relative_time.runs, 10);
  EXPECT_EQ(world.relative_device_time.runs, 0);
  EXPECT_EQ(answer.among_opencl[2].scene, "street");
  EXPECT_EQ(answer.among_opencl[2].relative_time.estimate, 1);

  FrontierPart part = synthetic_part(records);
  part.baseline = "visibility";
  EXPECT_THAT(answer_of({part}).among_opencl, IsEmpty());
}

TEST(Answer, SaysWhatTheBaselineIsOnThisMachine) {
  FrontierPart part = synthetic_part({synthetic_record(synthetic_point("hall", "forward_plus"), 1, 0.01),
                                      synthetic_record(synthetic_point("hall", "visibility"), 2, 0.01)});
  const auto said = [&](const char* gl_device, const char* baseline = "forward_plus") {
    part.machine.gl_device = gl_device;
    part.baseline = baseline;
    const FrontierAnswer answer = answer_of({part});
    const std::string sentence = answer.sentences.empty() ? "" : answer.sentences.front();
    const bool about = sentence.find("OpenGL runs") == 0 || sentence.find("On a Hopper") == 0;
    for (const std::string& line : words_of_scene(answer, "hall").opening)
      EXPECT_EQ(line == sentence && about, line.find("OpenGL runs") == 0 || line.find("On a Hopper") == 0);
    EXPECT_THAT(words_of_scene(answer, "hall").opening, SizeIs(about ? 2 : 1));
    return about ? sentence : "";
  };
  EXPECT_THAT(said("llvmpipe (LLVM 15.0.6, 256 bits)"),
              AllOf(HasSubstr("software"), HasSubstr("(llvmpipe)"), HasSubstr("forward_plus")));
  EXPECT_THAT(said("softpipe"), HasSubstr("(softpipe)"));
  for (const char* hopper :
       {"NVIDIA H100 80GB HBM3/PCIe/SSE2", "NVIDIA H200/PCIe/SSE2", "NVIDIA GH200 480GB"})
    EXPECT_THAT(said(hopper), HasSubstr("few of its units"));
  EXPECT_EQ(said("NVIDIA GeForce RTX 4090/PCIe/SSE2"), "");
  EXPECT_EQ(said("AMD Radeon RX 7900"), "");
  EXPECT_EQ(said("llvmpipe (LLVM 15.0.6, 256 bits)", "visibility"), "");
}

TEST(Answer, SumsTimesOverViewsRunByRunAndJoinsErrors) {
  FrontierRecord a = synthetic_record(synthetic_point("hall", "forward_plus"), 1, 0, 0), b = a;
  a.frame_ms = {10, 20, 30};
  a.baseline_ms = {100, 100, 100};
  b.view = 1;
  b.frame_ms = {2, 4, 6, 8};
  b.baseline_ms = {20, 20, 20, 40};
  a.errors.total = synthetic_error(0.1, 0.03, 0.3, 0.01, 0.25);
  b.errors.total = synthetic_error(0.3, 0.04, 0.4, 0.03);
  a.errors.deviation_rmse_rel = 0.5;
  a.pairs = {10, 5, 1, 2};
  b.pairs = {20, 6, 3, 4};
  a.memory_bytes = 7;
  b.memory_bytes = 9;
  a.bytes_moved = 100;
  b.bytes_moved = 300;
  b.nan_pixels = 11;
  const FrontierAnswer answer = answer_from({a, b});
  ASSERT_THAT(answer.points, SizeIs(1));
  const PointFigures& p = answer.points[0];
  EXPECT_EQ(p.views, 2);
  std::vector<double> ratios;
  for (const auto& [block, log_ratio] : p.times.rounds) ratios.push_back(std::exp(log_ratio));
  EXPECT_THAT(ratios, ElementsAre(DoubleNear(0.1, 1e-15), DoubleNear(0.2, 1e-15), DoubleNear(0.3, 1e-15)));
  // Two means of two logarithms are in the middle: that of 0.1 and 0.3, and 0.2 itself.
  EXPECT_NEAR(p.relative_time.estimate, std::sqrt(std::sqrt(0.1 * 0.3) * 0.2), 1e-15);
  EXPECT_EQ(p.relative_time.runs, 3);
  EXPECT_EQ(p.p95_ms, 30);                    // the times are 10, 20, 30, 2, 4, 6, 8
  EXPECT_NEAR(p.frame_ms.median, 12, 1e-12);  // (20 + 4) / 2 views
  EXPECT_EQ(p.errors.total.max_rel, 0.3);
  EXPECT_NEAR(p.errors.total.rmse_rel, std::sqrt(0.00125), 1e-15);
  EXPECT_NEAR(p.errors.total.relative_rmse, std::sqrt(0.125), 1e-15);
  EXPECT_NEAR(p.errors.total.p99_rel, 0.02, 1e-15);
  EXPECT_EQ(p.errors.total.flip_mean, 0.25);  // one view has it
  EXPECT_EQ(p.errors.deviation_rmse_rel, 0.5);
  EXPECT_EQ(p.errors.bias_rmse_rel, std::nullopt);
  EXPECT_EQ(p.pairs.listed, 30u);
  EXPECT_EQ(p.pairs.lit, 11u);
  EXPECT_EQ(p.pairs.lost, 4u);
  EXPECT_EQ(p.pairs.wrong, 6u);
  EXPECT_EQ(p.memory_bytes, 9u);
  EXPECT_EQ(p.bytes_moved, 200u);
  EXPECT_EQ(p.nan_pixels, 11u);
}

TEST(Answer, FrontHoldsWhatNothingBeatsInBothAndNoNaN) {
  const auto of = [](const std::string& name, double ratio, double error) {
    return synthetic_record(synthetic_point("hall", name), ratio, error);
  };
  std::vector<FrontierRecord> records = {of("coarse", 0.1, 0.5),
                                         of("middle", 0.2, 0.1),
                                         of("beaten", 0.3, 0.2),
                                         of("fine", 0.4, 0.01),
                                         of("slow", 0.5, 0.01),
                                         of("not-finite", 0.01, no_figure),
                                         of("infinite", 0.01, std::numeric_limits<double>::infinity()),
                                         of("shows-nan", 0.01, 0.001)};
  records.back().nan_pixels = 1;
  records.push_back(synthetic_record(synthetic_point("terrain", "worst of hall, alone in terrain"), 9, 0.9));
  EXPECT_THAT(front_of(answer_from(records)),
              ElementsAre("coarse", "middle", "fine", "worst of hall, alone in terrain"));
}

// The mean of n draws from n figures with standard deviation s has s sqrt(1 / n): for 64 of 0 and 1 in turn
// 0.0625. The binomial distribution of 64 draws has 2.5 % up to 24 and 97.5 % up to 40.
TEST(Answer, StatesWhatOtherViewsMightHaveGiven) {
  std::vector<double> figures;
  for (int i = 0; i < 64; ++i) figures.push_back(i % 2);
  const auto [low, high] = bootstrap_interval(figures, OverViews::mean);
  EXPECT_NEAR(low, 24.0 / 64, 1.0 / 64);
  EXPECT_NEAR(high, 40.0 / 64, 1.0 / 64);
  EXPECT_EQ(bootstrap_interval(figures, OverViews::mean), std::pair(low, high)) << "the same in each run";
  const auto [root_low, root_high] = bootstrap_interval(figures, OverViews::root_mean_square);
  EXPECT_DOUBLE_EQ(root_low, std::sqrt(low)) << "of the same draws";
  EXPECT_EQ(bootstrap_interval(std::vector<double>(9, 0.5), OverViews::mean), std::pair(0.5, 0.5));
  figures[7] = no_figure;
  EXPECT_TRUE(std::isnan(bootstrap_interval(figures, OverViews::mean).first));

  std::vector<FrontierRecord> records;
  for (int view = 0; view < 6; ++view)
    records.push_back(synthetic_record(synthetic_point("hall", "a"), 1, view < 3 ? 0.1 : 0.3, view));
  const auto of_views = [&](size_t count) {
    return answer_from({records.begin(), records.begin() + std::ptrdiff_t(count)}).points[0].over_views;
  };
  EXPECT_THAT(of_views(5), IsEmpty());
  const auto [flip_low, flip_high] = of_views(6).at({"total", "displayed_flip"});
  EXPECT_NEAR(flip_low, 0.1 + 0.2 / 6, 0.2 / 6 + 1e-9);
  EXPECT_NEAR(flip_high, 0.1 + 5 * 0.2 / 6, 0.2 / 6 + 1e-9);
  EXPECT_FALSE(of_views(6).contains({"authored", "displayed_flip"}));
}

// The views' ranges are independent: errors of their estimates add as squares do. Below 0 it is no bias.
TEST(Answer, JoinsTheBiasOfViewsBeforeItsRootIsTaken) {
  const auto of_view = [](int view, double bias_mse_rel, double error) {
    FrontierRecord r = synthetic_record(synthetic_point("hall", "random"), 1, 0.1, view);
    r.errors.seeds = SeedErrors{32, 8, synthetic_error(1, view, 1, 1), bias_mse_rel, error};
    return r;
  };
  const FrontierAnswer answer = answer_from({of_view(0, 0.05, 0.03), of_view(1, -0.01, 0.04)});
  const PointErrors& e = answer.points.at(0).errors;
  ASSERT_TRUE(e.seeds);
  EXPECT_EQ(e.seeds->pictures, 64);
  EXPECT_EQ(e.seeds->flip_pictures, 16);
  EXPECT_NEAR(e.seeds->bias_mse_rel, 0.02, 1e-15);
  EXPECT_NEAR(e.seeds->bias_mse_rel_error, 0.025, 1e-15);
  EXPECT_NEAR(*e.bias_rmse_rel, std::sqrt(0.02), 1e-15);
  EXPECT_NEAR(e.seeds->deviation.rmse_rel, std::sqrt(0.5), 1e-15);
  EXPECT_EQ(answer_from({of_view(0, -0.05, 0.03)}).points.at(0).errors.bias_rmse_rel, 0);
}

// Where records hold both, each reference has a front of its own.
TEST(Answer, HasAFrontAgainstEachReference) {
  const auto of = [](const std::string& name, double ratio, double error, double authored) {
    FrontierRecord r = synthetic_record(synthetic_point("hall", name), ratio, error);
    r.errors.authored.emplace().total = synthetic_error(authored, authored, authored, authored);
    r.errors.authored->total.displayed = DisplayedFlip{authored, 0.5};
    return r;
  };
  std::vector<FrontierRecord> records = {of("ranges", 0.2, 0.4, 0), of("none", 0.5, 0, 0.4),
                                         of("fast", 0.1, 0.5, 0.1)};
  records.push_back(synthetic_record(synthetic_point("terrain", "without"), 1, 0.1));
  const FrontierAnswer answer = answer_from(records);
  const auto front = [&](const char* reference) {
    std::vector<std::string> names;
    for (const PointFigures& p : answer.points) {
      if (p.fronts.contains(reference) && p.fronts.at(reference).on) names.push_back(p.point.label);
    }
    return names;
  };
  EXPECT_THAT(front("total"), ElementsAre("ranges", "none", "fast", "without"));
  EXPECT_THAT(front("authored"), ElementsAre("ranges", "fast"));
  EXPECT_EQ(point_named(answer, "without").fronts.count("authored"), 0u);
  ASSERT_THAT(answer.front_bands, SizeIs(3));
  EXPECT_EQ(answer.front_bands[2].of, "authored");
  EXPECT_EQ(answer.front_bands[2].steps[0].error, 0);
  std::vector<std::string> cheapest;
  for (const CheapestWithin& best : answer.cheapest_within) {
    if (best.scene == "hall")
      cheapest.push_back(
          fmt::format("{} {} {}", best.of, best.error, answer.points[size_t(best.point)].point.label));
  }
  EXPECT_THAT(cheapest,
              testing::IsSupersetOf({"total 0.2 none", "authored 0.05 ranges", "authored 0.1 fast"}));
  EXPECT_THAT(answer.sentences,
              testing::Contains(HasSubstr("0.1 in hall, against lights with authored ranges: fast, 0.10")));
}

// Without processes rounds are the level; with them processes are, and each has rounds of its own.
TEST(Answer, PointsOfOneRoundArePairedInTheirProcess) {
  FrontierRecord a = synthetic_record(synthetic_point("hall", "a"), 0.5, 0.1, 0, 6), b = a;
  b.point = synthetic_point("hall", "b");
  b.frame_ms.resize(4);
  b.baseline_ms.resize(4);
  a.processes = {0, 0, 0, 1, 1, 1};
  b.processes = {0, 1, 1, 1};
  a.baseline_ms = {100, 100, 100, 100, 100, 160};
  b.baseline_ms = {100, 100, 100, 100};
  const FrontierAnswer answer = answer_from({a, b});
  const auto blocks = [&](size_t i) {
    std::vector<std::pair<int, int>> found;
    for (const auto& [block, ratios] : answer.points[i].times.rounds)
      found.emplace_back(block.process, block.round);
    return found;
  };
  using Block = std::pair<int, int>;
  EXPECT_THAT(blocks(0),
              ElementsAre(Block(0, 0), Block(0, 1), Block(0, 2), Block(1, 0), Block(1, 1), Block(1, 2)));
  EXPECT_THAT(blocks(1), ElementsAre(Block(0, 0), Block(1, 0), Block(1, 1), Block(1, 2)));
  EXPECT_EQ(answer.points[0].relative_time.processes, 2);
  EXPECT_TRUE(answer.points[0].relative_time.between_processes.has_value());
  // One of the baseline's runs of the last round counts, 160 or 100 ms, the same one for both points.
  const auto last_baseline = [&](size_t i) {
    return (i == 0 ? a : b).frame_ms.back() / std::exp(answer.points[i].times.rounds.at({0, 1, 2}));
  };
  EXPECT_NEAR(last_baseline(0), 100, 1e-9);
  EXPECT_NEAR(last_baseline(1), 100, 1e-9);
}

// Two frames are a round; half of one, after a process ended, does not count. A view's interval is of its
// rounds, and that over views of the views: here their ratios are 0.4, 0.5 and 0.6 of equal weight.
TEST(Answer, TimesVaryOverRoundsAndViews) {
  std::vector<FrontierRecord> views;
  for (int view = 0; view < 3; ++view) {
    FrontierRecord& r = views.emplace_back(
        synthetic_record(synthetic_point("hall", "visibility"), 0.4 + 0.1 * view, 0.1 + 0.1 * view, view));
    r.frames_per_round = 2;
    r.frame_ms.assign(9, 100 * (0.4 + 0.1 * view));
    r.baseline_ms.assign(9, 100);
  }
  const FrontierAnswer answer = answer_from(views);
  const RelativeTime& time = answer.points[0].relative_time;
  EXPECT_EQ(time.runs, 4);
  EXPECT_NEAR(time.estimate, 0.5, 1e-12);
  EXPECT_NEAR(time.high, 0.5, 1e-12) << "rounds do not differ";
  ASSERT_TRUE(time.over_views);
  // Deviations of -0.2, 0 and 0.2: a standard error of 0.2 / sqrt(3), and t of two degrees of freedom.
  EXPECT_NEAR(std::log(time.over_views->high / 0.5), 4.30265 * 0.2 / std::sqrt(3.0), 1e-4);
  EXPECT_NEAR(time.over_views->low * time.over_views->high, 0.25, 1e-12);
  views.resize(1);
  EXPECT_FALSE(answer_from(views).points[0].relative_time.over_views);
  EXPECT_TRUE(std::isnan(answer_from(views).points[0].fronts.at("total").over_views));
}

// Which of two points is the faster one differs from view to view, and in no round of a view.
TEST(Answer, TheFrontOverViewsIsNotThatOfRounds) {
  std::vector<FrontierRecord> records;
  for (int view = 0; view < 4; ++view) {
    for (const bool first : {true, false}) {
      const double slower = first == (view == 0) ? 1.3 : 1;
      records.push_back(synthetic_record(synthetic_point("hall", first ? "first" : "second"),
                                         0.5 * slower * (first ? 1.001 : 1.15), 0.1, view));
    }
  }
  const FrontierAnswer answer = answer_from(records);
  const OnFront &first = point_named(answer, "first").fronts.at("total"),
                &second = point_named(answer, "second").fronts.at("total");
  EXPECT_GT(first.probability, 0.99);
  EXPECT_LT(first.over_views, 0.98);
  EXPECT_GT(first.over_views, 0.5);
  EXPECT_NEAR(first.over_views + second.over_views, 1, 1e-9);
}

// Wall-clock times of this machine scatter by 20 %, processor times by less than 1 %.
TEST(Answer, ProcessorTimeDecidesWhereWallClockTimeIsTooNoisy) {
  const auto of = [](const char* name, double ratio, bool noisy) {
    FrontierRecord r = synthetic_record(synthetic_point("hall", name), ratio, 0.1, 0, 20);
    for (size_t run = 0; run < r.frame_ms.size(); ++run) {
      r.cpu_ms.push_back(2 * r.frame_ms[run]);
      r.baseline_cpu_ms.push_back(200);
      if (noisy) r.frame_ms[run] *= run % 2 ? 1.1 : 0.9;
    }
    return r;
  };
  for (const bool noisy : {false, true}) {
    FrontierRecord control = of("forward_plus", 1, noisy);
    control.series = "control 0";
    FrontierPart part = synthetic_part({of("fast", 0.5, noisy), of("slow", 0.52, noisy), control});
    part.machine.cl_kind = "CPU";
    const FrontierAnswer answer = answer_of({part});
    const PointFigures& p = answer.points[0];
    EXPECT_NEAR(p.cpu.relative_time.estimate, 0.5, 0.002);
    EXPECT_EQ(p.cpu.cpu_ms.runs, 20);
    EXPECT_EQ(p.decides, noisy ? Clock::cpu : Clock::wall);
    EXPECT_LT(p.deciding_time().half_width(), 0.01);
    const auto json = to_json(answer);
    EXPECT_EQ(json["points"][0]["clock"], noisy ? "cpu" : "wall");
    EXPECT_EQ(json["points"][0]["reached"], true);
    EXPECT_EQ(json["controls"][0]["decides"], !noisy);
    EXPECT_EQ(json["cpu_controls"][0]["decides"], noisy);
    EXPECT_THAT(answer.sentences, testing::Contains(HasSubstr("processor time")).Times(noisy ? 1 : 0));
    part.machine.cl_kind = "GPU";
    EXPECT_EQ(answer_of({part}).points[0].decides, Clock::wall) << "it is not the device's work";
  }
}

TEST(Answer, FrontHasAProbabilityAndABand) {
  const auto of = [](const std::string& name, double ratio, double error) {
    return synthetic_record(synthetic_point("hall", name), ratio, error);
  };
  const FrontierAnswer answer = answer_from(
      {of("fast", 0.1, 1e-2), of("first", 0.3, 1e-3), of("second", 0.3003, 1e-3), of("slow", 0.9, 1e-2)});
  EXPECT_GT(point_named(answer, "fast").fronts.at("total").probability, 0.999);
  EXPECT_EQ(point_named(answer, "slow").fronts.at("total").probability, 0);
  const double first = point_named(answer, "first").fronts.at("total").probability,
               second = point_named(answer, "second").fronts.at("total").probability;
  EXPECT_NEAR(first + second, 1, 1e-9) << "one of them is on the front";
  ASSERT_THAT(answer.front_bands, SizeIs(1));
  const std::vector<BandStep>& steps = answer.front_bands[0].steps;
  ASSERT_THAT(steps, SizeIs(2));
  EXPECT_EQ(steps[0].error, 1e-3);
  EXPECT_LT(steps[0].low, 0.3);
  EXPECT_GT(steps[0].high, 0.3);
  EXPECT_EQ(steps[1].error, 1e-2);
  EXPECT_NEAR(steps[1].high, 0.1, 0.005);
}

// A control that is 8 % off fails, and all intervals of its scene hold it.
TEST(Answer, ControlsWidenTheIntervalsOfTheirScene) {
  FrontierRecord control = synthetic_record(synthetic_point("hall", "forward_plus"), 1.08, 0);
  control.series = "control 0";
  FrontierRecord place = control;
  place.series = "control 1";
  const FrontierRecord in_hall = synthetic_record(synthetic_point("hall", "a"), 0.5, 0.1),
                       in_terrain = synthetic_record(synthetic_point("terrain", "a"), 0.5, 0.1);
  const FrontierAnswer answer = answer_from({control, place, in_hall, in_terrain});
  EXPECT_THAT(answer.points, SizeIs(2)) << "controls are no points of the front";
  EXPECT_THAT(answer.growth, IsEmpty());
  ASSERT_THAT(answer.controls, SizeIs(1));
  EXPECT_THAT(answer.controls[0].places, SizeIs(2));
  EXPECT_FALSE(answer.controls[0].passed());
  EXPECT_NEAR(answer.controls[0].relative_time.estimate, 1.08, 0.002);
  const RelativeTime &hall = answer.points[0].relative_time, &terrain = answer.points[1].relative_time;
  EXPECT_NEAR(hall.high / terrain.high, answer.controls[0].relative_time.estimate, 1e-9);
  EXPECT_NEAR(terrain.low / hall.low, answer.controls[0].relative_time.estimate, 1e-9);
  EXPECT_THAT(
      answer.sentences[0],
      testing::StartsWith("Control failed in hall: the baseline measured against itself gave 1.08 instead "
                          "of 1. Times of this run are unreliable. Intervals are wider by 8"));
  EXPECT_THAT(answer.sentences, testing::Not(testing::Contains(HasSubstr("Control failed in terrain"))));
  EXPECT_TRUE(std::isnan(answer.points[0].fronts.at("total").probability)) << "of times that are unreliable";
  EXPECT_FALSE(std::isnan(answer.points[1].fronts.at("total").probability));
}

// Parts of one sweep have controls of their own; none is in the rounds of another part.
TEST(Answer, ControlsOfEachPartCount) {
  const auto part_of = [](int shard, double ratio) {
    std::vector<FrontierRecord> records = {
        synthetic_record(synthetic_point("hall", shard == 0 ? "a" : "b"), 0.5, 0.1)};
    for (const int place : {2 * shard, 2 * shard + 1}) {
      records.push_back(synthetic_record(synthetic_point("hall", "forward_plus"), ratio, 0));
      records.back().series = fmt::format("control {}", place);
    }
    FrontierPart part = synthetic_part(records);
    part.shard = shard;
    part.shards = 2;
    for (FrontierRecord& r : part.records) r.shard = shard;
    return part;
  };
  const FrontierAnswer answer = answer_of({part_of(0, 1.08), part_of(1, 1.08)});
  ASSERT_THAT(answer.controls, SizeIs(1));
  EXPECT_THAT(answer.controls[0].places, SizeIs(4));
  EXPECT_FALSE(answer.controls[0].passed());
  EXPECT_NEAR(answer.controls[0].relative_time.estimate, 1.08, 0.002);
  const FrontierAnswer alone = answer_of({part_of(0, 1.08)});
  EXPECT_GT(answer.controls[0].relative_time.runs, alone.controls[0].relative_time.runs);
}

TEST(Answer, FindsTheCheapestPointWithinEachError) {
  const auto of = [](const std::string& name, double ratio, double error) {
    return synthetic_record(synthetic_point("hall", name), ratio, error);
  };
  const FrontierAnswer answer = answer_from(
      {of("a", 0.1, 0.15), of("b", 0.3, 0.015), of("close, better", 0.301, 0.01), of("c", 0.05, no_figure)});
  ASSERT_THAT(answer.cheapest_within, SizeIs(5));  // none within 0.001
  const auto best = [&](size_t i) {
    return answer.points[size_t(answer.cheapest_within[i].point)].point.label;
  };
  EXPECT_EQ(answer.cheapest_within[0].error, 0.01);
  EXPECT_EQ(best(0), "close, better");
  EXPECT_EQ(answer.cheapest_within[0].probability, 1);
  EXPECT_EQ(best(1), "b");
  EXPECT_EQ(answer.cheapest_within[1].probability, 1) << "slower by the same share in each round: no doubt";
  EXPECT_EQ(best(2), "b");
  EXPECT_EQ(answer.cheapest_within[4].error, 0.2);
  EXPECT_EQ(best(4), "a");
  EXPECT_EQ(answer.cheapest_within[4].relative_time.runs, 5) << "picked on the other five of ten";
}

// One round gives no interval, no probability and no percentile, in figures and in words.
TEST(Answer, OfFewRoundsClaimsNoCertainty) {
  const auto of = [](const std::string& name, double ratio, double error, int rounds) {
    return synthetic_record(synthetic_point("hall", name), ratio, error, 0, rounds);
  };
  FrontierRecord control = of("forward_plus", 1.54, 0, 1);
  control.series = "control 0";
  FrontierPart part = synthetic_part({of("forward_plus", 1, 0, 1), of("visibility", 0.5, 0.005, 1), control});
  part.points_asked = {{"hall", 61}};
  const FrontierAnswer once = answer_of({part});
  EXPECT_THAT(once.sentences[0],
              testing::StartsWith("Control failed in hall: the baseline measured against itself "
                                  "gave 1.5"));
  EXPECT_EQ(
      once.sentences[1],
      "In hall 2 of 61 points were measured, in 1 round; at least 3 are needed: a longer --budget measures "
      "more.");
  for (const std::string& sentence : once.sentences)
    EXPECT_THAT(sentence, testing::Not(HasSubstr("probability")));
  const nlohmann::json json = to_json(once);
  EXPECT_EQ(json["coverage"][0],
            nlohmann::json({{"scene", "hall"}, {"points_measured", 2}, {"points_asked", 61}}));
  const nlohmann::json none = {nullptr, nullptr};
  for (const nlohmann::json& point : json["points"]) {
    EXPECT_EQ(point["relative_time"]["ci95"], none);
    EXPECT_TRUE(point["relative_time"]["estimate"].is_number());
    EXPECT_EQ(point["frame_ms"]["ci95"], none);
    EXPECT_TRUE(point["frame_ms_within"]["p99"].is_null());
    EXPECT_TRUE(point["fronts"]["total"]["probability"].is_null());
  }
  for (const nlohmann::json& best : json["cheapest_within_flip"]) EXPECT_TRUE(best["probability"].is_null());
  EXPECT_TRUE(json["flip_front_bands"].empty());
  EXPECT_TRUE(json["controls"][0]["passed"] == false);

  const FrontierAnswer enough = answer_from({of("forward_plus", 1, 0, 6), of("visibility", 0.5, 0.005, 6)});
  const nlohmann::json figures = to_json(enough);
  EXPECT_TRUE(figures["points"][1]["relative_time"]["ci95"][0].is_number());
  EXPECT_TRUE(figures["points"][1]["fronts"]["total"]["probability"].is_number());
  EXPECT_TRUE(figures["cheapest_within_flip"][0]["probability"].is_number());
}

TEST(Failures, NameCauseAndFigureOnceAPoint) {
  const auto of = [](const std::string& name, int view = 0) {
    return synthetic_record(synthetic_point("hall", name), 1, 0, view);
  };
  std::vector<FrontierRecord> records = {of("fine"),       of("loses"),   of("loses", 1), of("nan"),
                                         of("not-finite"), of("several"), of("half"),     of("half", 1)};
  records[1].pairs.lost = 1000;
  records[2].pairs.lost = 234;
  records[3].nan_pixels = 5;
  records[4].errors.total.rmse_rel = no_figure;
  records[5].overflow = 2;
  records[5].pairs.wrong = 1;
  records[7].refused = "16 GiB";
  records.push_back(of("fine"));
  records.back().series = "lights";
  records.back().lights = 10000;
  records.back().refused = "too many";
  const FrontierAnswer answer = answer_from(records);
  std::vector<std::string> told;
  for (const Failure& f : answer.failures) told.push_back(f.point.label + ": " + f.cause + ": " + f.why);
  EXPECT_THAT(told,
              ElementsAre("loses: lost: 1,234 lit pairs are not listed", "nan: NaN: 5 pixels are NaN",
                          "not-finite: NaN: its error is not finite",
                          "several: wrong: 1 listed pairs are no light, or twice the same",
                          "several: overflow: 2 list entries did not fit", "half: refused: refused: 16 GiB",
                          "fine, 10,000 lights: refused: refused: too many"));
  EXPECT_THROW(point_named(answer, "half"), std::runtime_error)
      << "refused in one view: figures of the other would not compare";
}

TEST(Answer, SaysWhatTheFiguresSay) {
  const FrontierAnswer answer = answer_of({synthetic_sweep()});
  ASSERT_THAT(answer.sentences, SizeIs(14));
  EXPECT_THAT(
      answer.sentences[0],
      HasSubstr("In hall the fastest point that computes the same picture as forward_plus (to 1e-5 of the "
                "brightest "
                "channel) is visibility:range=scene: it takes 0.300 times as long (95 % interval 0.29"));
  EXPECT_EQ(answer.sentences[1],
            "The largest error of visibility:range=scene is the model's (where a light's range ends, and its "
            "window): model 1.0e-4, "
            "precision 0, "
            "technique 0 (RMSE relative to the brightest channel).");
  EXPECT_THAT(answer.sentences[2],
              testing::MatchesRegex(
                  "FLIP as displayed up to 0.01 in hall: visibility:cutoff=0.01,range=cutoff, 0.20[0-9] "
                  "times forward_plus \\(the cheapest with a probability of more than 99 %\\)."));
  EXPECT_THAT(
      answer.sentences[3],
      testing::MatchesRegex("FLIP as displayed up to 0.001 in hall: visibility:range=scene, 0.30[0-9] times "
                            "forward_plus \\(the cheapest with a probability of more than 99 %\\)."));
  // 4 ns; exact over planes+aabb 3e6 / 6e5 = 5 ns, over sphere 3.5e6 / 2e6 = 1.75, planes+aabb over sphere
  // 0.5e6 / 1.4e6 = 0.36.
  EXPECT_EQ(answer.sentences[4],
            "In hall a light at a pixel costs forward_plus 4.00 ns to shade: at that price the tighter cull "
            "test wins in 2 of 3 pairs.");
  EXPECT_THAT(answer.sentences[5],
              testing::StartsWith("In hall the time of forward_plus grows as lights^0.50 (0.4"));
  EXPECT_EQ(answer.sentences[6], "In hall 3 of 18 points failed: 1 refused, 1 with lost lights, 1 with NaN.");
  EXPECT_THAT(answer.sentences[7], HasSubstr("In terrain the fastest point"));
  EXPECT_THAT(answer_from({}).sentences, IsEmpty());
  const auto short_run = [](const char* technique, double ratio) {
    return synthetic_record(synthetic_point("hall", technique), ratio, 0, 0, 4);
  };
  EXPECT_THAT(answer_from({short_run("forward_plus", 1), short_run("visibility", 0.5)}).sentences[1],
              HasSubstr("is visibility: it takes 0.501 times as long (95 % interval 0.49"));
  FrontierRecord once = short_run("visibility", 0.5), base = short_run("forward_plus", 1);
  for (FrontierRecord* record : {&once, &base}) {
    record->frame_ms.resize(1);
    record->baseline_ms.resize(1);
  }
  EXPECT_THAT(answer_from({base, once}).sentences[1],
              HasSubstr("times as long (interval not measured: 1 round; at least 3 are needed)."));
  const SceneWords words = words_of_scene(answer, scenes_of(answer)[0]);
  ASSERT_THAT(words.opening, SizeIs(2));
  EXPECT_EQ(words.opening[0], answer.sentences[0]);
  EXPECT_EQ(words.opening[1], answer.sentences[6]);
  EXPECT_THAT(words.notes, SizeIs(3));
  const FrontierAnswer one = answer_from({synthetic_record(synthetic_point("hall", "forward_plus"), 1, 0)});
  EXPECT_THAT(one.sentences, ElementsAre(HasSubstr("In hall no point that computes the same picture"),
                                         HasSubstr("FLIP as displayed up to 0.001")));
}

TEST(Answer, JoinsPartsOfOneSweepOnly) {
  FrontierPart a = synthetic_part({synthetic_record(synthetic_point("hall", "a"), 1, 0.1)});
  FrontierPart b = synthetic_part({synthetic_record(synthetic_point("hall", "b"), 0.5, 0.1), a.records[0]});
  b.shard = 1;
  a.shards = b.shards = 2;
  b.machine.cpu = "another";
  a.warnings = {{"no lights"}};
  b.warnings = {{"no lights"}, {"no range", {"range=cutoff"}, "lightgrid frontier --set range=cutoff"}};
  const FrontierAnswer answer = answer_of({a, b});
  EXPECT_THAT(answer.points, SizeIs(2));
  EXPECT_THAT(answer.part.records, SizeIs(2)) << "a record that is in two parts counts once";
  ASSERT_THAT(answer.machines, SizeIs(2));
  EXPECT_EQ(answer.machines[1].cpu, "another");
  EXPECT_EQ(answer.part.warnings, b.warnings) << "each warning once";
  const auto message = [](const FrontierPart& x, const FrontierPart& y) -> std::string {
    try {
      answer_of({x, y});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  b.request = "other";
  EXPECT_THAT(message(a, b), HasSubstr("request"));
  b.commit = "fedc987";
  EXPECT_THAT(message(a, b), testing::AllOf(HasSubstr("fedc987"), HasSubstr("0123abc")));
  EXPECT_THROW(answer_of({}), Error);
}

TEST(ThreeDigits, AreSignificant) {
  EXPECT_EQ(three_digits(0), "0");
  EXPECT_EQ(three_digits(0.0123456), "0.0123");
  EXPECT_EQ(three_digits(0.31), "0.310");
  EXPECT_EQ(three_digits(0.99999), "1.00");
  EXPECT_EQ(three_digits(31.06), "31.1");
  EXPECT_EQ(three_digits(-0.25), "-0.250");
  EXPECT_EQ(three_digits(12345), "12,345");
  EXPECT_EQ(three_digits(std::numeric_limits<double>::infinity()), "infinite");
  EXPECT_EQ(error_in_words(1.25e-12), "1.2e-12");
  EXPECT_EQ(error_in_words(3), "3.0e0");
  EXPECT_EQ(error_in_words(no_figure), "not finite");
}

}  // namespace
}  // namespace lightgrid::lab
