#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "report/report.h"
#include "report/synthetic_report.h"
#include "support/error_of.h"
#include "support/read_files.h"
#include "support/temp_folder.h"

namespace lightgrid::lab {
namespace {

namespace fs = std::filesystem;

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

TEST(WriteReport, MakesTheFolderAndTheDocumentedFiles) {
  const TempFolder folder;
  write_report(folder.path / "new" / "report", synthetic_report(17, 9));
  std::set<std::string> expected = {"index.html", "results.json", "lit.heat.png"};
  for (const std::string row : {"forward", "forward_plus-cull-test=planes+aabb", "clustered",
                                "deferred_tiled", "lidr", "forward_plus-cull-test=exact"}) {
    for (const char* end : {".png", ".difference.png", ".heat.png"}) expected.insert(row + end);
  }
  EXPECT_EQ(names_in(folder.path / "new" / "report"), expected);
}

TEST(WriteReport, ComparesWithAReferenceThatIsNoRow) {
  auto report = synthetic_report(17, 9);
  report.reference = "exact";
  report.reference_image = report.images[0];
  const TempFolder folder;
  write_report(folder.path, report);
  EXPECT_EQ(file_bytes(folder.path / "exact.png"), file_bytes(folder.path / "forward.png"));
  EXPECT_TRUE(fs::exists(folder.path / "lidr.difference.png"));
  EXPECT_FALSE(fs::exists(folder.path / "exact.difference.png"));
}

TEST(WriteReport, WritesTheReferencesPictureWhereARowKeptNoCopyOfIt) {
  auto report = synthetic_report(17, 9);
  ASSERT_EQ(report.rows[2].technique, "clustered");
  report.rows[2].error->bit_identical = true;
  report.images[2] = Image();
  const TempFolder folder;
  write_report(folder.path, report, true);
  EXPECT_EQ(file_bytes(folder.path / "clustered.exr"), file_bytes(folder.path / "forward.exr"));
  EXPECT_NE(file_bytes(folder.path / "lidr.exr"), file_bytes(folder.path / "forward.exr"));
}

TEST(WriteReport, IsTheSameEachTime) {
  const TempFolder first, second;
  write_report(first.path, synthetic_report(17, 9));
  write_report(second.path, synthetic_report(17, 9));
  for (const auto& name : names_in(first.path))
    EXPECT_EQ(file_bytes(first.path / name), file_bytes(second.path / name)) << name;
}

TEST(WriteReport, TakesARunThatFailedHalfway) {
  auto report = synthetic_report(17, 9);
  report.images.resize(2);
  report.listed.clear();
  report.lit.clear();
  report.reference_errors.reset();
  report.rows[1].pairs.reset();
  const TempFolder folder;
  write_report(folder.path, report);
  EXPECT_TRUE(fs::exists(folder.path / "forward_plus-cull-test=planes+aabb.difference.png"));
  EXPECT_FALSE(fs::exists(folder.path / "clustered.png"));
  EXPECT_FALSE(fs::exists(folder.path / "lit.heat.png"));
  EXPECT_EQ(nlohmann::json::parse(file_bytes(folder.path / "results.json")), to_json(report));
}

TEST(ViewsReport, MakesAFolderAViewAndOnePageForAll) {
  const TempFolder folder;
  ViewsReport report(folder.path, 3, 1 << 20);
  for (int lights : {15, 60, 60}) report.add(synthetic_view("scenes/my hall.glb", 17, 9, lights));
  report.write();
  EXPECT_EQ(names_in(folder.path),
            (std::set<std::string>{"index.html", "results.json", "results.csv", "my-hall-17x9-15",
                                   "my-hall-17x9-60", "my-hall-17x9-60-2"}));
  const auto pictures = names_in(folder.path / "my-hall-17x9-15");
  EXPECT_TRUE(pictures.count("forward.png") && pictures.count("lidr.difference.png") &&
              pictures.count("lit.heat.png"));
  const auto json = nlohmann::json::parse(file_bytes(folder.path / "results.json"));
  ASSERT_EQ(json["views"].size(), 3u);
  EXPECT_EQ(json["views"][1], to_json(synthetic_view("scenes/my hall.glb", 17, 9, 60)));
}

TEST(ViewsReport, ShowsPicturesSmallerSoThatThePageStaysWithinItsBound) {
  const size_t most = 100 << 10;
  const TempFolder folder;
  ViewsReport report(folder.path, 2, most);
  for (const char* scene : {"a", "b"}) report.add(synthetic_view(scene, 320, 180, 60));
  report.write();
  size_t bytes = 0;
  for (const ReportView& view : report.views()) {
    EXPECT_GT(view.pictures.reduced, 1);
    bytes += bytes_in_page(view.pictures);
  }
  EXPECT_LE(bytes, most);
  EXPECT_GT(fs::file_size(folder.path / "a-320x180-60" / "forward.png"), most / 10) << "whole in its folder";
}

TEST(WriteReport, RefusesAFileWhereTheFolderShouldBe) {
  const TempFolder folder;
  std::ofstream(folder.path / "taken") << "x";
  EXPECT_THAT(error_of([&] { write_report(folder.path / "taken", synthetic_report(1, 1)); }),
              testing::HasSubstr("taken"));
}

TEST(WriteReport, LetsNoNameEndTheScript) {
  auto report = synthetic_report(1, 1);
  report.scene = "a</script><img src=x onerror=alert(1)>{{style}}.glb";
  const TempFolder folder;
  write_report(folder.path, report);
  const auto page = file_bytes(folder.path / "index.html");
  EXPECT_EQ(page.find("a</script>"), page.npos);
  EXPECT_NE(page.find("{{style}}.glb"), page.npos);
}

}  // namespace
}  // namespace lightgrid::lab
