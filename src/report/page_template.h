// A page of one file: a template whose {{name}} are replaced, with data and pictures inside.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace lightgrid {

std::string base64(const std::vector<uint8_t>& bytes);

// Safe inside <script>: contains no "<", so no "</script>" either. JSON in, JSON of the same value out.
std::string script_json(const std::string& text);

// Replaces each {{name}} of the template, in order; inserted text is not scanned again.
std::string filled(std::string_view page, const std::map<std::string_view, std::string>& values);

}  // namespace lightgrid
