#include "frontier/record_file.h"

#include <gmock/gmock.h>

#include "frontier/faults.h"
#include "frontier/some_records.h"
#include "support/temp_folder.h"

namespace lightgrid::lab {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

// In FOLDER/NAME, with a record a view of one point.
struct PartFolders {
  TempFolder root;
  Told told;

  std::filesystem::path folder(const std::string& name) const { return root.path / name; }
  void write(const std::string& name, const FrontierPart& part, bool finished = true, int views = 1) const {
    std::filesystem::create_directories(folder(name));
    RecordFile file(part_path(folder(name), part.shard, part.shards), part, nullptr);
    for (int view = 0; view < views; ++view) file.append(some_record(8 + part.shard, view));
    if (finished) file.finish(0);
  }
  std::vector<FrontierPart> read(const std::vector<std::string>& names) {
    std::vector<std::filesystem::path> folders;
    for (const std::string& name : names) folders.push_back(folder(name));
    return read_parts(folders, told.notice());
  }
  std::string fault(const std::vector<std::string>& names) {
    return fault_of([&] { read(names); });
  }
};

TEST(FrontierParts, AreReadInTheOrderOfShards) {
  PartFolders folders;
  folders.write("a", some_part(2, 3));
  folders.write("a", some_part(0, 3));
  folders.write("b", some_part(1, 3));
  std::ofstream(folders.folder("a") / "index.html") << "no part";
  const auto parts = folders.read({"a", "b"});
  ASSERT_EQ(parts.size(), 3u);
  for (int shard = 0; shard < 3; ++shard) {
    EXPECT_EQ(parts[shard].shard, shard);
    EXPECT_EQ(parts[shard].machine.shard, shard);
    ASSERT_EQ(parts[shard].records.size(), 1u);
    EXPECT_EQ(parts[shard].records[0].point.settings.at("tile"), std::to_string(8 + shard));
    EXPECT_EQ(parts[shard].records[0].shard, shard);
  }
  EXPECT_THAT(folders.told.lines, IsEmpty());
}

TEST(FrontierParts, MayBeMissingOrUnfinishedAndThatIsTold) {
  PartFolders folders;
  folders.write("a", some_part(3, 20));
  folders.write("a", some_part(7, 20), false);
  EXPECT_EQ(folders.read({"a"}).size(), 2u);
  EXPECT_THAT(folders.told.lines,
              ElementsAre("missing of 20 shards: 0, 1, 2, 4, 5, 6, 8, 9, 10, 11 and 8 more",
                          "not finished of 20 shards: 7"));
}

TEST(FrontierParts, OfDifferentViewsAreTold) {
  PartFolders folders;
  folders.write("a", some_part(0, 3), true, 4);
  folders.write("a", some_part(1, 3), true, 2);
  folders.write("a", some_part(2, 3), true, 4);
  folders.read({"a"});
  EXPECT_THAT(
      folders.told.lines,
      ElementsAre(EndsWith(": 2 views in shard 1, 4 in shard 0: points of different views are compared")));
}

TEST(FrontierParts, AreOfOneSweep) {
  const auto fault_with = [](auto change) {
    PartFolders folders;
    folders.write("a", some_part(0, 4));
    FrontierPart other = some_part(1, 4);
    change(other);
    folders.write("b", other);
    const std::string fault = folders.fault({"a", "b"}), second = folders.folder("b").string();
    EXPECT_THAT(fault, AllOf(StartsWith(second),
                             EndsWith(", that of " + part_path(folders.folder("a"), 0, 4).string())));
    return fault;
  };
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.request = "fff"; }), HasSubstr("request"));
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.commit = "fff"; }), HasSubstr("commit fff is not 9d11b69"));
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.seed = 3; }), HasSubstr("seed 3 is not"));
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.baseline = "forward"; }),
              HasSubstr("baseline forward is not"));
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.shards = 5; }), HasSubstr("number of shards 5 is not 4"));
}

// Parts of several machines are joined: ratios are to each part's own baseline.
TEST(FrontierParts, MayBeOfSeveralMachines) {
  PartFolders folders;
  folders.write("a", some_part(0, 2));
  FrontierPart other = some_part(1, 2);
  other.machine.cpu = "Epyc";
  folders.write("a", other);
  EXPECT_EQ(folders.read({"a"}).at(1).machine.cpu, "Epyc");
}

TEST(FrontierParts, AreThereOnce) {
  PartFolders folders;
  folders.write("a", some_part(0, 2));
  folders.write("b", some_part(0, 2));
  EXPECT_EQ(folders.fault({"a", "b"}), part_path(folders.folder("b"), 0, 2).string() +
                                           ": shard 0 is there twice, also in " +
                                           part_path(folders.folder("a"), 0, 2).string());
}

TEST(FrontierParts, AreNamedIfTheyCannotBeRead) {
  PartFolders folders;
  EXPECT_THAT(folders.fault({"none"}), EndsWith("none: no such folder"));
  std::filesystem::create_directories(folders.folder("empty"));
  EXPECT_THAT(folders.fault({"empty"}),
              EndsWith("empty: holds no part of a frontier (records-I-of-N.jsonl)"));
  std::ofstream(folders.folder("empty") / "records-0-of-1.jsonl") << "x\n";
  EXPECT_THAT(folders.fault({"empty"}), HasSubstr("records-0-of-1.jsonl: line 1: is not JSON"));
  EXPECT_THAT(folders.fault({}), HasSubstr("no folder"));
}

}  // namespace
}  // namespace lightgrid::lab
