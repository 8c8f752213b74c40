// compare as a front end calls it: fields and a progress callback in, values out.
#include "compare/comparison.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "base/error.h"
#include "compare/contestants.h"
#include "techniques/technique.h"

namespace lightgrid::lab {
namespace {

using testing::HasSubstr;
using testing::SizeIs;
using testing::ThrowsMessage;

CompareChoice small_choice() {
  CompareChoice choice{.scenes = {"spheres"}, .sizes = {"17x9"}, .lights = {"3", "5"}};
  choice.devices.gl = "none";
  choice.timing = {.frames = 1, .warmup = 0};
  choice.techniques = {"visibility:lights=all", "visibility"};
  return choice;
}

TEST(Comparison, ReturnsAReportForEachView) {
  std::vector<double> progress;
  const std::vector<CompareReport> reports =
      compare_views(small_choice(), [&](double done, const std::string&) { progress.push_back(done); });
  ASSERT_THAT(reports, SizeIs(2));
  for (size_t i = 0; i < reports.size(); ++i) {
    ASSERT_THAT(reports[i].rows, SizeIs(2));
    EXPECT_EQ(reports[i].rows[1].lights_total, i == 0 ? 3 : 5);
    EXPECT_EQ(reports[i].rows[1].pairs->lost, 0u);
    EXPECT_EQ(image_of(reports[i], 0).width, 17);
  }
  EXPECT_TRUE(std::ranges::is_sorted(progress));
  EXPECT_DOUBLE_EQ(progress.back(), 1);
}

TEST(Comparison, NamesAWrongFieldBeforeDevicesAreOpened) {
  CompareChoice choice = small_choice();
  choice.reference = "some";
  choice.devices.device = "no such device";
  EXPECT_THAT([&] { load_comparison(choice); },
              ThrowsMessage<Error>(HasSubstr("reference some: not full, sampled or auto")));
}

TEST(Comparison, AllIsEveryTechniqueOnce) {
  const std::vector<Contestant> found = named_contestants({"all", "forward_plus:tile=8"}, {});
  ASSERT_THAT(found, SizeIs(techniques().size() + 1));
  std::set<std::string> names;
  for (size_t i = 0; i + 1 < found.size(); ++i) names.insert(found[i].technique->name);
  EXPECT_THAT(names, SizeIs(techniques().size()));
  std::string one = "all";
  std::vector<std::string> set;
  EXPECT_THAT([&] { take_own_settings(one, set); }, ThrowsMessage<Error>(HasSubstr("one is drawn here")));
}

}  // namespace
}  // namespace lightgrid::lab
