#include "frontier/record_file.h"
#include "frontier/fields.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "frontier/part_file.h"

namespace lightgrid::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

void expect_equal(const FrontierRecord& a, const FrontierRecord& b) { EXPECT_EQ(to_json(a), to_json(b)); }

TEST(RecordFile, ReadsWhatWasAppended) {
  PartFile part;
  part.fill();
  EXPECT_THAT(part.told.lines, IsEmpty());
  const FrontierPart read = read_part(part.path, part.told.notice());
  EXPECT_EQ(read.request, some_part().request);
  EXPECT_EQ(read.commit, some_part().commit);
  EXPECT_EQ(read.seed, some_part().seed);
  EXPECT_EQ(read.shard, 1);
  EXPECT_EQ(read.shards, 4);
  EXPECT_EQ(read.baseline, some_part().baseline);
  EXPECT_TRUE(read.finished);
  EXPECT_EQ(read.machine.clock_mhz, 2600);
  EXPECT_EQ(read.machine.load_at_start, 0.25);
  EXPECT_EQ(read.machine.load_at_end, 0.5);
  ASSERT_EQ(read.records.size(), 3u);
  for (int view = 0; view < 3; ++view) {
    expect_equal(read.records[view], some_record(8, view));
    EXPECT_EQ(read.records[view].shard, 1);
  }
  EXPECT_THAT(part.told.lines, IsEmpty());
}

TEST(RecordFile, GoesOnWhereItEnded) {
  PartFile part;
  part.fill();
  {
    RecordFile file = part.open();
    EXPECT_TRUE(file.part().finished);
    EXPECT_EQ(file.part().records.size(), 3u);
    EXPECT_TRUE(file.has(record_key(some_record(8, 2))));
    EXPECT_FALSE(file.has(record_key(some_record(8, 3))));
    file.append(some_record(8, 3));
    EXPECT_TRUE(file.has(record_key(some_record(8, 3))));
    EXPECT_FALSE(file.part().finished);
    EXPECT_EQ(file.part().records.back().shard, 1);
  }
  const FrontierPart read = read_part(part.path, nullptr);
  EXPECT_EQ(read.records.size(), 4u);
  EXPECT_FALSE(read.finished);
}

// A scene's path may be any bytes.
TEST(RecordFile, FindsRecordsAgainWhosePathIsNotText) {
  PartFile part;
  FrontierRecord record = some_record(8, 0);
  record.point.scene = "\xff\xfe.glb";
  part.open().append(record);
  EXPECT_TRUE(part.open().has(record_key(record)));
}

TEST(RecordFile, KeepsTheWarningsOfTheRunThatFinishedIt) {
  PartFile part;
  const std::vector<Warning> warnings = {{"no lights"},
                                         {"no range", {"range=cutoff"}, "lightgrid --set range=cutoff"}};
  part.open().finish(0.5, warnings);
  EXPECT_EQ(part.open().part().warnings, warnings);
}

// Each size about a line's end, and every eleventh between.
std::vector<size_t> sizes_cut_off(const std::string& whole) {
  std::vector<size_t> sizes;
  for (size_t size = 0; size <= whole.size(); ++size) {
    const std::string_view near = std::string_view(whole).substr(size - std::min<size_t>(size, 2), 4);
    if (size % 11 == 0 || size < 4 || near.find('\n') != near.npos) sizes.push_back(size);
  }
  return sizes;
}

// As after a kill at any moment: never a crash, never an error, at most the last record is lost, and run
// again the file has what it would have had.
TEST(RecordFile, LosesAtMostTheLastRecordWhereverItIsCutOff) {
  PartFile part;
  const auto go_on = [](RecordFile& file) {
    for (int view = 0; view < 2; ++view) {
      if (!file.has(record_key(some_record(8, view)))) file.append(some_record(8, view));
    }
    if (!file.part().finished) file.finish(0.5);
  };
  {
    RecordFile file = part.open();
    go_on(file);
  }
  const std::string whole = part.text();
  for (const size_t size : sizes_cut_off(whole)) {
    write_text(part.path, whole.substr(0, size));
    const std::string kept = whole.substr(0, size);
    const auto lines = static_cast<size_t>(std::count(kept.begin(), kept.end(), '\n'));
    const bool half = !kept.empty() && kept.back() != '\n';
    part.told.lines.clear();
    {
      RecordFile file = part.open();
      EXPECT_EQ(file.part().records.size(), std::min<size_t>(2, std::max<size_t>(lines, 1) - 1)) << size;
      EXPECT_EQ(part.told.lines.size(), half ? 1u : 0u) << size;
      go_on(file);
    }
    ASSERT_EQ(part.text(), whole) << "cut off after " << size;
  }
}

