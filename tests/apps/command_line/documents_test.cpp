// The pages under docs/: their links, their contents page, and the references to them in comments. The files
// and folders that pages, comments and scripts name. How comments begin.
#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "support/paths.h"

namespace lightgrid::app {
namespace {

namespace fs = std::filesystem;

const fs::path checkout = source_folder;

std::string whole_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<fs::path> files_under(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  return files;
}

std::vector<fs::path> all_pages() {
  std::vector<fs::path> all = files_under(checkout / "docs");
  std::erase_if(all, [](const fs::path& path) { return path.extension() != ".md"; });
  all.push_back(checkout / "README.md");
  return all;
}

// A heading's anchor as GitHub makes it, for headings whose other characters than ASCII are letters.
std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : std::regex_replace(heading, std::regex(R"(\]\([^)]*\))"), "")) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) || byte >= 0x80 || c == '_' || c == '-') anchor += char(std::tolower(byte));
    if (c == ' ') anchor += '-';
  }
  return anchor;
}

const std::set<std::string>& anchors_of(const fs::path& page) {
  static std::map<fs::path, std::set<std::string>> known;
  if (const auto found = known.find(page); found != known.end()) return found->second;
  std::set<std::string>& anchors = known[page];
  std::ifstream file(page);
  for (std::string line; std::getline(file, line);) {
    const size_t level = line.find_first_not_of('#');
    if (level > 0 && level < line.size() && line[level] == ' ')
      anchors.insert(anchor_of(line.substr(level + 1)));
  }
  return anchors;
}

// `link`: a path from `folder`, with or without an anchor. The anchor alone is one of `page`.
void expect_target(const fs::path& page, const fs::path& folder, const std::string& link) {
  const size_t hash = link.find('#');
  const fs::path file = hash == 0 ? page : (folder / link.substr(0, hash)).lexically_normal();
  EXPECT_TRUE(fs::exists(file)) << page << ": " << link;
  if (hash != std::string::npos && file.extension() == ".md") {
    EXPECT_TRUE(anchors_of(file).contains(link.substr(hash + 1))) << page << ": " << link;
  }
}

void for_matches(const std::string& text, const char* pattern, auto&& found) {
  const std::regex expression(pattern);
  for (std::sregex_iterator i(text.begin(), text.end(), expression); i != std::sregex_iterator(); ++i)
    found((*i)[1].str());
}

// Without blocks of code, where [](x) is no link.
std::string prose_of(const fs::path& page) {
  std::istringstream lines(whole_text(page));
  std::string prose;
  bool in_code = false;
  for (std::string line; std::getline(lines, line);) {
    const bool fence = line.starts_with("```");
    in_code ^= fence;
    if (!in_code && !fence) prose += line + '\n';
  }
  return prose;
}

TEST(Documents, HaveLinksThatLeadSomewhere) {
  for (const fs::path& page : all_pages()) {
    for_matches(prose_of(page), R"(\]\(([^)\s]+)\))", [&](const std::string& link) {
      if (!link.starts_with("http")) expect_target(page, page.parent_path(), link);
    });
  }
}

TEST(Documents, AreWhereCommentsSay) {
  for (const char* folder : {"src", "kernels", "shaders", "tests"}) {
    for (const fs::path& file : files_under(checkout / folder)) {
      for_matches(whole_text(file), R"((?:^|[^/\w])(docs/[\w./-]+\.md(?:#[\w-]+)?))",
                  [&](const std::string& link) { expect_target(file, checkout, link); });
    }
  }
}

// The files of the checkout by every end of their path that begins with a folder's or the file's name.
const std::set<std::string>& path_ends() {
  static std::set<std::string> ends;
  if (!ends.empty()) return ends;
  for (const char* folder : {"src", "kernels", "shaders", "tests", "tools", "docs", "cmake", "python"}) {
    for (const fs::path& file : files_under(checkout / folder)) {
      const std::string path = file.lexically_relative(checkout).generic_string();
      for (size_t at = 0; at != std::string::npos; at = path.find('/', at + 1))
        ends.insert(path.substr(at == 0 ? 0 : at + 1));
    }
  }
  return ends;
}

// Words in capitals stand for names: kernels/SUBJECT/NAME.cl. Two files are made by the program and by an
// installation.
bool is_placeholder(const std::string& path) {
  return std::regex_search(path, std::regex("[A-Z]{2}")) || path == "shared/effects.h" ||
         path == "shared/effect_surfaces.h" || path == "include/lightgrid.h";
}

// The paths of sources in a text, from any folder, that no file has; and paths from the checkout, of files
// (also without .md) and folders, that do not exist.
std::set<std::string> missing_paths(const std::string& text) {
  std::set<std::string> missing;
  const auto require = [&](const std::string& path, bool exists) {
    if (!exists && !is_placeholder(path)) missing.insert(path);
  };
  for_matches(text,
              R"((?:^|[^\w/.$<{}*-])((?:[\w-]+/)+[\w-]+\.(?:h|cpp|cl|glsl|vert|frag|comp|py|sh))(?![\w/*{]))",
              [&](const std::string& path) { require(path, path_ends().contains(path)); });
  for_matches(
      text,
      R"re((?:^|[\s`("'])((?:src|kernels|shaders|tests|tools|docs|cmake|assets)/[\w./-]*\w)(?=\.?(?:$|[\s`,;:)"'\]])))re",
      [&](const std::string& path) {
        require(path, fs::exists(checkout / path) || fs::exists(checkout / (path + ".md")));
      });
  return missing;
}

