#include "common/replacement.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "support/temporary_file.h"

namespace collarmesh::replacement_test {
namespace {

using testing::TemporaryFolder;

TEST(CommonReplacement, ReplacesAllFilesAndKeepsTheirModes) {
  const TemporaryFolder folder;
  folder.write("a", "old");
  ASSERT_EQ(chmod(folder.file("a").c_str(), 0640), 0);
  folder.write("new-a", "new");
  folder.write("new-b", "new");
  Replacement replacement({{folder.file("new-a"), folder.file("a"), folder.file("kept")},
                           {folder.file("new-b"), folder.file("b"), {}}});
  replacement.prepare();
  EXPECT_EQ(replacement.carry_out(), nullptr);
  replacement.settle();
  EXPECT_EQ(folder.read("a"), "new");
  EXPECT_EQ(folder.read("b"), "new");
  EXPECT_EQ(folder.read("kept"), "old");
  EXPECT_EQ(std::filesystem::status(folder.file("a")).permissions(), std::filesystem::perms(0640));
  EXPECT_TRUE(replacement.undo());  // nothing to undo
  EXPECT_EQ(folder.read("a"), "new");
}

TEST(CommonReplacement, RestoresAllFilesIfOneCannotBeReplaced) {
  const TemporaryFolder folder;
  folder.write("a", "old");
  folder.write("new-a", "new");
  folder.write("new-b", "new");
  std::filesystem::create_directory(folder.file("c"));  // stands in the way of a file
  Replacement replacement({{folder.file("new-a"), folder.file("a"), folder.file("kept")},
                           {folder.file("new-b"), folder.file("b"), {}},
                           {folder.file("new-b"), folder.file("c"), {}}});
  const Replacement::Move* const failed = replacement.carry_out();
  ASSERT_NE(failed, nullptr);
  EXPECT_EQ(failed->to, folder.file("c"));
  EXPECT_TRUE(replacement.undo());
  EXPECT_EQ(folder.read("a"), "old");
  EXPECT_FALSE(std::filesystem::exists(folder.file("b")));
}

}  // namespace
}  // namespace collarmesh::replacement_test
