#include "cache/store.h"

#include "base/files.h"
#include "support/must.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace glint {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> entriesOf(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& file : fs::recursive_directory_iterator(folder / "v1")) {
        if (file.is_regular_file()) {
            files.push_back(file.path());
        }
    }
    return files;
}

class Store : public ::testing::Test {
protected:
    compiler::StoreOptions options() const {
        return {folder_.path() / "cache", 1ULL << 20, {}};
    }
    fs::path folder() const {
        return folder_.path() / "cache";
    }

private:
    test::TemporaryFolder folder_;
};

TEST_F(Store, GivesBackWhatWasPut) {
    compiler::CacheStore store(options());
    EXPECT_FALSE(store.find("module", "key"));
    store.put("module", "key", std::string("a\0b", 3));
    store.put("module", "", "");
    EXPECT_EQ(store.find("module", "key"), std::string("a\0b", 3));
    EXPECT_EQ(store.find("module", ""), "");
    EXPECT_FALSE(store.find("module", "key2"));
    EXPECT_FALSE(store.find("action", "key"));
    EXPECT_EQ(compiler::CacheStore(options()).find("module", "key"), std::string("a\0b", 3));
    EXPECT_FALSE(store.trouble());
}

TEST_F(Store, ComparesTheWholeKey) {
    compiler::StoreOptions colliding = options();
    colliding.hash = [](std::string_view) { return std::uint64_t{7}; };
    compiler::CacheStore store(colliding);
    store.put("module", "first", "1");
    EXPECT_FALSE(store.find("module", "other"));
    store.put("module", "other", "2");
    EXPECT_EQ(store.find("module", "other"), "2");
    EXPECT_FALSE(store.find("module", "first"));
    EXPECT_EQ(entriesOf(folder()).size(), 1U);
}

TEST_F(Store, TakesNoDamagedEntryAndReplacesIt) {
    compiler::CacheStore store(options());
    store.put("module", "key", "the value");
    const fs::path file = entriesOf(folder()).at(0);
    const base::Bytes whole = must(base::readFile(file));
    // Changes every byte, and cuts at every length.
    for (std::size_t i = 0; i < whole.size(); ++i) {
        base::Bytes damaged = whole;
        damaged[i] ^= 0x10U;
        ASSERT_TRUE(base::writeFile(file, damaged));
        EXPECT_FALSE(store.find("module", "key")) << "byte " << i;
        ASSERT_TRUE(base::writeFile(file, std::span(whole).first(i)));
        EXPECT_FALSE(store.find("module", "key")) << "cut at " << i;
    }
    base::Bytes longer = whole;
    longer.push_back(0);
    ASSERT_TRUE(base::writeFile(file, longer));
    EXPECT_FALSE(store.find("module", "key"));
    store.put("module", "key", "the value");
    EXPECT_EQ(store.find("module", "key"), "the value");
}

TEST_F(Store, RemovesWhatWasNotUsedForLongest) {
    compiler::StoreOptions small = options();
    small.maxBytes = 5000;
    compiler::CacheStore store(small);
    const std::string value(1000, 'x');
    for (const char* const key : {"a", "b", "c", "d"}) {
        store.put("module", key, value);
    }
    const auto now = fs::file_time_type::clock::now();
    for (const fs::path& file : entriesOf(folder())) {
        fs::last_write_time(file, now - std::chrono::hours(2));
    }
    EXPECT_TRUE(store.find("module", "b"));
    store.put("module", "e", value);
    store.trim();
    EXPECT_TRUE(store.find("module", "b"));
    EXPECT_TRUE(store.find("module", "e"));
    std::uint64_t bytes = 0;
    for (const fs::path& file : entriesOf(folder())) {
        bytes += fs::file_size(file);
    }
    EXPECT_LE(bytes, small.maxBytes);
    EXPECT_EQ(entriesOf(folder()).size(), 4U);
    EXPECT_TRUE(fs::exists(folder() / "CACHEDIR.TAG"));
}

TEST_F(Store, RemovesWhatKilledWritersLeft) {
    compiler::CacheStore store(options());
    store.put("module", "key", "value");
    const fs::path file = entriesOf(folder()).at(0);
    const fs::path left = file.string() + ".tmp1-1";
    const fs::path young = file.string() + ".tmp2-1";
    ASSERT_TRUE(base::writeFile(left, std::string_view("half")));
    ASSERT_TRUE(base::writeFile(young, std::string_view("half")));
    fs::last_write_time(left, fs::file_time_type::clock::now() - std::chrono::hours(2));
    store.trim();
    EXPECT_FALSE(fs::exists(left));
    EXPECT_TRUE(fs::exists(young));
    EXPECT_TRUE(store.find("module", "key"));
}

TEST_F(Store, NotesAFolderThatCantBeWritten) {
    ASSERT_TRUE(base::writeFile(folder(), std::string_view("a file")));
    compiler::CacheStore store(options());
    EXPECT_FALSE(store.find("module", "key"));
    store.put("module", "key", "value");
    store.trim();
    ASSERT_TRUE(store.trouble());
    EXPECT_EQ(store.trouble()->id, "cache-write");
    EXPECT_EQ(store.trouble()->severity, Severity::Note);
    const base::Bytes file = must(base::readFile(folder()));
    EXPECT_EQ(file.size(), 6U);
}

// Each value repeats its key, so that a mixture of two is detected.
std::string valueOf(const std::string& key) {
    std::string value;
    for (int i = 0; i < 2000; ++i) {
        value += key;
    }
    return value;
}

// Writes and reads the same few keys again and again in a folder that is too small for them. Returns how
// often a value was found, or -1 after a wrong one.
int hammer(const compiler::StoreOptions& options, int rounds) {
    compiler::CacheStore store(options);
    int found = 0;
    for (int i = 0; i < rounds; ++i) {
        const std::string key = "key " + std::to_string(i % 16);
        if (const std::optional<std::string> value = store.find("module", key)) {
            if (*value != valueOf(key)) {
                return -1;
            }
            ++found;
        }
        store.put("module", key, valueOf(key));
        if (i % 8 == 0) {
            store.trim();
        }
    }
    return store.trouble() ? -1 : found;
}

TEST_F(Store, ManyProcessesAndThreadsMayWriteAtOnce) {
    compiler::StoreOptions small = options();
    small.maxBytes = 100'000;
    constexpr int kRounds = 300;
    std::vector<pid_t> children;
    for (int i = 0; i < 4; ++i) {
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            _exit(hammer(small, kRounds) > 0 ? 0 : 1);
        }
        children.push_back(child);
    }
    std::vector<int> found(2);
    {
        std::vector<std::jthread> threads;
        threads.reserve(found.size());
        for (int& count : found) {
            threads.emplace_back([&] { count = hammer(small, kRounds); });
        }
    }
    for (const pid_t child : children) {
        int status = 0;
        ASSERT_EQ(waitpid(child, &status, 0), child);
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    }
    for (const int count : found) {
        EXPECT_GT(count, 0);
    }
}

}  // namespace
}  // namespace glint
