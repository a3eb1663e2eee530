// Tests writing into the working folder, hostile manifests, and several writers at once.
#include "emit/package/compiled_package.h"
#include "emit/package/manifest.h"
#include "support/must.h"
#include "unit/emit/sample_scene.h"
#include "unit/emit/text_package.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace glint {
namespace {

using namespace glint::testing;
namespace fs = std::filesystem;

ino_t inodeOf(const fs::path& path) {
    struct stat status {};
    EXPECT_EQ(stat(path.c_str(), &status), 0) << path;
    return status.st_ino;
}

// Works in the output folder, as after `cd package`.
class WriteInPlace : public ::testing::Test {
protected:
    void SetUp() override {
        fs::create_directories(folder_);
        fs::current_path(folder_);
    }
    void TearDown() override {
        fs::current_path(before_);
    }
    const compiler::CompiledPackage first_ =
        makePackage({{"tables.bin", "one"}, {"same.spv", "same"}, {"old.spv", "x"}, {"glsl/a.comp", "a"}});
    const compiler::CompiledPackage second_ =
        makePackage({{"tables.bin", "two"}, {"same.spv", "same"}, {"new/b.spv", "y"}});
    const fs::path before_ = fs::current_path();
    TemporaryFolder temporary_;
    const fs::path folder_ = temporary_.path() / "out";
};

TEST_F(WriteInPlace, KeepsTheFolderAndReplacesItsFiles) {
    const ino_t folder = inodeOf(folder_);
    Status status = writePackage(first_, ".");
    ASSERT_TRUE(status) << toString(status.error());
    EXPECT_EQ(readFolder(".").size(), 5U);
    const ino_t same = inodeOf("same.spv");
    std::ofstream("mine.txt") << "mine";

    status = writePackage(second_, ".");
    ASSERT_TRUE(status) << toString(status.error());
    EXPECT_EQ(inodeOf(folder_), folder);
    EXPECT_EQ(inodeOf("same.spv"), same);
    auto contents = readFolder(".");
    EXPECT_EQ(contents.size(), 5U);
    EXPECT_EQ(contents["tables.bin"], "two");
    EXPECT_EQ(contents["new/b.spv"], "y");
    EXPECT_EQ(contents["mine.txt"], "mine");
    EXPECT_FALSE(fs::exists("glsl"));
    EXPECT_EQ(countEntries("."), 5U);
    EXPECT_EQ(countEntries(".."), 1U);
}

TEST_F(WriteInPlace, AlsoFromAFolderBelow) {
    ASSERT_TRUE(writePackage(first_, "."));
    fs::create_directories("notes");
    fs::current_path("notes");
    const ino_t folder = inodeOf(folder_);
    ASSERT_TRUE(writePackage(second_, ".."));
    EXPECT_EQ(inodeOf(folder_), folder);
    EXPECT_EQ(readFolder("..").at("tables.bin"), "two");
}

TEST_F(WriteInPlace, LeavesTheEarlierPackageWholeWhenItFails) {
    ASSERT_TRUE(writePackage(first_, "."));
    fs::create_directories("new");
    std::ofstream("new/b.spv") << "of somebody else";
    const auto before = readFolder(".");
    const Diagnostic status = mustFail(writePackage(second_, "."));
    EXPECT_EQ(status.id, "output-write");
    EXPECT_NE(status.where.find("b.spv"), std::string::npos) << status.where;
    EXPECT_EQ(readFolder("."), before);
    EXPECT_EQ(countEntries("."), 6U);
}

TEST_F(WriteInPlace, FollowsNoLinkOutOfTheFolder) {
    ASSERT_TRUE(writePackage(first_, "."));
    const fs::path outside = temporary_.path() / "outside";
    fs::rename("glsl", outside);
    fs::create_directory_symlink(outside, "glsl");
    EXPECT_FALSE(writePackage(second_, "."));
    EXPECT_EQ(readFolder(outside).at("a.comp"), "a");
    EXPECT_EQ(readFolder(".").at("tables.bin"), "one");
}

// Files that a manifest lists are removed when the package is replaced, so it must not be able to name
// anything else.
TEST_F(WriteInPlace, ManifestCannotNameFilesElsewhere) {
    const fs::path precious = temporary_.path() / "precious";
    std::ofstream(precious) << "years of work";
    std::ofstream("manifest.json")
        << R"({"format":"glint-package","files":[{"file":"../precious"},{"file":")" + precious.string() +
               R"("},{"file":"a/../b"},{"file":""},{"file":7}]})";
    must(writePackage(second_, "."));
    EXPECT_TRUE(fs::exists(precious));
    EXPECT_EQ(compiler::manifestFiles(
                  R"({"format":"glint-package","files":[{"file":"../a"},{"file":"/b"},{"file":"c/d"}]})"),
              (std::set<std::string, std::less<>>{"c/d", "manifest.json", "tables.bin"}));
}

// Each file says which writer made it, so that a mixture is detected.
TEST(WritePackageTogether, LeavesThePackageOfOneOfThem) {
    const TemporaryFolder temporary;
    const fs::path folder = temporary.path() / "out";
    constexpr int kWriters = 4;
    constexpr int kRounds = 40;
    const auto packageOf = [](int writer) {
        const std::string text = "writer " + std::to_string(writer);
        return makePackage({{"tables.bin", text}, {"a.spv", text}, {"b.spv", text}, {"glsl/c.comp", text}});
    };
    std::vector<pid_t> writers;
    for (int writer = 0; writer < kWriters; ++writer) {
        const pid_t child = fork();
        if (child == 0) {
            int failures = 0;
            for (int round = 0; round < kRounds; ++round) {
                failures += writePackage(packageOf(writer), folder) ? 0 : 1;
            }
            _exit(failures == 0 ? 0 : 1);
        }
        writers.push_back(child);
    }
    for (const pid_t child : writers) {
        int status = 0;
        ASSERT_EQ(waitpid(child, &status, 0), child);
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    }
    auto contents = readFolder(folder);
    EXPECT_EQ(contents.size(), 5U);
    for (const char* name : {"a.spv", "b.spv", "glsl/c.comp"}) {
        EXPECT_EQ(contents[name], contents["tables.bin"]) << name;
    }
    EXPECT_EQ(countEntries(temporary.path()), 1U);
}

}  // namespace
}  // namespace glint
