// The regular expression of `bench --filter`.
#pragma once

#include <memory>
#include <regex>
#include <string>

namespace lightgrid {

class RowFilter {
 public:
  // ECMAScript syntax; empty keeps all. Throws Error(input) if it is invalid or too long.
  explicit RowFilter(const std::string& expression);

  // True if it matches anywhere in "CASE/ROW".
  bool keeps(const std::string& case_name, const std::string& row_name) const;

 private:
  bool all_ = true;
  std::regex expression_;
};

}  // namespace lightgrid
