// Whatever a file of an MRCLAM folder holds, each line becomes a row of finite numbers, is counted, or says nothing.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "helicoid/io/mrclam_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helicoid;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
  for (const std::size_t columns : {2U, 3U, 4U, 5U}) {
    const MrclamTable table = parse_mrclam(text, columns, "fuzz");
    std::size_t seen = table.rows.size();
    for (const Skipped& s : table.skipped) seen += s.count;
    if (seen > lines) std::abort();
    for (const MrclamRow& row : table.rows) {
      const bool finite = std::all_of(row.values.begin(), row.values.end(), [](double v) { return std::isfinite(v); });
      if (row.values.size() != columns || !finite || row.line == 0 || row.line > lines) std::abort();
    }
  }
  return 0;
}
