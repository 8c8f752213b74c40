// A page of one file: a template whose {{name}} are replaced, with data and pictures inside.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "base/text.h"

namespace lightgrid {

// Safe inside <script>: contains no "<", so no "</script>" either. JSON in, JSON of the same value out.
std::string script_json(const std::string& text);

// Replaces each {{name}} of the template, in order; inserted text is not scanned again.
std::string filled(std::string_view page, const std::map<std::string_view, std::string>& values);

}  // namespace lightgrid
