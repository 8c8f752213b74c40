// Messages of a bounded length.
#pragma once

#include <string>

namespace lightgrid {

// One line for a person: control characters become spaces, and whatever is quoted or has no space in it keeps
// only its ends past 240 bytes, the line past 2,000. Files and arguments may hold megabytes and terminal
// escapes.
std::string message_line(std::string text);

}  // namespace lightgrid
