// Replays a fuzz target's corpus, so that what was once found stays mended in every build.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

std::vector<std::filesystem::path> corpus() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(HELICOID_CORPUS)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::uint8_t> bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Corpus, IsReadWithoutHarm) {
  const std::vector<std::filesystem::path> files = corpus();
  ASSERT_FALSE(files.empty());
  for (const auto& path : files) {
    SCOPED_TRACE(path);
    const std::vector<std::uint8_t> bytes = bytes_of(path);
    EXPECT_EQ(LLVMFuzzerTestOneInput(bytes.data(), bytes.size()), 0);
  }
}

TEST(Corpus, IsReadWithoutHarmWhenItIsCutOffAnywhere) {
  constexpr std::size_t kCuts = 40;
  for (const auto& path : corpus()) {
    SCOPED_TRACE(path);
    const std::vector<std::uint8_t> whole = bytes_of(path);
    for (std::size_t i = 0; i < kCuts; ++i) {
      // A buffer of just the size that is left: a sanitizer sees a read past its end.
      const std::vector<std::uint8_t> part(whole.begin(),
                                           whole.begin() + static_cast<std::ptrdiff_t>(i * whole.size() / kCuts));
      EXPECT_EQ(LLVMFuzzerTestOneInput(part.data(), part.size()), 0);
    }
  }
}

TEST(Corpus, IsReadWithoutHarmWhenAByteIsWrong) {
  constexpr std::size_t kPlaces = 60;
  for (const auto& path : corpus()) {
    SCOPED_TRACE(path);
    const std::vector<std::uint8_t> whole = bytes_of(path);
    for (std::size_t i = 0; i < std::min(kPlaces, whole.size()); ++i) {
      std::vector<std::uint8_t> wrong = whole;
      wrong[i * whole.size() / kPlaces % whole.size()] ^= static_cast<std::uint8_t>(1U << (i % 8));
      EXPECT_EQ(LLVMFuzzerTestOneInput(wrong.data(), wrong.size()), 0);
    }
  }
}

}  // namespace
