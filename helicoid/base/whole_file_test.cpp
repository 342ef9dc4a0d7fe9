#include "helicoid/base/whole_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace helicoid {
namespace {

namespace fs = std::filesystem;

class WholeFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] static std::string content(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  fs::path folder_ = fs::temp_directory_path() /
                     ("helicoid_whole_file_" + std::to_string(testing::UnitTest::GetInstance()->random_seed()) +
                      testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(WholeFile, HoldsTheBytesAndLeavesNothingBeside) {
  const std::string bytes("a\0b\r\n", 5);
  ASSERT_TRUE(write_whole_file(path("x"), bytes));
  EXPECT_EQ(content(path("x")), bytes);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(WholeFile, ReplacesTheOldOne) {
  ASSERT_TRUE(write_whole_file(path("x"), "a long content"));
  ASSERT_TRUE(write_whole_file(path("x"), "short"));
  EXPECT_EQ(content(path("x")), "short");
}

TEST_F(WholeFile, SaysWhereItCannotWrite) {
  const Result<void> no_folder = write_whole_file(path("none/x"), "a");
  ASSERT_FALSE(no_folder);
  EXPECT_NE(no_folder.error().message.find("none/x"), std::string::npos);
  fs::create_directories(path("folder/inside"));
  const Result<void> a_folder = write_whole_file(path("folder"), "a");
  ASSERT_FALSE(a_folder);
  EXPECT_NE(a_folder.error().message.find("folder"), std::string::npos);
  EXPECT_FALSE(fs::exists(path("folder.part")));
}

}  // namespace
}  // namespace helicoid
