#include "helicoid/io/gzip_file.hpp"

#include <libdeflate.h>

#include <memory>

#include "helicoid/base/whole_file.hpp"

namespace helicoid {

Result<void> write_gzip_file(const std::string& path, std::string_view text) {
  constexpr int kLevel = 6;
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor);
  if (!compressor) return fail("{}: no memory to compress it", path);
  std::string bytes(libdeflate_gzip_compress_bound(compressor.get(), text.size()), '\0');
  bytes.resize(libdeflate_gzip_compress(compressor.get(), text.data(), text.size(), bytes.data(), bytes.size()));
  return write_whole_file(path, bytes);
}

}  // namespace helicoid
