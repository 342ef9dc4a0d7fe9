// Writing a file that nobody ever sees half of.
#pragma once

#include <string>
#include <string_view>

#include "helicoid/base/result.hpp"

namespace helicoid {

/// Writes the bytes beside `path` and renames. Errors: the place cannot be written, the disc is full.
[[nodiscard]] Result<void> write_whole_file(const std::string& path, std::string_view bytes);

}  // namespace helicoid
