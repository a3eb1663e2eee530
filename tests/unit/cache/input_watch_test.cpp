#include "base/input_watch.h"

#include "base/files.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace glint::base {
namespace {

namespace fs = std::filesystem;

class InputWatching : public testing::Test {
protected:
    std::string path(const char* name) const {
        return (folder_.path() / name).string();
    }
    // Writes in place, as an editor that does not rename does.
    static void write(const std::string& path, std::string_view text) {
        std::ofstream(path, std::ios::binary) << text;
    }
    // Asks as often as a watch does until something has changed. A file system's clock ticks within the time.
    std::vector<std::string> waitForChange() {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
        std::vector<std::string> changed;
        while (changed.empty() && std::chrono::steady_clock::now() < end) {
            changed = watch_.changed();
        }
        return changed;
    }

    // So much patience that no machine is too slow for a test.
    InputWatch watch_{60'000};

private:
    test::TemporaryFolder folder_;
};

TEST_F(InputWatching, AnEditWithinOneTickOfTheFileSystemsClockIsSeen) {
    const std::string file = path("a.glsl");
    write(file, "one");
    watch_.watch(std::vector<InputFile>{{file, std::nullopt}});
    // The second edit gets the time of the first, which has the same size and place.
    const fs::file_time_type time = fs::last_write_time(file);
    write(file, "two");
    fs::last_write_time(file, time);
    EXPECT_EQ(waitForChange(), std::vector<std::string>{file});
}

TEST_F(InputWatching, WaitingEndsWithTheNextChange) {
    const std::string file = path("a.glsl");
    write(file, "one");
    InputWatch watch(InputWatch::kMissingMs, 0);
    watch.watch(std::vector<InputFile>{{file, std::nullopt}});
    using std::chrono::milliseconds;
    // Each second it is time to look, and a slow machine may take as long for a call.
    int waits = 0;
    while (watch.wait(milliseconds(1)) && waits < 100) {
        ++waits;
    }
    EXPECT_LT(waits, 100) << "it looks although nothing happens";
    write(file, "two");
    const auto start = std::chrono::steady_clock::now();
    EXPECT_TRUE(watch.wait(std::chrono::minutes(1)));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
    EXPECT_EQ(watch.changed(), std::vector<std::string>{file});
}

TEST_F(InputWatching, AFileThatChangedSinceItWasReadHasChanged) {
    const std::string file = path("a.glsl");
    write(file, "as it was read");
    const std::optional<std::uint64_t> hash = hashBytes("as it was read");
    write(file, "as it is now");
    watch_.watch(std::vector<InputFile>{{file, hash}});
    EXPECT_EQ(waitForChange(), std::vector<std::string>{file});
}

TEST_F(InputWatching, AFolderChangesWithItsFiles) {
    const std::string file = path("a.glsl");
    const std::string folder = path(".");
    write(file, "one");
    watch_.watch(std::vector<InputFile>{{folder, std::nullopt}});
    EXPECT_TRUE(watch_.changed().empty());
    write(file, "another size");
    fs::rename(file, path("b.glsl"));
    EXPECT_EQ(waitForChange(), std::vector<std::string>{folder});
}

TEST_F(InputWatching, AFileThatWasOnlyTouchedHasNotChanged) {
    const std::string touched = path("touched.glsl");
    const std::string edited = path("edited.glsl");
    write(touched, "one");
    write(edited, "one");
    watch_.watch(std::vector<InputFile>{{touched, std::nullopt}, {edited, hashBytes("one")}});
    fs::last_write_time(touched, fs::last_write_time(touched) - std::chrono::hours(1));
    write(edited, "another size");
    EXPECT_EQ(waitForChange(), std::vector<std::string>{edited});
}

TEST_F(InputWatching, AFileThatIsMissingForAMomentHasOnlyItsNewContents) {
    const std::string same = path("same.glsl");
    const std::string other = path("other.glsl");
    write(same, "one");
    write(other, "one");
    watch_.watch(std::vector<InputFile>{{same, std::nullopt}, {other, std::nullopt}});
    fs::remove(same);
    fs::remove(other);
    std::thread editor([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(InputWatch::kRestMs * 3));
        write(path("next"), "one");
        fs::rename(path("next"), same);
        write(path("next"), "two");
        fs::rename(path("next"), other);
    });
    EXPECT_EQ(waitForChange(), std::vector<std::string>{other});
    editor.join();
}

}  // namespace
}  // namespace glint::base
