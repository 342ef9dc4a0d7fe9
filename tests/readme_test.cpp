// The documents agree with the project they describe.
#include <gmock/gmock.h>

#include <filesystem>
#include <regex>
#include <set>

#include "tests/source_tree.hpp"

namespace helicoid::source_tree {

namespace {

struct Block {
  std::string language;
  std::string text;
};

/// The fenced blocks of a page.
std::vector<Block> blocks_of(const std::string& page) {
  static const std::regex kBlock("(?:^|\n)```([a-z]*)\n([^`]*)```");
  std::vector<Block> blocks;
  for (std::sregex_iterator it(page.begin(), page.end(), kBlock), end; it != end; ++it) {
    blocks.push_back({(*it)[1], (*it)[2]});
  }
  return blocks;
}

std::vector<std::string> captures(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it) found.push_back((*it)[1]);
  return found;
}

}  // namespace

// .ci/readme_commands runs what stands in sh blocks: a command anywhere else would be one that nobody runs.
TEST(Readme, ShowsCommandsOnlyWhereTheyAreRun) {
  bool has_commands = false;
  for (const Block& block : blocks_of(text_of("README.md"))) {
    EXPECT_THAT(block.language, testing::AnyOf("sh", "cpp")) << block.text;
    if (block.language == "sh") has_commands = true;
  }
  EXPECT_TRUE(has_commands);
  EXPECT_THAT(captures(text_of("README.md"), "\n(    [^ \n].*)"), testing::IsEmpty()) << "an indented block is not run";
}

TEST(Readme, ShowsCodeThatIsBuilt) {
  std::string examples;
  for (const std::string& path : files_below("examples", {".cpp"})) examples += text_of(path);
  for (const Block& block : blocks_of(text_of("README.md"))) {
    if (block.language == "cpp") {
      EXPECT_THAT(examples, testing::HasSubstr(block.text));
    }
  }
}

TEST(Documents, LinkOnlyToWhatIsThere) {
  for (const std::string page : {"README.md", "ARCHITECTURE.md", "docs/frames.md", "docs/formats.md"}) {
    const std::filesystem::path folder = (std::filesystem::path(HELICOID_SOURCE_DIR) / page).parent_path();
    for (const std::string& link : captures(text_of(page), R"(\]\(([^)#]+)\))")) {
      EXPECT_TRUE(std::filesystem::exists(folder / link)) << page << " links to " << link;
    }
  }
}

TEST(Documents, ArchitectureNamesTheRoomsInTheirOrder) {
  const std::string section = section_of(text_of("ARCHITECTURE.md"), "The rooms");
  std::vector<std::string> declared;
  for (const Room& room : declared_rooms()) declared.push_back(room.name);
  EXPECT_EQ(captures(section, "\n\\| `([a-z]+)` \\|"), declared);
  for (const std::string& row : captures(section, "\n\\| (`[a-z]+` \\|.*`[a-z_0-9]+\\.hpp`) \\|")) {
    const std::string room = row.substr(1, row.find('`', 1) - 1);
    const std::size_t last = row.rfind('`', row.size() - 2);
    const std::string header = row.substr(last + 1, row.size() - last - 2);
    EXPECT_FALSE(text_of("helicoid/" + room + "/" + header).empty()) << room << "/" << header;
  }
}

}  // namespace helicoid::source_tree
