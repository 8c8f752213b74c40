#include "base/embedded.h"

#include <cstdio>
#include <cstdlib>
#include <set>
#include <sstream>

namespace lightgrid {
namespace {

void append(std::string_view path, std::set<std::string, std::less<>>& seen, std::string& text) {
  if (!seen.insert(std::string(path)).second) return;
  std::istringstream lines(embedded_file(path));
  for (std::string line; std::getline(lines, line);) {
    constexpr std::string_view directive = "#include \"";
    if (line.starts_with(directive)) {
      append(std::string_view(line).substr(directive.size(), line.rfind('"') - directive.size()), seen, text);
    } else if (line != "#pragma once") {
      text += line;
      text += '\n';
    }
  }
}

}  // namespace

const std::string& embedded_file(std::string_view path) {
  const auto found = embedded_files().find(path);
  if (found == embedded_files().end()) {
    std::fprintf(stderr, "no embedded file \"%.*s\"\n", int(path.size()), path.data());
    std::abort();
  }
  return found->second;
}

std::string with_includes(std::string_view path) {
  std::set<std::string, std::less<>> seen;
  std::string text;
  append(path, seen, text);
  return text;
}

}  // namespace lightgrid
