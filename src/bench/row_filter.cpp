#include "bench/row_filter.h"

#include "base/error.h"

namespace lightgrid {
namespace {

constexpr size_t max_length = 200;

// libstdc++'s default matcher takes exponential time on some expressions; its other one does not, and only
// lacks back-references.
constexpr auto syntax = std::regex::ECMAScript
#ifdef __GLIBCXX__
                        | std::regex_constants::__polynomial
#endif
    ;

}  // namespace

RowFilter::RowFilter(const std::string& expression) : all_(expression.empty()) {
  if (expression.size() > max_length) throw input_error("filter: longer than {} characters", max_length);
  try {
    expression_ = std::regex(expression, syntax);
  } catch (const std::regex_error& error) {
    throw input_error("filter {}: not a regular expression: {}", expression, error.what());
  }
}

bool RowFilter::keeps(const std::string& case_name, const std::string& row_name) const {
  return all_ || std::regex_search(case_name + "/" + row_name, expression_);
}

}  // namespace lightgrid
