#include "c_api/call.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "base/message_line.h"
#include "cl/error.h"
#include "run/scene_choice.h"

namespace lightgrid::app::c {
namespace {

struct LastError {
  std::string message, field;
};

LastError& last_error() {
  static thread_local LastError last;
  return last;
}

// The option or setting that a message begins with: "size 0x0: …", "set tile=7: …". Other messages begin with
// a file.
std::string named_first(const std::string& message) {
  static constexpr const char* others[] = {"scene",  "technique", "techniques", "gl",   "frames",
                                           "warmup", "reference", "compare",    "flip", "view"};
  const std::string word = message.substr(0, message.find_first_of(" :"));
  if (word == "set") {
    const size_t from = std::min(message.size(), word.size() + 1);
    return message.substr(from, message.find_first_of("=: ", from) - from);
  }
  const auto is_word = [&](const auto& name) { return name == word; };
  const bool known = std::ranges::any_of(others, is_word) ||
                     std::ranges::any_of(choice_fields(), is_word, &ChoiceField::name);
  return known ? word : "";
}

lightgrid_status record(lightgrid_status status, const std::string& message, const std::string& field) {
  last_error() = {message, field};
  return status;
}

lightgrid_status record(const Error& error) {
  const std::string message = message_line(error.what());
  return record(error.kind() == ErrorKind::input ? LIGHTGRID_INPUT : LIGHTGRID_MACHINE, message,
                error.field().empty() ? named_first(message) : error.field());
}

lightgrid_status status_of_current_exception() {
  try {
    throw;
  } catch (const Error& error) {
    return record(error);
  } catch (const cl::Error& error) {
    return record(cl_machine_error(error));
  } catch (const Cancelled&) {
    return record(LIGHTGRID_CANCELLED, "cancelled by the progress function", "progress");
  } catch (const std::bad_alloc&) {
    return record(LIGHTGRID_MACHINE, "out of memory", "");
  } catch (const std::exception& error) {
    return record(LIGHTGRID_MACHINE, error.what(), "");
  }
}

}  // namespace

std::vector<Warning>& last_warnings() {
  static thread_local std::vector<Warning> last;
  return last;
}

lightgrid_status failed() noexcept {
  try {
    return status_of_current_exception();
  } catch (...) {  // no memory for a message
    last_error().message.clear();
    last_error().field.clear();
    return LIGHTGRID_MACHINE;
  }
}

char* text_for_caller(const std::string& text) {
  char* const copy = static_cast<char*>(std::malloc(text.size() + 1));
  if (!copy) throw std::bad_alloc();
  std::memcpy(copy, text.c_str(), text.size() + 1);
  return copy;
}

std::vector<std::string> words_of(const char* const* words) {
  std::vector<std::string> all;
  for (; words && *words; ++words) all.emplace_back(*words);
  return all;
}

}  // namespace lightgrid::app::c

extern "C" {

const char* lightgrid_error_message(void) { return lightgrid::app::c::last_error().message.c_str(); }
const char* lightgrid_error_field(void) { return lightgrid::app::c::last_error().field.c_str(); }
void lightgrid_free(char* text) { std::free(text); }

}  // extern "C"
