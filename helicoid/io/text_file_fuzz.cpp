// Whatever bytes come in, gzipped or not, some text or nothing comes out, and damage is said.
#include <cstdint>
#include <cstdlib>

#include "helicoid/io/text_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helicoid;
  const TextFile file = text_of_bytes(std::string(reinterpret_cast<const char*>(data), size), "fuzz");
  const bool gzip = size > 2 && data[0] == 0x1f && data[1] == 0x8b;
  if (!gzip && (file.text.size() != size || !file.warning.empty())) std::abort();
  (void)looks_binary(file.text);
  return 0;
}
