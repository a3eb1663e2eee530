#include "cache/action.h"

#include "base/files.h"
#include "cache/store.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>

namespace glint {
namespace {

namespace fs = std::filesystem;

compiler::FileState writtenFile(const fs::path& path, std::string_view text) {
    EXPECT_TRUE(base::writeFile(path, text));
    compiler::FileState state = compiler::stateOf(path).value_or(compiler::FileState{});
    state.real = compiler::realPath(path);
    return state;
}

compiler::ActionRecord sampleRecord(const fs::path& folder) {
    return {{writtenFile(folder / "in", "input")},
            {writtenFile(folder / "out", "output")},
            {{Severity::Warning, "an-id", "where", "what", "hint"}, {Severity::Note, "", "", "note", ""}},
            std::string("summary\0", 8)};
}

TEST(ActionRecord, IsReadAsItWasPacked) {
    const test::TemporaryFolder folder;
    const compiler::ActionRecord record = sampleRecord(folder.path());
    const std::optional<compiler::ActionRecord> read = compiler::unpackAction(pack(record));
    ASSERT_TRUE(read);
    EXPECT_EQ(pack(*read), pack(record));
    ASSERT_EQ(read->diagnostics.size(), 2U);
    EXPECT_EQ(toString(read->diagnostics[0]), toString(record.diagnostics[0]));
    EXPECT_EQ(read->diagnostics[1].severity, Severity::Note);
    EXPECT_EQ(read->inputs[0].path, record.inputs[0].path);
    EXPECT_EQ(read->outputs[0].hash, record.outputs[0].hash);
    EXPECT_EQ(read->summary, record.summary);
}

TEST(ActionRecord, CutShortIsNone) {
    const test::TemporaryFolder folder;
    const std::string bytes = pack(sampleRecord(folder.path()));
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        EXPECT_FALSE(compiler::unpackAction(std::string_view(bytes).substr(0, i))) << i;
    }
    EXPECT_FALSE(compiler::unpackAction(bytes + "x"));
}

TEST(ActionRecord, IsCurrentUntilAFileChanges) {
    const test::TemporaryFolder folder;
    for (const char* const name : {"in", "out"}) {
        const compiler::ActionRecord record = sampleRecord(folder.path());
        EXPECT_TRUE(isCurrent(record));
        // A new time stamp is no change. Other bytes of the same length are a change, and so is a missing
        // file.
        fs::last_write_time(folder.path() / name, fs::file_time_type::clock::now() + std::chrono::hours(1));
        EXPECT_TRUE(isCurrent(record));
        const std::string other = name == std::string("in") ? "INPUT" : "OUTPUT";
        ASSERT_TRUE(base::writeFile(folder.path() / name, other));
        EXPECT_FALSE(isCurrent(record)) << name;
        fs::remove(folder.path() / name);
        EXPECT_FALSE(isCurrent(record)) << name;
    }
}

TEST(ActionRecord, AnInputThatALinkNowLeadsToIsAChange) {
    const test::TemporaryFolder folder;
    const compiler::ActionRecord record = sampleRecord(folder.path());
    fs::rename(folder.path() / "in", folder.path() / "elsewhere");
    fs::create_symlink(folder.path() / "elsewhere", folder.path() / "in");
    EXPECT_FALSE(isCurrent(record));
}

TEST(Unpacker, RefusesCountsAboveItsBytes) {
    const std::string bytes = compiler::Packer().add(std::uint64_t{1} << 60).take();
    EXPECT_FALSE(compiler::Unpacker(bytes).count(1));
    EXPECT_FALSE(compiler::Unpacker(bytes).text());
    EXPECT_TRUE(compiler::Unpacker(bytes).number());
}

TEST(Unpacker, RefusesCountsOfMoreThanItsBytesHold) {
    const std::string bytes = compiler::Packer().add(3).add(0).add(0).add(0).take();
    EXPECT_EQ(compiler::Unpacker(bytes).count(8), 3U);
    EXPECT_FALSE(compiler::Unpacker(bytes).count(9));
}

TEST(ProgramIdentity, IsThatOfEveryObject) {
    const std::string identity = compiler::programIdentity();
    // There are at least the program itself, the C++ library and the C library.
    EXPECT_GE(std::ranges::count(identity, '\n'), 3);
    EXPECT_EQ(identity, compiler::programIdentity());
}

}  // namespace
}  // namespace glint
