// A text file, plain or gzipped, as one buffer.
#pragma once

#include <string>

#include "helicoid/base/result.hpp"

namespace helicoid {

struct TextFile {
  std::string name;     ///< as given; "stdin" for "-"
  std::string text;     ///< inflated if it was gzipped
  std::string warning;  ///< of a damaged archive of which only a part could be read; empty if all is well
};

/// Reads a file ("-" is standard input) and inflates it if its first bytes say gzip, whatever its name. A truncated or
/// damaged archive gives what could be inflated and a warning. Errors: a directory, no such file, no permission.
[[nodiscard]] Result<TextFile> read_text_file(const std::string& path);

/// The same of bytes that were read elsewhere; `name` is what messages call them.
[[nodiscard]] TextFile text_of_bytes(std::string bytes, const std::string& name);

/// True if the bytes cannot be a text: a zero byte among the first thousand.
[[nodiscard]] bool looks_binary(const std::string& text);

}  // namespace helicoid