// A point of which only some views were there would count as measured, with the figures of those views.
TEST(RecordFile, HoldsAllViewsOfAPointOrNone) {
  PartFile part;
  const std::vector<FrontierRecord> views = {some_record(8, 0), some_record(8, 1), some_record(8, 2)};
  part.open().append(views);
  const std::string whole = part.text();
  EXPECT_EQ(std::count(whole.begin(), whole.end(), '\n'), 2);
  for (size_t size = whole.find('\n') + 1; size <= whole.size(); size += 23) {
    write_text(part.path, whole.substr(0, size));
    const RecordFile file = part.open();
    EXPECT_EQ(file.part().records.size(), size == whole.size() ? 3u : 0u) << size;
  }
  write_text(part.path, whole);
  const FrontierPart read = read_part(part.path, nullptr);
  ASSERT_EQ(read.records.size(), 3u);
  for (int view = 0; view < 3; ++view) expect_equal(read.records[view], views[view]);
  EXPECT_EQ(read.records[2].shard, 1);
  EXPECT_TRUE(part.open().has(record_key(views[2])));
}

TEST(RecordFile, TellsWhichLineIsHalfWritten) {
  PartFile part;
  part.fill();
  const std::string whole = part.text();
  write_text(part.path, whole.substr(0, whole.size() - 40));
  const FrontierPart read = read_part(part.path, part.told.notice());
  EXPECT_EQ(part.told.lines.size(), 1u);
  EXPECT_EQ(part.text(), whole.substr(0, whole.size() - 40)) << "reading changes nothing";
  part.open();
  EXPECT_EQ(part.told.lines[1], part.path.string() + ": line 4: is half-written and left out");
  EXPECT_EQ(read.records.size(), 2u);
}

TEST(RecordFile, NamesADamagedLine) {
  PartFile part;
  part.fill();
  const std::string whole = part.text();
  std::vector<size_t> starts = {0};
  for (size_t i = 0; i < whole.size(); ++i) {
    if (whole[i] == '\n') starts.push_back(i + 1);
  }
  const auto with_line_3 = [&](const std::string& line) {
    return whole.substr(0, starts[2]) + line + "\n" + whole.substr(starts[3]);
  };
  const std::string deep(100000, '['), huge = "\"" + std::string(65 << 20, 'x') + "\"";
  const std::pair<std::string, std::string> damaged[] = {{"", "is not JSON"},
                                                         {"{\"scene\": \"ha", "is not JSON"},
                                                         {"17", "17 is not an object"},
                                                         {"{}", "scene is missing"},
                                                         {deep, "is nested deeper"},
                                                         {huge, "is longer than 64 MiB"},
                                                         {std::string(50, '\0'), "is not JSON"}};
  for (const auto& [line, why] : damaged) {
    write_text(part.path, with_line_3(line));
    EXPECT_THAT(part.fault(), AllOf(HasSubstr(part.path.string() + ": line 3: "), HasSubstr(why)));
    EXPECT_EQ(part.text(), with_line_3(line)) << "the file is as it was";
    EXPECT_THAT(fault_of([&] { read_part(part.path, nullptr); }), HasSubstr("line 3: "));
  }
}

TEST(RecordFile, CountsARecordThatIsThereTwiceOnce) {
  PartFile part;
  part.fill();
  const std::string whole = part.text();
  const size_t second = whole.find('\n') + 1;
  write_text(part.path, whole + whole.substr(second, whole.find('\n', second) + 1 - second));
  EXPECT_EQ(part.open().part().records.size(), 3u);
  ASSERT_EQ(part.told.lines.size(), 1u);
  EXPECT_THAT(part.told.lines[0], AllOf(HasSubstr("line 6: "), HasSubstr("view 0, is there twice")));
}

