#include "emit/package/compiled_package.h"
#include "emit/package/manifest.h"
#include "support/must.h"
#include "unit/emit/sample_scene.h"
#include "unit/emit/text_package.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace glint {
namespace {

using namespace glint::testing;
namespace fs = std::filesystem;

class WritePackage : public ::testing::Test {
protected:
    const compiler::CompiledPackage first_ =
        makePackage({{"tables.bin", "one"}, {"same.spv", "same"}, {"old.spv", "x"}, {"glsl/a.comp", "a"}});
    const compiler::CompiledPackage second_ =
        makePackage({{"tables.bin", "two"}, {"same.spv", "same"}, {"new.spv", "y"}});
    TemporaryFolder temporary_;
    const fs::path folder_ = temporary_.path() / "deep" / "out";
};

TEST_F(WritePackage, MakesTheFolderAndReplacesIt) {
    Status status = writePackage(first_, folder_);
    ASSERT_TRUE(status) << toString(status.error());
    auto contents = readFolder(folder_);
    EXPECT_EQ(contents.size(), 5U);
    EXPECT_EQ(contents["glsl/a.comp"], "a");

    status = writePackage(second_, folder_);
    ASSERT_TRUE(status) << toString(status.error());
    contents = readFolder(folder_);
    EXPECT_EQ(contents.size(), 4U);
    EXPECT_EQ(contents["tables.bin"], "two");
    EXPECT_EQ(contents["new.spv"], "y");
    EXPECT_FALSE(fs::exists(folder_ / "glsl"));
    // No staging folder remains.
    EXPECT_EQ(countEntries(folder_.parent_path()), 1U);
}

TEST_F(WritePackage, KeepsTheTimesOfUnchangedFiles) {
    ASSERT_TRUE(writePackage(first_, folder_));
    const auto past = fs::file_time_type::clock::now() - std::chrono::hours(1);
    for (const char* const name : {"same.spv", "tables.bin"}) {
        fs::last_write_time(folder_ / name, past);
    }
    ASSERT_TRUE(writePackage(first_, folder_));
    EXPECT_EQ(fs::last_write_time(folder_ / "tables.bin"), past);
    ASSERT_TRUE(writePackage(second_, folder_));
    EXPECT_EQ(fs::last_write_time(folder_ / "same.spv"), past);
    EXPECT_GT(fs::last_write_time(folder_ / "tables.bin"), past);
}

TEST_F(WritePackage, RemovesAFileThatIsNoLongerPartOfIt) {
    ASSERT_TRUE(writePackage(makePackage({{"tables.bin", "t"}, {"b.spv", "b"}}), folder_));
    ASSERT_TRUE(writePackage(makePackage({{"tables.bin", "t"}}), folder_));
    EXPECT_FALSE(fs::exists(folder_ / "b.spv"));
}

TEST_F(WritePackage, KeepsWhatUsersPutBesideIt) {
    ASSERT_TRUE(writePackage(first_, folder_));
    fs::create_directories(folder_ / "notes/empty");
    std::ofstream(folder_ / "notes/mine.txt") << "mine";
    std::ofstream(folder_ / "build.d") << "depends";
    fs::create_symlink("build.d", folder_ / "link.d");
    must(writePackage(second_, folder_));
    const auto contents = readFolder(folder_);
    EXPECT_EQ(contents.at("notes/mine.txt"), "mine");
    EXPECT_EQ(contents.at("build.d"), "depends");
    EXPECT_TRUE(fs::is_directory(folder_ / "notes/empty"));
    EXPECT_TRUE(fs::is_symlink(folder_ / "link.d"));
    EXPECT_FALSE(contents.contains("old.spv"));
}

TEST_F(WritePackage, RefusesAFolderThatHoldsSomethingElse) {
    fs::create_directories(folder_);
    ASSERT_TRUE(writePackage(first_, folder_)) << "an empty folder is fine";
    const fs::path other = temporary_.path() / "other";
    fs::create_directories(other);
    std::ofstream(other / "manifest.json") << "{\"name\": \"a web page\"}";
    std::ofstream(other / "tables.bin") << "not ours";
    EXPECT_EQ(mustFail(writePackage(second_, other)).id, "output-not-a-package");
    EXPECT_EQ(readFolder(other).size(), 2U);
}

TEST_F(WritePackage, ReplacesAPackageWhoseManifestIsLost) {
    const fs::path damaged = temporary_.path() / "damaged";
    fs::create_directories(damaged);
    std::ofstream(damaged / "tables.bin") << "GLINTPKG and more";
    std::ofstream(damaged / "manifest.json") << "{ cut";
    must(writePackage(second_, damaged));
    EXPECT_EQ(readFolder(damaged).at("tables.bin"), "two");
}

TEST_F(WritePackage, RefusesPlacesThatCannotBeWritten) {
    std::ofstream(temporary_.path() / "file") << "a file";
    EXPECT_EQ(mustFail(writePackage(first_, temporary_.path() / "file")).id, "output-not-a-folder");
    EXPECT_EQ(mustFail(writePackage(first_, temporary_.path() / "file" / "out")).id, "output-write");
    EXPECT_EQ(mustFail(writePackage(first_, "/proc/glint-out")).id, "output-write");
    EXPECT_FALSE(writePackage(first_, ""));
    EXPECT_FALSE(writePackage(first_, "/"));
}

// A foreign file is where a file of the new package must go. Staging fails half-way, and the old package
// stays.
TEST_F(WritePackage, LeavesTheEarlierPackageWholeWhenItFails) {
    ASSERT_TRUE(writePackage(first_, folder_));
    fs::create_directories(folder_ / "new.spv");
    std::ofstream(folder_ / "new.spv" / "foreign") << "f";
    const auto before = readFolder(folder_);
    const Diagnostic status = mustFail(writePackage(second_, folder_));
    EXPECT_EQ(status.id, "output-write");
    EXPECT_FALSE(status.hint.empty());
    EXPECT_EQ(readFolder(folder_), before);
    EXPECT_EQ(countEntries(folder_.parent_path()), 1U);
}

TEST_F(WritePackage, LeavesTheEarlierPackageWholeWhenANameCannotBeWritten) {
    ASSERT_TRUE(writePackage(first_, folder_));
    const auto before = readFolder(folder_);
    const compiler::CompiledPackage tooLong =
        makePackage({{"tables.bin", "three"}, {std::string(300, 'n') + ".spv", "n"}});
    EXPECT_EQ(mustFail(writePackage(tooLong, folder_)).id, "output-write");
    EXPECT_EQ(readFolder(folder_), before);
    EXPECT_EQ(countEntries(folder_.parent_path()), 1U);
}

// Returns the number of a process that has ended.
int endedProcess() {
    const pid_t child = fork();
    if (child == 0) {
        _exit(0);
    }
    waitpid(child, nullptr, 0);
    return static_cast<int>(child);
}

TEST_F(WritePackage, CleansUpAfterRunsThatWereKilled) {
    ASSERT_TRUE(writePackage(first_, folder_));
    const fs::path parent = folder_.parent_path();
    const std::string dead = std::to_string(endedProcess());
    fs::create_directories(parent / (".out.glint-new-" + dead + "-0") / "half");
    fs::create_directories(parent / (".out.glint-new-" + std::to_string(getpid()) + "-7"));
    fs::create_directories(parent / ".out.glint-new-notes");
    // The run was killed between two renames: the earlier package is brought back, then replaced.
    fs::rename(folder_, parent / (".out.glint-old-" + dead + "-0"));
    std::ofstream(parent / (".out.glint-old-" + dead + "-0") / "mine.txt") << "mine";
    ASSERT_TRUE(writePackage(second_, folder_));
    EXPECT_EQ(readFolder(folder_).at("mine.txt"), "mine");
    EXPECT_EQ(readFolder(folder_).at("tables.bin"), "two");
    EXPECT_FALSE(fs::exists(parent / (".out.glint-new-" + dead + "-0")));
    EXPECT_FALSE(fs::exists(parent / (".out.glint-old-" + dead + "-0")));
    // These belong to a running process, or to nobody, so they must not be removed.
    EXPECT_TRUE(fs::exists(parent / (".out.glint-new-" + std::to_string(getpid()) + "-7")));
    EXPECT_TRUE(fs::exists(parent / ".out.glint-new-notes"));
}

TEST_F(WritePackage, FollowsALinkToTheFolder) {
    ASSERT_TRUE(writePackage(first_, folder_));
    const fs::path link = temporary_.path() / "link";
    fs::create_directory_symlink(folder_, link);
    ASSERT_TRUE(writePackage(second_, link / ""));
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(readFolder(folder_).at("tables.bin"), "two");
}

TEST_F(WritePackage, KeepsThePermissionsOfTheFolder) {
    ASSERT_TRUE(writePackage(first_, folder_));
    fs::permissions(folder_, fs::perms::owner_all | fs::perms::group_read);
    ASSERT_TRUE(writePackage(second_, folder_));
    EXPECT_EQ(fs::status(folder_).permissions(), fs::perms::owner_all | fs::perms::group_read);
}

TEST(WriteCompiled, WritesWhatWasCompiled) {
    const TemporaryFolder temporary;
    compiler::CompileSettings settings;
    settings.emitGlsl = true;
    const compiler::CompiledPackage package = compileSample(settings);
    must(writePackage(package, temporary.path() / "out"));
    const auto contents = readFolder(temporary.path() / "out");
    EXPECT_EQ(contents.size(), package.files.size());
    for (const compiler::PackageFile& file : package.files) {
        EXPECT_EQ(contents.at(file.name), textOf(&file));
    }
    EXPECT_EQ(compiler::manifestFiles(contents.at("manifest.json")).size(), package.files.size());
}

}  // namespace
}  // namespace glint
