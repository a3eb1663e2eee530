// Tests --lock: shader IDs that stay, the file that keeps them, and the messages about changes.
#include "cli/command.h"
#include "cli/tiny_scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// The scene has two keys: "unlit" for the wall, and "normals" for the floor.
class Lock : public TinySceneTest {
protected:
    void coatTheFloor() const {
        writeTinyScene(path(""), {.variants = true});
    }
    // Plans with --merge none. `more` decides whether anything besides the lock is written.
    Outcome compile(std::vector<std::string> more) const {
        more.insert(more.begin(),
                    {"compile", scene_, "-o", "package", "--merge", "none", "--strategy", "visibility"});
        return run(more);
    }
    void writeLock(const std::string& lines) const {
        writeText(path("glint.lock"), "version 1\n" + lines);
    }
    // Returns the lock without its comments.
    std::string lock() const {
        const std::string text = readText(path("glint.lock"));
        return text.substr(std::min(text.find("version"), text.size()));
    }
};

TEST_F(Lock, IsMadeAndThenLeftAlone) {
    const Outcome outcome = must(compile({"--lock", "glint.lock"}));
    EXPECT_TRUE(outcome.err.empty()) << outcome.err;
    EXPECT_EQ(lock(), "version 1\n1 normals\n0 unlit\n");
    EXPECT_TRUE(readText(path("glint.lock")).starts_with("# "));
    const fs::file_time_type before = fs::last_write_time(path("glint.lock"));
    ASSERT_EQ(compile({"--lock", "glint.lock", "--locked"}).exit, 0);
    ASSERT_EQ(compile({"--lock", "glint.lock"}).exit, 0);
    EXPECT_EQ(fs::last_write_time(path("glint.lock")), before);
}

TEST_F(Lock, KeysKeepTheirIdsAndComeBackToThem) {
    ASSERT_EQ(compile({"--lock", "glint.lock"}).exit, 0);
    coatTheFloor();
    const Outcome coated = must(compile({"--lock", "glint.lock"}));
    EXPECT_EQ(lock(), "version 1\n2 clearcoat normals\n1 normals\n0 unlit\n");
    EXPECT_TRUE(has(coated.err, "glint.lock: note: keeps 1 key that no scene has: 1 normals; --lock-prune"))
        << coated.err;
    // The gap is also in the package.
    const Json shaders = run({"inspect", "package", "--json"}).json().at("shaders");
    EXPECT_EQ(shaders.back().at("id"), 2);
    const std::string header = readText(path("package/glint_tables.h"));
    EXPECT_TRUE(has(header, "kShaderCount = 3;")) << header;
    EXPECT_TRUE(has(header, "// Retired_1\n")) << header;
    EXPECT_FALSE(has(header, " = 1,  // ")) << header;

    writeTinyScene(path(""));
    ASSERT_EQ(compile({"--lock", "glint.lock"}).exit, 0);
    EXPECT_EQ(lock(), "version 1\n2 clearcoat normals\n1 normals\n0 unlit\n");
    const Outcome pruned = must(compile({"--lock", "glint.lock", "--lock-prune"}));
    EXPECT_TRUE(has(pruned.err, "note: loses 1 key that no scene has: 2 clearcoat normals [lock-stale]"))
        << pruned.err;
    EXPECT_EQ(lock(), "version 1\n1 normals\n0 unlit\n");
}

TEST_F(Lock, LockedRefusesAnyChange) {
    writeLock("7 unlit\n");
    const Outcome refused = compile({"--lock", "glint.lock", "--locked"});
    EXPECT_EQ(refused.exit, 1);
    EXPECT_TRUE(has(refused.err, "1 key without a shader ID: normals (Floor)")) << refused.err;
    EXPECT_TRUE(has(refused.err, "[lock-outdated]")) << refused.err;
    EXPECT_FALSE(fs::exists(path("package")));
    EXPECT_EQ(lock(), "version 1\n7 unlit\n");
    // Nothing has to be compiled for that.
    EXPECT_EQ(run({"compile", scene_, "--dry-run", "--lock", "glint.lock", "--locked"}).exit, 1);
    writeLock("7 unlit\n2 normals\n3 sheen\n");
    EXPECT_EQ(run({"compile", scene_, "--dry-run", "--lock", "glint.lock", "--locked"}).exit, 0);
    const Outcome missing = compile({"--lock", "none.lock", "--locked"});
    EXPECT_EQ(missing.exit, 1);
    EXPECT_TRUE(has(missing.err, "none.lock: error: no such file")) << missing.err;
}