// Two views of two points and one round of their times, cut off anywhere: what the lines before it say is
// there, and only "complete" makes records of it.
TEST(RecordFile, KeepsFiguresAndRoundsOfASceneThatIsBeingMeasured) {
  PartFile part;
  std::vector<FrontierRecord> records;
  for (const int tile : {8, 16}) {
    for (const int view : {0, 1}) {
      records.push_back(some_record(tile, view));
      records.back().frame_ms.clear();
      records.back().baseline_ms.clear();
      records.back().cull_ms.clear();
      records.back().processes.clear();
      for (const auto& [key, times] : times_by_device) (records.back().*times).clear();
    }
  }
  std::vector<std::string> keys;
  for (const FrontierRecord& r : records) keys.push_back(record_key(r));
  {
    RecordFile file = part.open();
    for (const FrontierRecord& r : records) file.begin(r);
    file.add_cull_times({{keys[0], 0.3}, {keys[2], 0.1}});
    file.add_times({{keys[0], 1, 2, "", DeviceTimes{0.5, 0.25, 0.125, 1.0 / 7}, 1.5},
                    {keys[1], 1.0 / 3, 4, ""},
                    {keys[3], 0, 0, "no memory"}});
    EXPECT_TRUE(file.part().records.empty());
    file.complete(keys);
    EXPECT_EQ(file.part().records.size(), 4u);
    EXPECT_TRUE(file.open_records().empty());
  }
  records[0].cull_ms = {0.3};
  records[2].cull_ms = {0.1};
  for (FrontierRecord& r : records) r.processes.clear();
  records[0].frame_ms = {1};
  records[0].baseline_ms = {2};
  records[0].processes = {0};
  records[0].device_ms = {0.5};
  records[0].hand_over_ms = {0.25};
  records[0].copy_ms = {0.125};
  records[0].read_back_ms = {1.0 / 7};
  records[0].baseline_device_ms = {1.5};
  records[1].frame_ms = {1.0 / 3};
  records[1].baseline_ms = {4};
  records[1].processes = {0};
  records[3].refused = "no memory";
  const std::string whole = part.text();
  const FrontierPart read = read_part(part.path, nullptr);
  ASSERT_EQ(read.records.size(), 4u);
  for (size_t i = 0; i < 4; ++i) expect_equal(read.records[i], records[i]);
  EXPECT_EQ(read.records[3].shard, 1);

  for (size_t size = whole.find('\n') + 1; size <= whole.size(); size += 97) {
    const std::string kept = whole.substr(0, size);
    const auto lines =
        static_cast<size_t>(std::count(kept.begin(), kept.end(), '\n'));  // 1 + 4 + 1 + 1 + 1 + 1
    write_text(part.path, kept);
    const RecordFile file = part.open();
    EXPECT_TRUE(file.part().records.empty());
    EXPECT_EQ(file.open_records().size(), std::min<size_t>(lines - 1, 4)) << size;
    if (lines < 6) continue;
    EXPECT_EQ(file.open_records().at(keys[2]).cull_ms, std::vector{0.1});
    EXPECT_EQ(file.open_records().at(keys[1]).frame_ms.size(), lines < 8 ? 0 : 1) << size;
  }
}

// Each process that opens a part and takes times is another one; one that takes none is not counted.
TEST(RecordFile, KnowsWhichProcessTookATime) {
  PartFile part;
  FrontierRecord record = some_record(8, 0);
  record.frame_ms.clear();
  record.baseline_ms.clear();
  record.processes.clear();
  for (const auto& [name, times] : times_by_device) (record.*times).clear();
  const std::string key = record_key(record);
  {
    RecordFile file = part.open();
    file.begin(record);
    file.add_times({{key, 1, 2, ""}});
    file.add_times({{key, 3, 4, ""}});
  }
  part.open();
  RecordFile file = part.open();
  file.add_times({{key, 5, 6, ""}});
  file.complete({key});
  EXPECT_EQ(file.part().records[0].processes, (std::vector{0, 0, 1}));
  EXPECT_EQ(file.part().records[0].frame_ms, (std::vector{1.0, 3.0, 5.0}));
}

TEST(RecordFile, NamesTimesOfNoRecord) {
  PartFile part;
  part.open();
  const std::string header = part.text();
  for (const auto& [line, why] :
       {std::pair{R"({"times":{"abc":[1,2]}})", "abc is no record that is open"},
        {R"({"times":{},"device_times":{"abc":[1,2,3,4,5]}})", "abc is no record that is open"},
        {R"({"complete":["abc"]})", "abc is no record that is open"},
        {R"({"complete":7})", "complete: 7 is not an array"},
        {R"({"times":[]})", "times: array is not an object"}}) {
    write_text(part.path, header + line + "\n");
    EXPECT_THAT(part.fault(), AllOf(HasSubstr("line 2: "), HasSubstr(why)));
  }
}

TEST(Shards, AreEveryNthPoint) {
  for (const int shards : {1, 2, 3, 7}) {
    std::vector<int> points(shards);
    for (size_t index = 0; index < 20; ++index) {
      int holders = 0;
      for (int shard = 0; shard < shards; ++shard) {
        if (!in_shard(index, shard, shards)) continue;
        ++holders;
        ++points[shard];
      }
      EXPECT_EQ(holders, 1);
    }
    EXPECT_LE(
        *std::max_element(points.begin(), points.end()) - *std::min_element(points.begin(), points.end()), 1);
  }
  for (const auto& [shard, shards] : {std::pair{0, 0}, {1, 1}, {-1, 2}, {0, -3}}) {
    EXPECT_THAT(fault_of([&] { in_shard(0, shard, shards); }),
                HasSubstr(fmt::format("shard {}/{}", shard, shards)));
  }
}

}  // namespace
}  // namespace lightgrid::lab
