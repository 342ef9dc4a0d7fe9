// Writing a gzipped text.
#pragma once

#include <string>
#include <string_view>

#include "helicoid/base/result.hpp"

namespace helicoid {

/// Writes the text as one gzip member without a name or a date, so that the same text gives the same bytes; whole or
/// not at all. Errors: the place cannot be written.
[[nodiscard]] Result<void> write_gzip_file(const std::string& path, std::string_view text);

}  // namespace helicoid
