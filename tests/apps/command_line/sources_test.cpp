// How the tree's C++, kernels and shaders are written.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "support/cpp_statements.h"
#include "support/paths.h"
#include "support/read_files.h"
#include "support/run_command.h"

namespace lightgrid::app {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> source_files() {
  static const std::set<fs::path> extensions = {".h", ".cpp", ".cl", ".glsl", ".vert", ".frag", ".comp"};
  std::vector<fs::path> files;
  for (const char* folder : {"src", "kernels", "shaders", "tests", "tools"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(source_folder) / folder))
      if (entry.is_regular_file() && extensions.contains(entry.path().extension()))
        files.push_back(entry.path());
  return files;
}

TEST(JoinedStatements, AreFoundInEveryPlaceOfAStatement) {
  for (const char* text :
       {"a = b, c = d;", "if (x) a(), b();", "for (int i = 0, j = 1; i < j; ++i, ++j) a(), b();",
        "f([&] { return ++n, true; });", "{ int k; } x.y = 1, ++z;", "*p = 1, *q = 2;",
        "else\n  a[i, j] = {1, 2}, b = 1;", "EACH(x) a = 1, b = 2;"})
    EXPECT_EQ(joined_statements(text).size(), 1u) << text;
}

TEST(JoinedStatements, AreNotDeclarationsOrLists) {
  for (const char* text :
       {"int a = 1, b = 2;", "const std::map<int, Row> rows = {{1, 2}}, more;", "f(a, b);", "T x{1, 2};",
        "for (int i = 0, j = 1; i < j; ++i, ++j) a();", "std::vector<std::array<int, 3>> v(1, {});",
        "class A : B, C {};", "A() : a(1), b{2} {}\nint c;", "auto f = [a, &b] { g(a, b); };",
        "// a, b;\nc();", "#define X a, b;\nc();", "s = \"a, b;\";", "template <class A, class B> void f();"})
    EXPECT_EQ(joined_statements(text).size(), 0u) << text;
}

// One statement per line, ended by a semicolon.
TEST(JoinedStatements, AreFewInTheTree) {
  std::vector<std::string> joined;
  for (const fs::path& file : source_files())
    for (const std::string& statement : joined_statements(file_bytes(file)))
      joined.push_back(file.string() + ":" + statement);
  EXPECT_LE(joined.size(), 30u) << testing::PrintToString(joined);
}

using Definitions = std::map<std::string, std::set<fs::path>>;  // files by the type's full name

// Types that begin a line, as clang-format has those of a namespace. Those without a name of their namespace
// are left out: a program may have several.
void add_definitions(Definitions& all, const fs::path& file, const std::string& text) {
  static const std::regex place(
      R"(^(?:namespace ?([\w:]*) ?\{|\}  // namespace ?([\w:]*)|(?:struct|class|union|enum class|enum) (\w+)( [^;]*)?\{.*))");
  std::vector<std::string> scopes;
  std::istringstream lines(text);
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (!std::regex_search(line, match, place)) continue;
    if (line.starts_with("namespace")) {
      scopes.push_back(match[1]);
    } else if (line.starts_with("}")) {
      if (!scopes.empty()) scopes.pop_back();
    } else if (!scopes.empty() && std::ranges::find(scopes, "") == scopes.end()) {
      std::string name;
      for (const std::string& scope : scopes) name += scope + "::";
      all[name + match[3].str()].insert(file);
    }
  }
}

TEST(Types, DefinedTwiceAreFound) {
  Definitions all;
  add_definitions(all, "a.h", "namespace lightgrid {\nstruct A {\n};\nclass B;\n}  // namespace lightgrid\n");
  add_definitions(all, "b.h",
                  "namespace lightgrid {\nclass A : public C {\nclass B {}\n}  // namespace lightgrid\n");
  add_definitions(all, "c.h",
                  "namespace lightgrid {\nnamespace {\nstruct B {\n}  // namespace\nenum class A { a };\n");
  EXPECT_EQ(all["lightgrid::A"].size(), 3u);
  EXPECT_EQ(all["lightgrid::B"].size(), 1u);
}

Definitions definitions_of(const char* folder) {
  Definitions all;
  const std::string path = (fs::path(source_folder) / folder / "").string();
  for (const fs::path& file : source_files())
    if (file.string().starts_with(path)) add_definitions(all, file, file_bytes(file));
  return all;
}

