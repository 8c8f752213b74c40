// liblightgrid.so as other programs find it: installed, its symbols, its ABI, the example in C.
#include <gmock/gmock.h>

#include <regex>
#include <set>

#include "support/installed_library.h"
#include "support/read_files.h"
#include "support/temp_folder.h"

namespace lightgrid::app {
namespace {

std::string header() { return file_bytes(std::string(source_folder) + "/src/apps/c_api/lightgrid.h"); }

// The functions of the header, whose declarations begin a line.
std::set<std::string> declared() {
  const std::string text = header();
  const std::regex function(R"(\n(?:lightgrid_status|void|const char\*) (lightgrid_\w+)\()");
  std::set<std::string> names;
  for (std::sregex_iterator i(text.begin(), text.end(), function), end; i != end; ++i) names.insert((*i)[1]);
  return names;
}

TEST(CLibrarySymbols, AreThoseOfTheHeaderAndNoOthers) {
  if (!has_tool("nm")) GTEST_SKIP() << "there is no nm";
  std::istringstream lines(must_run(std::string("nm -D --defined-only ") + LIGHTGRID_C_LIBRARY));
  std::set<std::string> shown;
  for (std::string address, kind, name; lines >> address >> kind >> name;)
    if (kind != "A") shown.insert(name);
  std::set<std::string> expected;
  for (const std::string& name : declared()) expected.insert(name + "@@LIGHTGRID_0");
  EXPECT_GT(expected.size(), 40u);
  EXPECT_EQ(shown, expected);
}

// A library of empty functions that is made of the header alone, so that the ABI is that of what callers
// compile, and of nothing inside.
void write_stub(const std::filesystem::path& path) {
  std::string text = "#include <stddef.h>\n#include <stdint.h>\n" + header();
  text = std::regex_replace(text, std::regex("#include <std(def|int)\\.h>"), "");
  text =
      std::regex_replace(text, std::regex(R"(\n(lightgrid_status|const char\*) (lightgrid_\w+\([^;]*\));)"),
                         "\n$1 $2 { return 0; }");
  text = std::regex_replace(text, std::regex(R"(\nvoid (lightgrid_\w+\([^;]*\));)"), "\nvoid $1 {}");
  std::ofstream(path) << "#include <stddef.h>\n#include <stdint.h>\n" << text;
}

// UPDATE_ABI=1 writes it anew.
TEST(CLibraryAbi, IsTheCommittedOne) {
  if (!has_tool("abidiff")) GTEST_SKIP() << "there is no abidiff (Debian: abigail-tools)";
  if (must_run("uname -m") != "x86_64\n") GTEST_SKIP() << "lightgrid.abi is that of x86-64";
  const TempFolder temp;
  const std::string stub = temp.path / "liblightgrid.so", source = temp.path / "lightgrid.c",
                    known = std::string(source_folder) + "/tests/apps/c_api/lightgrid.abi";
  write_stub(source);
  must_run("cc -std=c99 -g -w -fdebug-prefix-map=" + temp.path.string() +
           "=. -shared -fPIC -Wl,-soname,liblightgrid.so.0 -o " + stub + " " + source);
  if (std::getenv("UPDATE_ABI"))
    must_run("abidw --no-corpus-path --no-comp-dir-path --no-show-locs --out-file " + known + " " + stub);
  must_run("abidiff --no-show-locs " + known + " " + stub);
}

TEST(CLibraryInstalled, IsFoundByPkgConfigAndDrawsInTheExample) {
  for (const char* tool : {LIGHTGRID_CMAKE, "cc", "pkg-config"})
    if (!has_tool(tool)) GTEST_SKIP() << "there is no " << tool;
  const TempFolder temp;
  const std::string prefix = temp.path / "prefix", program = temp.path / "render_c",
                    picture = temp.path / "p.png";
  must_run(fmt::format("{} --install {} --component c_library --prefix {}", LIGHTGRID_CMAKE,
                       LIGHTGRID_BUILD_DIR, prefix));
  const std::string found = must_run("dirname $(find " + prefix + " -name lightgrid.pc)");
  const std::string pkgconfig = found.substr(0, found.find('\n'));
  must_run(fmt::format(
      "cd {} && cc -std=c99 -pedantic -Wall -Wextra -Werror {}/docs/examples/render_c/main.c -o {} "
      "$(PKG_CONFIG_PATH={} pkg-config --cflags --libs lightgrid) {}",
      temp.path.string(), source_folder, program, pkgconfig, LIGHTGRID_C_FLAGS));
  const std::string out = must_run(fmt::format("LD_LIBRARY_PATH={}/.. {} {}", pkgconfig, program, picture));
  // By hand: the image's centre shows the point (0, 0, 0). Lamps 27, 28, 35 and 36 are 1.25 m off in x and in
  // z and reach it.
  EXPECT_THAT(out, testing::StartsWith("10 x 6 tiles, "));
  const size_t centre = out.find("centre:");
  ASSERT_NE(centre, out.npos) << out;
  std::istringstream numbers(out.substr(centre + 7));
  const std::set<int> listed{std::istream_iterator<int>(numbers), {}};
  EXPECT_THAT(listed, testing::IsSupersetOf({27, 28, 35, 36}));
  EXPECT_LT(listed.size(), 16u);
  EXPECT_GT(std::filesystem::file_size(picture), 1000u);
}

}  // namespace
}  // namespace lightgrid::app
