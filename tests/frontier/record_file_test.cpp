#include "frontier/record_file.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <limits>
#include <nlohmann/json.hpp>

#include "frontier/faults.h"
#include "frontier/some_records.h"
#include "support/read_files.h"
#include "support/temp_folder.h"

namespace lightgrid {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

struct PartFile {
  TempFolder folder;
  std::filesystem::path path = part_path(folder.path, 1, 4);
  Told told;

  RecordFile open(const FrontierPart& part = some_part()) { return RecordFile(path, part, told.notice()); }
  std::string text() const { return file_bytes(path); }

  // Three records, and the end.
  void fill() {
    RecordFile file = open();
    for (int view = 0; view < 3; ++view) file.append(some_record(8, view));
    file.finish(0.5);
  }
  std::string fault(const FrontierPart& part = some_part()) {
    return fault_of([&] { open(part); });
  }
};

void expect_equal(const FrontierRecord& a, const FrontierRecord& b) { EXPECT_EQ(to_json(a), to_json(b)); }

TEST(FrontierRecords, KeepEveryFieldAsJson) {
  const FrontierRecord r = some_record(8, 2);
  const nlohmann::json written = to_json(r);
  const FrontierRecord read = record_of(nlohmann::json::parse(written.dump()));
  EXPECT_EQ(read.point.scene, r.point.scene);
  EXPECT_EQ(read.point.technique, r.point.technique);
  EXPECT_EQ(read.point.settings, r.point.settings);
  EXPECT_EQ(read.point.label, r.point.label);
  EXPECT_EQ(read.point.frames, r.point.frames);
  EXPECT_EQ(read.view, r.view);
  EXPECT_EQ(read.width, r.width);
  EXPECT_EQ(read.height, r.height);
  EXPECT_EQ(read.lights, r.lights);
  EXPECT_EQ(read.radius_scale, r.radius_scale);
  EXPECT_EQ(read.series, r.series);
  EXPECT_EQ(read.refused, r.refused);
  EXPECT_EQ(read.frame_ms, r.frame_ms);
  EXPECT_EQ(read.baseline_ms, r.baseline_ms);
  EXPECT_EQ(read.pass_ms, r.pass_ms);
  EXPECT_EQ(read.bytes_moved, r.bytes_moved);
  EXPECT_EQ(read.memory_bytes, r.memory_bytes);
  EXPECT_EQ(read.covered_pixels, r.covered_pixels);
  EXPECT_EQ(read.pairs.listed, r.pairs.listed);
  EXPECT_EQ(read.pairs.lit, r.pairs.lit);
  EXPECT_EQ(read.pairs.lost, r.pairs.lost);
  EXPECT_EQ(read.pairs.wrong, r.pairs.wrong);
  EXPECT_EQ(read.nan_pixels, r.nan_pixels);
  EXPECT_EQ(read.overflow, r.overflow);
  EXPECT_EQ(read.errors.model.max_rel, r.errors.model.max_rel);
  EXPECT_EQ(read.errors.precision.rmse_rel, r.errors.precision.rmse_rel);
  EXPECT_EQ(read.errors.technique.relative_rmse, r.errors.technique.relative_rmse);
  EXPECT_EQ(read.errors.total.p99_rel, r.errors.total.p99_rel);
  EXPECT_EQ(read.errors.total.flip_mean, r.errors.total.flip_mean);
  EXPECT_EQ(read.errors.model.flip_mean, std::nullopt);
  EXPECT_EQ(read.errors.bias_rmse_rel, r.errors.bias_rmse_rel);
  EXPECT_EQ(read.errors.deviation_rmse_rel, r.errors.deviation_rmse_rel);
  EXPECT_EQ(read.errors.temporal_rmse_rel, r.errors.temporal_rmse_rel);
  ASSERT_TRUE(read.flip);
  EXPECT_EQ(read.flip->start, r.flip->start);
  EXPECT_EQ(read.flip->stop, r.flip->stop);
  EXPECT_EQ(read.flip->count, r.flip->count);
  EXPECT_EQ(read.image, r.image);
}

TEST(FrontierRecords, KeepNanAndInfinity) {
  FrontierRecord r = some_record(8, 0);
  r.errors.total = {.max_rel = infinite, .rmse_rel = std::nan(""), .p99_rel = -infinite};
  r.errors.bias_rmse_rel = std::nan("");
  r.errors.deviation_rmse_rel.reset();
  r.frame_ms[1] = infinite;
  const FrontierRecord read = record_of(nlohmann::json::parse(to_json(r).dump()));
  EXPECT_EQ(read.errors.total.max_rel, infinite);
  EXPECT_TRUE(std::isnan(read.errors.total.rmse_rel));
  EXPECT_EQ(read.errors.total.p99_rel, -infinite);
  EXPECT_TRUE(std::isnan(read.errors.bias_rmse_rel.value()));
  EXPECT_EQ(read.errors.deviation_rmse_rel, std::nullopt);
  EXPECT_EQ(read.frame_ms[1], infinite);
}

// Without a field, and with one of another type.
TEST(FrontierRecords, NameAWrongField) {
  const nlohmann::json good = to_json(some_record(8, 0));
  for (const auto& [name, value] : good.items()) {
    nlohmann::json line = good;
    line.erase(name);
    EXPECT_THAT(fault_of([&] { record_of(line); }), HasSubstr(name + " is missing"));
    line[name] = value.is_number() ? nlohmann::json("x") : nlohmann::json(7);
    EXPECT_THAT(fault_of([&] { record_of(line); }), AllOf(HasSubstr(name + ": "), HasSubstr(" is not a")));
  }
  nlohmann::json line = good;
  line["errors"]["total"]["p99_rel"] = true;
  EXPECT_EQ(fault_of([&] { record_of(line); }), "errors.total.p99_rel: true is not a number");
  line = good;
  line["baseline_ms"].push_back(1);
  EXPECT_EQ(fault_of([&] { record_of(line); }), "frame_ms: 3 times beside 4 of baseline_ms");
  line = good;
  line["lights"] = 3e9;
  EXPECT_EQ(fault_of([&] { record_of(line); }), "lights: 3000000000.0 is not a whole number");
  line["lights"] = 3000000000;
  EXPECT_EQ(fault_of([&] { record_of(line); }), "lights: 3000000000 is not a whole number of at least 0");
  line = good;
  line["memory_bytes"] = -1;
  EXPECT_EQ(fault_of([&] { record_of(line); }), "memory_bytes: -1 is not a whole number");
}

TEST(FrontierRecords, HaveAKeyOfWhatIsMeasuredAlone) {
  const FrontierRecord r = some_record(8, 1);
  std::set<std::string> keys = {record_key(r)};
  const auto add = [&](auto change) {
    FrontierRecord other = r;
    change(other);
    EXPECT_TRUE(keys.insert(record_key(other)).second) << to_json(other);
  };
  add([](FrontierRecord& o) { o.point.scene = "hall"; });
  add([](FrontierRecord& o) { o.point.technique = "tiled"; });
  add([](FrontierRecord& o) { o.point.settings["tile"] = "16"; });
  add([](FrontierRecord& o) { o.point.frames = 16; });
  add([](FrontierRecord& o) { o.view = 0; });
  add([](FrontierRecord& o) { o.width = 320; });
  add([](FrontierRecord& o) { o.height = 90; });
  add([](FrontierRecord& o) { o.lights = 1023; });
  add([](FrontierRecord& o) { o.radius_scale = 1; });
  add([](FrontierRecord& o) { o.series = "lights"; });
  FrontierRecord measured = r;
  measured.frame_ms.clear();
  measured.errors = {};
  measured.refused = "no";
  measured.image.clear();
  measured.shard = 3;
  EXPECT_EQ(record_key(measured), record_key(r));
  EXPECT_EQ(content_hash(""), "cbf29ce484222325");  // of the authors' test vectors
  EXPECT_EQ(content_hash("foobar"), "85944171f73967e8");
}

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
  for (size_t size = 0; size <= whole.size(); ++size) {
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
  for (size_t size = whole.find('\n') + 1; size <= whole.size(); size += 7) {
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

TEST(RecordFile, RefusesAFileOfAnotherRun) {
  PartFile part;
  part.fill();
  const std::string whole = part.text();
  const auto fault_with = [&](auto change) {
    FrontierPart other = some_part();
    change(other);
    return part.fault(other);
  };
  const std::string path = part.path.string();
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.request = "fff"; }),
              AllOf(HasSubstr(path), HasSubstr("request"), HasSubstr("0123456789abcdef is not fff")));
  EXPECT_EQ(fault_with([](FrontierPart& p) { p.commit = "abc"; }),
            path + ": commit 9d11b69 is not abc, that of this run");
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.seed = 2; }),
              HasSubstr("seed 18446744073709551615 is not 2"));
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.baseline = "forward"; }),
              HasSubstr("baseline forward_plus is not forward"));
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.shard = 2; }), HasSubstr("is shard 1 of 4, not 2"));
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.shards = 5; }), HasSubstr("number of shards 4 is not 5"));
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.machine.cpu = "Epyc"; }),
              HasSubstr("begun with CPU \"Xeon\", here it is \"Epyc\""));
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.machine.cl_driver = "PoCL 5"; }),
              HasSubstr("OpenCL driver"));
  EXPECT_THAT(fault_with([](FrontierPart& p) { p.machine.threads = 64; }), HasSubstr("threads"));
  EXPECT_EQ(part.text(), whole);

  FrontierPart later = some_part();  // another load, clock and governor are the same machine
  later.machine.load_at_start = 3;
  later.machine.clock_mhz = 900;
  later.machine.governor = "powersave";
  EXPECT_EQ(part.open(later).part().machine.load_at_start, 0.25);
}