TEST(Paths, InTextsAreFound) {
  using testing::ElementsAre, testing::IsEmpty;
  EXPECT_THAT(missing_paths("see cl/device.h, src/engine/cl/device.h and `src/engine/cl`."), IsEmpty());
  EXPECT_THAT(missing_paths("see session/compare.h and src/session."),
              ElementsAre("session/compare.h", "src/session"));
  EXPECT_THAT(missing_paths("kernels/SUBJECT/NAME.cl, kernels/culling/*/sample_lists.cl, #include <GL/gl.h>"),
              IsEmpty());
}

TEST(Paths, InCommentsExist) {
  const std::set<std::string> of_others = {"cuda.h", "glcorearb.h", "osmesa.h", "_clang_opencl.h",
                                           "LightGridInjection.cpp"};
  for (const char* folder : {"src", "kernels", "shaders", "tests", "tools"}) {
    for (const fs::path& file : files_under(checkout / folder)) {
      std::ifstream lines(file);
      std::string comments;
      for (std::string line; std::getline(lines, line);) {
        if (const size_t comment = line.find("//"); comment != std::string::npos)
          comments += line.substr(comment + 2) + '\n';
      }
      EXPECT_THAT(missing_paths(comments), testing::IsEmpty()) << file;
      for_matches(
          comments, R"((?:^|[^\w/.<-])(\w{2,}\.(?:h|cpp|cl|glsl|vert|frag))\b)",
          [&](const std::string& name) {
            EXPECT_TRUE(path_ends().contains(name) || is_placeholder(name) || of_others.contains(name))
                << file << ": " << name;
          });
    }
  }
}

TEST(Paths, InPagesAndScriptsExist) {
  for (const fs::path& page : all_pages()) {
    const std::string prose = prose_of(page);
    EXPECT_THAT(missing_paths(prose), testing::IsEmpty()) << page;
    for_matches(prose, R"(`(\w+\.(?:h|cpp|glsl|vert|frag))`)", [&](const std::string& name) {
      EXPECT_TRUE(path_ends().contains(name) || is_placeholder(name)) << page << ": " << name;
    });
  }
  for (const char* folder : {"tools", "docs/examples", "cmake"}) {
    for (const fs::path& script : files_under(checkout / folder)) {
      if (script.extension() == ".py" || script.extension() == ".sh" || script.extension() == ".cmake") {
        EXPECT_THAT(missing_paths(whole_text(script)), testing::IsEmpty()) << script;
      }
    }
  }
}

// docs/overview.md lists the folders that src/CMakeLists.txt makes, below all that they include.
TEST(Documents, ListFoldersBelowThoseThatTheyInclude) {
  std::map<std::string, size_t> place;
  for_matches(whole_text(checkout / "docs/overview.md"), R"(\n\| `(\w+)` \|)",
              [&](const std::string& folder) { place.emplace(folder, place.size()); });
  const std::string build = whole_text(checkout / "src/CMakeLists.txt");
  const std::regex call(R"(\nlightgrid_folder\((\w+)([^)]*)\))");
  size_t folders = 0;
  for (std::sregex_iterator i(build.begin(), build.end(), call); i != std::sregex_iterator();
       ++i, ++folders) {
    const std::string name = (*i)[1], rest = (*i)[2];
    ASSERT_TRUE(place.contains(name)) << name;
    for_matches(rest, R"((\w+))", [&](const std::string& used) {
      if (place.contains(used)) {
        EXPECT_LT(place[used], place[name]) << name << " uses " << used;
      }
    });
  }
  EXPECT_EQ(folders, place.size());
}

// A comment's subject comes first: "The stored values of ...", "Returns whether ...".
TEST(Comments, SeldomBeginWithAFragment) {
  std::vector<std::string> openings;
  for (const char* folder : {"src", "kernels", "shaders", "tests"}) {
    for (const fs::path& file : files_under(checkout / folder)) {
      std::ifstream lines(file);
      bool continued = false;
      for (std::string line; std::getline(lines, line);) {
        line.erase(0, line.find_first_not_of(' '));
        const bool comment = line.starts_with("// ");
        for (const char* word : {"// Of ", "// What ", "// Those ", "// Whether "})
          if (!continued && line.starts_with(word)) openings.push_back(file.string() + ": " + line);
        continued = comment;
      }
    }
  }
  EXPECT_LE(openings.size(), 60u) << testing::PrintToString(openings);
}

TEST(Documents, AreInTheContents) {
  std::set<fs::path> listed = {checkout / "docs/README.md"};
  for_matches(whole_text(checkout / "docs/README.md"), R"(\]\(([^)#\s]+))",
              [&](const std::string& link) { listed.insert((checkout / "docs" / link).lexically_normal()); });
  for (const fs::path& page : all_pages()) {
    if (page.string().find("/docs/examples/") == std::string::npos) {
      EXPECT_TRUE(listed.contains(page)) << page;
    }
  }
}

TEST(Documents, InTheLabTellDateMachineAndCommit) {
  for (const fs::path& note : files_under(checkout / "docs/lab")) {
    const std::string text = whole_text(note), first = text.substr(0, text.find('\n'));
    EXPECT_TRUE(first.starts_with("# " + note.filename().string().substr(0, 10) + ", ")) << note;
    EXPECT_TRUE(std::regex_search(first, std::regex(R"(: .+; commit .+)"))) << note;
  }
}

}  // namespace
}  // namespace lightgrid::app
