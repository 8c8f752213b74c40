// A rough reader of C++, OpenCL C and GLSL: enough to find statements that a comma joins.
#pragma once

#include <cctype>
#include <regex>
#include <string>
#include <vector>

namespace lightgrid {

// The text without comments and preprocessor lines; strings and characters are empty.
inline std::string code_without_comments(const std::string& text) {
  static const std::regex ignored(
      R"re(//[^\n]*|/\*[^]*?\*/|R"(\w*)\([^]*?\)\1"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])'|(?:^|\n)[ ]*#(?:[^\n]*\\\n)*[^\n]*)re");
  std::string code;
  auto at = text.cbegin();
  for (std::sregex_iterator i(text.begin(), text.end(), ignored), end; i != end; ++i) {
    code.append(at, (*i)[0].first);
    const char first = *(*i)[0].first;
    if (first != '/') code += first == '\n' || first == '#' || first == ' ' ? "\n" : "0";
    at = (*i)[0].second;
  }
  return code.append(at, text.cend());
}

// Returns whether `statement`, whose brackets are empty, is no declaration and has parts joined by commas.
inline bool is_joined(std::string statement) {
  static const std::regex arguments(R"((\w)<[^<>]*>)");
  static const std::regex head(
      R"(^\s*(?:else|do|(?:if|for|while|switch)(?: constexpr)? ?\(\)|case [^:]*:|default:|[A-Z_]{3,}\(\)(?=\s*\w))\s*)");
  static const std::regex returned(R"(^\s*(?:return|throw|delete)\b)");
  static const std::regex other(
      R"(^\s*(?:using|template|class|struct|enum|union|friend|typedef|static_assert|operator)\b)");
  static const std::regex declared(R"(^\s*[\w:]+\s*(?:const\b)?[\s*&]+\w)");
  for (std::string before; before != statement;) {
    before = statement;
    statement = std::regex_replace(std::regex_replace(statement, arguments, "$1"), head, "");
  }
  if (statement.find(',') == std::string::npos || std::regex_search(statement, other)) return false;
  return std::regex_search(statement, returned) || !std::regex_search(statement, declared);
}

inline std::vector<std::string> joined_statements(const std::string& text) {
  struct Level {
    char bracket;
    std::string statement;
  };
  std::vector<Level> levels(1, {'{', ""});
  std::vector<std::string> joined;
  const std::string code = code_without_comments(text);
  for (size_t i = 0; i < code.size(); ++i) {
    const char c = code[i];
    if (c == '(' || c == '[' || c == '{') {
      levels.back().statement += c;
      levels.push_back({c, ""});
    } else if ((c == ')' || c == ']' || c == '}') && levels.size() > 1) {
      levels.pop_back();
      levels.back().statement += c;
      // A block ends its statement; a lambda or an initialiser does not.
      const size_t next = code.find_first_not_of(" \n", i + 1);
      if (c == '}' && (next == std::string::npos || std::isalnum(uint8_t(code[next])) || code[next] == '}' ||
                       code[next] == '_' || code[next] == '~' || code[next] == '*' || code[next] == '+'))
        levels.back().statement.clear();
    } else if (c == ';') {
      if (levels.back().bracket == '{' && is_joined(levels.back().statement))
        joined.push_back(levels.back().statement);
      levels.back().statement.clear();
    } else {
      levels.back().statement += c;
    }
  }
  return joined;
}

}  // namespace lightgrid
