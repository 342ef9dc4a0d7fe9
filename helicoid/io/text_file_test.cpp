#include "helicoid/io/text_file.hpp"

#include <gmock/gmock.h>
#include <libdeflate.h>

#include <filesystem>

namespace helicoid {
namespace {

using testing::HasSubstr;

std::string gzipped(const std::string& text) {
  libdeflate_compressor* compressor = libdeflate_alloc_compressor(6);
  std::string bytes(libdeflate_gzip_compress_bound(compressor, text.size()), '\0');
  bytes.resize(libdeflate_gzip_compress(compressor, text.data(), text.size(), bytes.data(), bytes.size()));
  libdeflate_free_compressor(compressor);
  return bytes;
}

std::string long_text() {
  std::string text;
  for (int i = 0; i < 20000; ++i) text += fmt::format("ODOM {} 0 0\n", i * 7919 % 104729);
  return text;
}

TEST(TextFile, IsTheSamePlainAndGzipped) {
  EXPECT_EQ(text_of_bytes(long_text(), "a").text, long_text());
  const TextFile file = text_of_bytes(gzipped(long_text()), "a");
  EXPECT_EQ(file.text, long_text());
  EXPECT_EQ(file.warning, "");
  EXPECT_EQ(text_of_bytes(gzipped(""), "a").text, "");
}

TEST(TextFile, SeveralArchivesInARowAreOneText) {
  EXPECT_EQ(text_of_bytes(gzipped("one\n") + gzipped("two\n"), "a").text, "one\ntwo\n");
}

TEST(TextFile, ACutOffArchiveGivesWhatIsThereAndSaysSo) {
  const std::string whole = gzipped(long_text());
  const TextFile file = text_of_bytes(whole.substr(0, whole.size() / 2), "a.gz");
  EXPECT_FALSE(file.text.empty());
  EXPECT_EQ(file.text, long_text().substr(0, file.text.size()));
  EXPECT_THAT(file.warning, HasSubstr("a.gz: the archive is cut off"));
}

TEST(TextFile, ADamagedArchiveSaysSo) {
  std::string bytes = gzipped(long_text());
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
  EXPECT_THAT(text_of_bytes(bytes, "a.gz").warning, HasSubstr("a.gz: the archive is"));
}

TEST(TextFile, ADirectoryAndAMissingFileAreErrors) {
  const auto folder = std::filesystem::temp_directory_path().string();
  ASSERT_FALSE(read_text_file(folder));
  EXPECT_THAT(read_text_file(folder).error().message, HasSubstr("is a directory"));
  EXPECT_THAT(read_text_file(folder + "/no such file").error().message, HasSubstr("no such file"));
}

TEST(TextFile, AZeroByteMakesItBinary) {
  EXPECT_TRUE(looks_binary(std::string("a\0b", 3)));
  EXPECT_FALSE(looks_binary("FLASER"));
  EXPECT_FALSE(looks_binary(""));
}

}  // namespace
}  // namespace helicoid
