// SPDX-License-Identifier: BSD-3-Clause
#include "files/read_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <thread>

#include <sys/stat.h>

#include "support/scratch_file.hpp"
#include "support/test.hpp"

namespace ergotic::files {
namespace {

constexpr std::size_t kMax = 100;
const char kNoFile[] = "it is a pipe, a device or a socket, allowed: files";

/// After `path: cannot be read: `.
std::string reasonAgainst(const std::string& path, std::size_t most = kMax) {
  const std::string complaint = complaintOf<Exception>([&] { readFile(path, most); });
  const std::string title = ": cannot be read: ";
  const std::size_t found = complaint.find(title);
  return found == std::string::npos ? complaint : complaint.substr(found + title.size());
}

TEST(ReadFileTest, GivesEveryByte) {
  const std::string text("a\r\n\0\xFFz", 6);
  const test::ScratchFile file(text);
  EXPECT_EQ(readFile(file.path(), 6), text);
  EXPECT_EQ(reasonAgainst(file.path(), 5), "it has 6 bytes, allowed: at most 5");
}

TEST(ReadFileTest, RefusesWhatIsNoRegularFile) {
  EXPECT_EQ(reasonAgainst("/dev/zero"), kNoFile);
  EXPECT_EQ(reasonAgainst("/tmp"), "Is a directory");
  EXPECT_EQ(reasonAgainst(test::ScratchFile().path() + ".none"), "No such file or directory");
  EXPECT_EQ(reasonAgainst(std::string("/tmp\0b", 6)), "No such file or directory");
}

TEST(ReadFileTest, ShowsANameThatWouldEndTheMessage) {
  EXPECT_EQ(complaintOf([] { readFile(std::string("\0", 1), kMax); }),
            "\\x00: cannot be read: No such file or directory");
}

TEST(ReadFileTest, WaitsForNobodyWhoWritesAPipe) {
  const test::ScratchFile place;
  const std::string pipe = place.path() + ".pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), S_IRUSR | S_IWUSR), 0);
  EXPECT_EQ(reasonAgainst(pipe), kNoFile);
  std::remove(pipe.c_str());
}

TEST(ReadFileTest, ReadsOrRefusesWhatAnotherExchangesMeanwhile) {
  const test::ScratchFile file("text");
  const std::string pipe = file.path() + ".pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), S_IRUSR | S_IWUSR), 0);
  std::atomic<bool> ends{false};
  std::thread other([&] {
    while (!ends) {
      renameat2(AT_FDCWD, file.path().c_str(), AT_FDCWD, pipe.c_str(), RENAME_EXCHANGE);
    }
  });
  int read = 0;
  int refused = 0;
  for (int i = 0; i < 1'000'000 && (i < 2000 || read == 0 || refused == 0); ++i) {
    const std::string reason = reasonAgainst(file.path());
    EXPECT_TRUE(reason.empty() || reason == kNoFile) << reason;
    (reason.empty() ? read : refused) += 1;
  }
  ends = true;
  other.join();
  EXPECT_GT(read, 0);
  EXPECT_GT(refused, 0);
  std::remove(pipe.c_str());
}

TEST(ReadFileTest, RefusesWhatTheKernelMakesUp) {
  for (const char* const path : {"/proc/self/maps", "/proc/self/environ", "/proc/version"}) {
    EXPECT_THAT(reasonAgainst(path), HasSubstr("allowed: files of a disk")) << path;
  }
}

TEST(ReadFileTest, EndsWhereAFileThatTellsNoSizeGoesOn) {
  for (const char* const path : {"/sys/fs/cgroup/cpu.stat", "/sys/fs/cgroup/memory/memory.stat"}) {
    if (std::ifstream(path)) {
      EXPECT_THAT(reasonAgainst(path), HasSubstr("does not end within 100 bytes"));
      return;
    }
  }
  GTEST_SKIP() << "no group of processes tells of itself here";
}

TEST(IsBelowTest, FollowsLinksAndStepsUp) {
  const std::string folder = test::ScratchFile().path() + ".folder";  // the file is gone
  ASSERT_EQ(mkdir(folder.c_str(), S_IRWXU), 0);
  ASSERT_EQ(symlink("/etc", (folder + "/out").c_str()), 0);
  EXPECT_TRUE(isBelow(folder + "/none.csv", folder + "/."));
  EXPECT_TRUE(isBelow(folder + "/x/../none.csv", folder));
  EXPECT_FALSE(isBelow(folder + "/../none.csv", folder));
  EXPECT_FALSE(isBelow(folder + "/out/passwd", folder));
  EXPECT_FALSE(isBelow("/etc/passwd", folder));
  std::remove((folder + "/out").c_str());
  std::remove(folder.c_str());
}

}  // namespace
}  // namespace ergotic::files
