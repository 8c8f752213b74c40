// Compares the registry, the pages under docs/techniques, docs/command_line.md and the program's own output.
#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <set>

#include <nlohmann/json.hpp>

#include "support/paths.h"
#include "support/run_program.h"
#include "techniques/technique.h"

namespace lightgrid::app {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

const fs::path docs = fs::path(source_folder) / "docs";

std::string page_of(const std::string& technique) {
  return text_of(docs / "techniques" / (technique + ".md"));
}

std::set<std::string> registered() {
  std::set<std::string> names;
  for (const Technique* t : techniques()) names.insert(t->name);
  return names;
}

// The identifying words of a source: names, title and year. Words of at least three letters, and numbers.
std::vector<std::string> telling_words(const std::string& source) {
  std::vector<std::string> words = {""};
  for (const char c : source) {
    if (std::isalnum(static_cast<unsigned char>(c)) || (c & 0x80)) {
      words.back() += c;
    } else {
      words.emplace_back();
    }
  }
  std::erase_if(words, [](const std::string& word) { return word.size() < 3; });
  return words;
}

TEST(Techniques, HaveAPageEachAndEachPageHasATechnique) {
  std::set<std::string> pages;
  for (const auto& entry : fs::directory_iterator(docs / "techniques"))
    pages.insert(entry.path().stem().string());
  EXPECT_EQ(pages, registered());
}

TEST(Techniques, ArePagesThatNameTheirSource) {
  for (const Technique* t : techniques()) {
    for (const std::string& word : telling_words(t->source))
      EXPECT_THAT(page_of(t->name), HasSubstr(word)) << t->name;
  }
}

TEST(Techniques, ArePagesThatNameEverySettingOfTheirs) {
  for (const Technique* t : techniques()) {
    for (const char* key : t->settings) {
      EXPECT_THAT(page_of(t->name), HasSubstr("`" + std::string(key) + "`")) << t->name;
    }
  }
}

// The lists are those of runs: SettingsRead in techniques_tests.
TEST(Techniques, ReadEverySetting) {
  for (const SettingRow& s : setting_rows()) {
    EXPECT_TRUE(std::ranges::any_of(techniques(), [&](auto* t) { return reads_setting(*t, s.key); }))
        << s.key;
  }
}

TEST(Techniques, AreListedWithSettingsDefaultsAndSource) {
  const ProgramRun run = run_program({"techniques", "--json", "-"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  ASSERT_EQ(json["techniques"].size(), techniques().size());
  for (size_t i = 0; i < techniques().size(); ++i) {
    EXPECT_EQ(json["techniques"][i]["name"], techniques()[i]->name);
    EXPECT_EQ(json["techniques"][i]["source"], techniques()[i]->source);
    EXPECT_EQ(json["techniques"][i]["settings"].size(), techniques()[i]->settings.size());
  }
  const ProgramRun brief = run_program({"techniques"});
  EXPECT_EQ(brief.status, 0);
  EXPECT_THAT(brief.out,
              testing::AllOf(HasSubstr("\nsamples "), HasSubstr("\nraster "), HasSubstr(" more: ")));
  EXPECT_THAT(brief.out, testing::Not(HasSubstr("\nslice-spacing ")));
  const ProgramRun text = run_program({"techniques", "--settings"});
  EXPECT_EQ(text.status, 0);
  for (const Technique* t : techniques()) {
    EXPECT_THAT(text.out, HasSubstr(t->name));
    EXPECT_THAT(text.out, HasSubstr(t->source));
  }
  EXPECT_THAT(text.out,
              HasSubstr("settings: brdf=ggx cull-test=planes+aabb depth-bounds=minmax tile=16 slices=24"));
}

TEST(Techniques, AreNamedByTheHelpOfWhatTakesThem) {
  for (const char* command : {"render", "compare", "plan"}) {
    const ProgramRun run = run_program({command, "--help"});
    std::string words = run.out;  // the help breaks lines anywhere
    std::erase_if(words, [](char c) { return std::isspace(static_cast<unsigned char>(c)); });
    for (const std::string& name : registered()) EXPECT_THAT(words, HasSubstr(name)) << command;
  }
}

// The beginning of a setting's row: "| `tile` | `16` `8` `32` `64` |", "| `list-seed` | `1` `2` … `16` |".
std::string row_of(const SettingRow& s) {
  std::string row = "| `" + s.key + "` |";
  const bool is_long = s.values.size() > 10;
  for (const std::string& value : s.values) {
    if (is_long && value == s.values.back()) row += " …";
    if (!is_long || value == s.values.back() || value == s.values[0] || value == s.values[1])
      row += " `" + value + "`";
  }
  return row + " |";
}

// The page with the rows of all settings: a row keeps its words, a new one has those of --help and stands
// after the setting that is listed before it.
std::string with_settings_rows(std::string page) {
  const size_t begin = page.find("| setting | values | |");
  size_t after = page.find("| --- |", begin);
  for (const SettingRow& s : setting_rows()) {
    const std::string key = "\n| `" + s.key + "` |";
    const size_t found = page.find(key, begin);
    if (found == page.npos) {
      after = page.find('\n', after) + 1;
      page.insert(after, row_of(s) + ' ' + s.meaning + " |\n");
    } else {
      const size_t values = found + key.size();
      page.replace(found + 1, page.find('|', values) - found, row_of(s));
      after = found + 1;
    }
  }
  return page;
}

// UPDATE_SETTINGS=1 writes the rows.
TEST(Settings, StandInTheCommandLinesTableWithTheirValuesTheDefaultFirst) {
  const std::string page = text_of(docs / "command_line.md");
  if (std::getenv("UPDATE_SETTINGS"))
    std::ofstream(docs / "command_line.md", std::ios::binary) << with_settings_rows(page);
  for (const SettingRow& s : setting_rows()) {
    EXPECT_NE(text_of(docs / "command_line.md").find('\n' + row_of(s)), page.npos)
        << "docs/command_line.md: no row begins with " << row_of(s)
        << "; UPDATE_SETTINGS=1 with this test writes it";
  }
}

TEST(Settings, RowsOfTheTableAreWrittenWhereTheyAreMissing) {
  const std::string page = text_of(docs / "command_line.md");
  EXPECT_TRUE(with_settings_rows(page) == page);
  const SettingRow* tile = nullptr;
  for (const SettingRow& s : setting_rows()) tile = s.key == "tile" ? &s : tile;
  const size_t row = page.find("| `tile` |", page.find("| setting |")), end = page.find('\n', row) + 1;
  std::string changed = page;
  changed.replace(row, row_of(*tile).size(), "| `tile` | `1` |");
  EXPECT_TRUE(with_settings_rows(changed) == page);
  std::string without = page;
  without.erase(row, end - row);
  std::string expected = page;
  expected.replace(row, end - row, row_of(*tile) + ' ' + tile->meaning + " |\n");
  EXPECT_TRUE(with_settings_rows(without) == expected);
}

TEST(Settings, StartWithTheDefault) {
  const auto defaults = to_strings(Settings{});
  for (const SettingRow& s : setting_rows()) {
    std::string key = s.key;
    std::replace(key.begin(), key.end(), '-', '_');
    EXPECT_EQ(defaults.at(key), s.values.front()) << s.key;
  }
}

}  // namespace
}  // namespace lightgrid::app