// One program may not contain two types of one name: -Wodr reports them only with -flto.
TEST(Types, AreDefinedInOneFileOfANamespace) {
  const Definitions all = definitions_of("src");
  EXPECT_GT(all.size(), 500u);
  for (const auto& [name, files] : all) EXPECT_EQ(files.size(), 1u) << name << testing::PrintToString(files);
}

TEST(Types, AreInTheNamespaceOfTheirHouse) {
  const std::string lab = "lightgrid::lab::", app = "lightgrid::app::";
  for (const auto& [house, inside] : {std::pair{"src/laboratory", lab}, {"src/apps", app}}) {
    const Definitions all = definitions_of(house);
    EXPECT_GT(all.size(), 40u) << house;
    for (const auto& [name, files] : all)
      EXPECT_TRUE(name.starts_with(inside) || name.starts_with("lightgrid_"))
          << name << testing::PrintToString(files);
  }
  for (const auto& [name, files] : definitions_of("src/engine"))
    EXPECT_FALSE(name.starts_with(lab) || name.starts_with(app)) << name << testing::PrintToString(files);
}

// The laboratory draws and reads frames through run/frames.h. tools/size.py prints the number of headers.
TEST(Headers, OfTheEngineThatTheLaboratoryIncludesAreFew) {
  static const std::set<std::string> inside = {"bridge",   "effects",     "gl",         "passes",
                                               "renderer", "shadow_maps", "techniques", "world_grid"};
  static const std::regex include(R"raw((?:^|\n)#include "((\w+)/[^"]+)")raw");
  const fs::path root(source_folder);
  std::set<std::string> headers, of_inside;
  for (const fs::path& file : source_files()) {
    if (!file.string().starts_with((root / "src/laboratory/").string())) continue;
    const std::string text = file_bytes(file);
    for (std::sregex_iterator i(text.begin(), text.end(), include), end; i != end; ++i) {
      const std::string header = (*i)[1];
      if (!fs::exists(root / "src/engine" / header)) continue;
      headers.insert(header);
      if (inside.contains((*i)[2])) of_inside.insert(header);
    }
  }
  EXPECT_GT(headers.size(), 30u);
  EXPECT_LE(headers.size(), 77u) << testing::PrintToString(headers);
  EXPECT_THAT(of_inside, testing::IsSubsetOf({"passes/light_index/lidr_settings.h"}));  // names settings
}

// All formatting depends on clang-format's version: Debian 12 has 14.
bool has_clang_format() {
  return run_command("clang-format --version 2>&1").output.find(" 14.") != std::string::npos;
}

const std::string check_format = "cd " + std::string(source_folder) + " && clang-format --dry-run -Werror ";

TEST(Format, ReportsWhatIsNotFormatted) {
  if (!has_clang_format()) GTEST_SKIP() << "no clang-format 14";
  EXPECT_EQ(run_command(check_format + "--assume-filename=src/a.cpp 2>&1 << 'end'\nint a;\nend\n").status, 0);
  EXPECT_NE(run_command(check_format + "--assume-filename=src/a.cpp 2>&1 << 'end'\nint  a;\nend\n").status,
            0);
}

// Files changed by the last ten commits or since; all files where git cannot tell, which take half a minute.
TEST(Format, IsThatOfClangFormat) {
  if (!has_clang_format()) GTEST_SKIP() << "no clang-format 14";
  const std::string git = "cd " + std::string(source_folder) +
                          " && git -c safe.directory='*' diff --name-only HEAD~10 2>/dev/null";
  const CommandOutcome changed = run_command(git);
  std::string names;
  for (const fs::path& file : source_files()) {
    const std::string name = file.lexically_relative(source_folder).string(),
                      extension = file.extension().string();
    const bool formatted = extension == ".h" || extension == ".cpp" || extension == ".cl";
    if (formatted && (changed.status != 0 || changed.output.find(name + "\n") != std::string::npos))
      names += " " + name;
  }
  if (names.empty()) return;
  const CommandOutcome outcome = run_command(check_format + names + " 2>&1");
  EXPECT_EQ(outcome.status, 0) << "run clang-format -i on them: " << outcome.output.substr(0, 4000);
}

}  // namespace
}  // namespace lightgrid::app