// This file results from a merge of branches that took both sides.
TEST_F(Lock, ClashingKeysAreSettledWithAWarning) {
    writeLock("4 normals\n4 unlit\n");
    const Outcome strict = compile({"--lock", "glint.lock", "--werror"});
    EXPECT_EQ(strict.exit, 1);
    EXPECT_FALSE(fs::exists(path("package")));
    EXPECT_EQ(lock(), "version 1\n4 normals\n4 unlit\n");
    const Outcome outcome = must(compile({"--lock", "glint.lock"}));
    EXPECT_TRUE(has(outcome.err, ", 4 -> 0")) << outcome.err;
    EXPECT_TRUE(has(outcome.err, "[lock-conflict]")) << outcome.err;
    // The floor is larger than the wall.
    EXPECT_EQ(lock(), "version 1\n4 normals\n0 unlit\n");
    writeLock("4 normals\n4 unlit\n2 normals\n");
    const Outcome repeated = must(compile({"--lock", "glint.lock"}));
    EXPECT_TRUE(
        has(repeated.err, "glint.lock:4: warning: gives normals (Floor) a second shader ID; 2 counts"))
        << repeated.err;
    EXPECT_EQ(lock(), "version 1\n2 normals\n4 unlit\n");
}

TEST_F(Lock, MergedKeysTakeOneId) {
    writeLock("4 normals\n2 unlit\n");
    const Outcome outcome = compile({"--lock", "glint.lock", "--merge", "all"});
    ASSERT_EQ(outcome.exit, 2) << "two --merge";
    const Outcome merged = must(run({"compile", scene_, "-o", "package", "--merge", "all", "--strategy",
                                     "visibility", "--lock", "glint.lock"}));
    EXPECT_TRUE(has(merged.err, "normals (Floor), 4 -> 2")) << merged.err;
    EXPECT_TRUE(has(merged.err, "[lock-moved]")) << merged.err;
    EXPECT_EQ(lock(), "version 1\n2 normals\n2 unlit\n");
}

TEST_F(Lock, FilesThatAreNoLocksAreRefused) {
    const std::vector<std::pair<std::string, std::string>> files{
        {"", "glint.lock:1: error: ends without a line \"version 1\""},
        {"{}\n", "glint.lock:1: error: \"{}\" comes before a line"},
        {"version 1\n0 unlit\n<<<<<<< HEAD\n", "glint.lock:3: error: a merge conflict was left unresolved"},
        {"version 1\n0 unlti\n", "glint.lock:2: error: \"unlti\" is no feature; did you mean unlit?"},
        {"version 7\n", "this glint reads 1"},
    };
    for (const auto& [text, message] : files) {
        writeText(path("glint.lock"), text);
        const Outcome outcome = compile({"--lock", "glint.lock"});
        EXPECT_EQ(outcome.exit, 1) << text;
        EXPECT_TRUE(has(outcome.err, message)) << outcome.err;
        EXPECT_TRUE(has(outcome.err, "[lock-format]")) << outcome.err;
        EXPECT_EQ(readText(path("glint.lock")), text);
    }
    EXPECT_EQ(compile({"--lock", "no/folder/glint.lock"}).exit, 1);
    EXPECT_EQ(compile({"--lock", "."}).exit, 1);
    EXPECT_FALSE(fs::exists(path("package")));
}

TEST_F(Lock, FailedCompilesAndDryRunsLeaveItAlone) {
    EXPECT_EQ(compile({"--lock", "glint.lock", "--max-shaders", "1"}).exit, 1);
    EXPECT_FALSE(fs::exists(path("glint.lock")));
    EXPECT_EQ(run({"compile", scene_, "--dry-run", "--lock", "glint.lock"}).exit, 0);
    EXPECT_FALSE(fs::exists(path("glint.lock")));
    writeLock("4 normals\n");
    EXPECT_EQ(compile({"--lock", "glint.lock", "--max-shaders", "1"}).exit, 1);
    EXPECT_EQ(lock(), "version 1\n4 normals\n");
}

TEST_F(Lock, ExplainReadsIt) {
    writeLock("4 normals\n");
    const std::vector<std::string> explain{"explain", scene_, "--merge", "none", "--json", "--lock"};
    std::vector<std::string> arguments = explain;
    arguments.emplace_back("glint.lock");
    const Outcome outcome = must(run(arguments));
    const Json materials = outcome.json().at("materials");
    EXPECT_EQ(materials[0].at("keys")[0].at("case").at("id"), 4);
    EXPECT_EQ(materials[1].at("keys")[0].at("case").at("id"), 0);
    EXPECT_EQ(lock(), "version 1\n4 normals\n");
    arguments.back() = "none.lock";
    EXPECT_EQ(run(arguments).exit, 1);
}

TEST_F(Lock, ItsOptionsNeedIt) {
    EXPECT_EQ(compile({"--locked"}).exit, 2);
    EXPECT_EQ(compile({"--lock-prune"}).exit, 2);
    EXPECT_EQ(compile({"--lock", "glint.lock", "--locked", "--lock-prune"}).exit, 2);
    EXPECT_FALSE(fs::exists(path("glint.lock")));
}

}  // namespace
}  // namespace glint::testing