// Nothing of somebody's own file is cut off.
TEST(RecordFile, RefusesAFileThatIsNoPart) {
  PartFile part;
  for (const char* text : {"glTF without newline", "{\"lightgrid\":", "a,b\n1,2\n", "{\"asset\": {}}\n", "\n",
                           "{\"lightgrid_frontier\":2,\"request\":\"x\"}\n"}) {
    write_text(part.path, text);
    EXPECT_THAT(part.fault(),
                AllOf(HasSubstr(part.path.string() + ": line 1: "), HasSubstr("not a part of a frontier")));
    EXPECT_EQ(part.text(), text);
  }
  write_text(part.path, "");
  EXPECT_THAT(fault_of([&] { read_part(part.path, nullptr); }), HasSubstr("not a part of a frontier"));
  EXPECT_THAT(fault_of([&] { read_part(part.folder.path, nullptr); }), HasSubstr("no such file"));
}

TEST(RecordFile, IsOfOneProcessAtATime) {
  PartFile part;
  const RecordFile file = part.open();
  EXPECT_THAT(part.fault(), HasSubstr("another process is writing it"));
}

TEST(RecordFile, RefusesWhatCannotBeWritten) {
  const TempFolder folder;
  write_text(folder.path / "file", "");
  const auto fault_at = [&](const std::filesystem::path& path) {
    return fault_of([&] { RecordFile(path, some_part(), nullptr); });
  };
  EXPECT_THAT(fault_at(folder.path), HasSubstr(folder.path.string() + ": cannot be written: "));
  EXPECT_THAT(fault_at(folder.path / "file" / "x"), HasSubstr("cannot be written: Not a directory"));
  EXPECT_THAT(fault_at(folder.path / "none" / "x"), HasSubstr("cannot be written: No such file"));

  using std::filesystem::perms;
  std::filesystem::permissions(
      folder.path, perms::owner_read | perms::owner_exec | perms::others_read | perms::others_exec);
  const uid_t user = geteuid();  // root may write anywhere
  ASSERT_EQ(user == 0 ? seteuid(65534) : 0, 0);
  const std::string fault = fault_at(folder.path / "x");
  ASSERT_EQ(user == 0 ? seteuid(0) : 0, 0);
  EXPECT_EQ(fault, (folder.path / "x").string() + ": cannot be written: Permission denied");
}

TEST(RecordFile, TellsThatTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_EQ(fault_of([] { RecordFile("/dev/full", some_part(), nullptr); }, ErrorKind::machine),
            "/dev/full: cannot be written: No space left on device");
}

// A limit on file sizes fills the disk in the middle of a line.
TEST(RecordFile, HoldsNoHalfLineWhenTheDiskIsFull) {
  PartFile part;
  part.fill();
  const std::string whole = part.text();
  RecordFile file = part.open();
  rlimit before = {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit tight = before;
  tight.rlim_cur = whole.size() + 100;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tight), 0);
  const std::string fault = fault_of([&] { file.append(some_record(8, 3)); }, ErrorKind::machine);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(fault, part.path.string() + ": cannot be written: File too large");
  EXPECT_EQ(part.text(), whole);
  EXPECT_EQ(file.part().records.size(), 3u);
  file.append(some_record(8, 3));
  EXPECT_EQ(read_part(part.path, nullptr).records.size(), 4u);
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
}  // namespace lightgrid
