// Full disks, failing calls and interruptions at every call by which the command changes a file: afterwards
// either the old files or the new ones are there as a whole.
#include "cli/command.h"
#include "cli/tiny_scene.h"
#include "image/image_file.h"
#include "support/nightly.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

namespace fs = std::filesystem;

// The files below a folder, by their names. Folders have no contents.
using Contents = std::map<std::string, std::string>;

// Returns the paths that differ between two states of a folder, which is easier to read than everything.
std::string difference(const Contents& a, const Contents& b) {
    std::string names;
    for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
        for (const auto& [name, text] : *one) {
            const auto found = other->find(name);
            if (found == other->end() || (one == &a && found->second != text)) {
                names += " " + name;
            }
        }
    }
    return names;
}

// Runs a command under a fault. Its files lie in "work"; its inputs and the cache lie elsewhere.
class Faults : public CommandTest {
protected:
    void SetUp() override {
        CommandTest::SetUp();
        fs::create_directories(path("work"));
    }
    // Runs with a fault at the call number `at` below `folder`; 0 for no fault.
    Outcome runWithFault(const std::vector<std::string>& arguments, const std::string& kind, int at,
                         const std::string& folder = "work") const {
        // The libraries of sanitized tests stay preloaded.
        const char* preloaded = std::getenv("LD_PRELOAD");
        return run(arguments, {{"LD_PRELOAD",
                                std::string(preloaded == nullptr ? "" : preloaded) + ":" GLINT_WRITE_FAULTS},
                               {"GLINT_FAULT_FOLDER", path(folder).string()},
                               {"GLINT_FAULT_KIND", kind},
                               {"GLINT_FAULT_AT", std::to_string(at)},
                               {"GLINT_FAULT_COUNT", path("count").string()}});
    }
    // Returns how many calls a fault can strike. The command must do all its work.
    int countCalls(const std::vector<std::string>& arguments, const std::string& kind,
                   const std::string& folder = "work") const {
        must(runWithFault(arguments, kind, 0, folder));
        const int calls = std::atoi(readText(path("count")).c_str());
        std::printf("%s, %s: %d calls\n", kind.c_str(), folder.c_str(), calls);
        return calls;
    }
    Contents contents() const {
        Contents found;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path("work"))) {
            found[fs::relative(entry.path(), path("work")).string()] =
                entry.is_regular_file() ? readText(entry.path()) : "";
        }
        return found;
    }
    void keep(const std::string& name) const {
        fs::remove_all(path(name));
        fs::copy(path("work"), path(name), fs::copy_options::recursive);
    }
    void restore(const std::string& name) const {
        fs::remove_all(path("work"));
        fs::copy(path(name), path("work"), fs::copy_options::recursive);
    }
};

// Returns the calls of a run that a fault strikes: by night each of them, otherwise every fifth, from the
// last one back, because the renames come last.
std::vector<int> struckCalls(int calls) {
    std::vector<int> struck;
    for (int at = calls; at >= 1; at -= test::nightly() ? 1 : 5) {
        struck.push_back(at);
    }
    return struck;
}

bool saysWhy(const Outcome& outcome) {
    return outcome.err.find("error: ") != std::string::npos &&
           (outcome.err.find("No space left on device") != std::string::npos ||
            outcome.err.find("Input/output error") != std::string::npos);
}

// glint compile with everything that it can write, over the output of an earlier run for another scene.
class CompileFaults : public Faults {
protected:
    void SetUp() override {
        Faults::SetUp();
        fs::create_directories(path("scenes"));
        writeTinyScene(path("scenes"));
        must(run(command("first.o")));
        old_ = contents();
        keep("old");
        // A clearcoat gives another shader, and another key for the lock file.
        writeTinyScene(path("scenes"), {.variants = true});
        must(run(command("second.o")));
        new_ = contents();
        for (const char* name : {"ids.lock", "list.d", "embedded.cpp", "package/tables.bin"}) {
            ASSERT_NE(old_.at(name), new_.at(name)) << name;
        }
        restore("old");
    }
    std::vector<std::string> command(const std::string& target) const {
        return {"compile",
                path("scenes/scene.gltf").string(),
                "-o",
                "work/package",
                "--embed",
                "work/embedded.cpp",
                "--lock",
                "work/ids.lock",
                "--depfile",
                "work/list.d",
                "--strategy",
                "visibility",
                "--merge",
                "none",
                "--cache",
                path("cache").string(),
                "--jobs",
                "1",
                "--depfile-target",
                target};
    }
    std::vector<std::string> command() const {
        return command("second.o");
    }
    bool isOld() const {
        return contents() == old_;
    }
    bool isNew() const {
        return contents() == new_;
    }
    // Expects that each file is the old or the new one, and that those of the package belong together.
    // Folders and files that killed runs left do not count.
    void expectWhole() const {
        bool isOldPackage = true;
        bool isNewPackage = true;
        const Contents now = contents();
        const auto matches = [&](const Contents& state, const std::string& name) {
            return now.contains(name) == state.contains(name) &&
                   (!state.contains(name) || now.at(name) == state.at(name));
        };
        Contents names = old_;
        names.insert(new_.begin(), new_.end());
        for (const auto& [name, ignored] : names) {
            const bool asBefore = matches(old_, name);
            const bool asAfter = matches(new_, name);
            EXPECT_TRUE(asBefore || asAfter) << name;
            if (name.starts_with("package/")) {
                isOldPackage = isOldPackage && asBefore;
                isNewPackage = isNewPackage && asAfter;
            }
        }
        EXPECT_TRUE(isOldPackage || isNewPackage);
    }
    void expectLoadable() const {
        must(run({"inspect", "work/package"}));
    }

    Contents old_;
    Contents new_;
};

TEST_F(CompileFaults, FullDiskLeavesEverythingAsItWas) {
    const int calls = countCalls(command(), "full");
    ASSERT_GT(calls, 40);
    const std::vector<int> struck = struckCalls(calls);
    std::size_t failed = 0;
    for (const int at : struck) {
        restore("old");
        const Outcome outcome = runWithFault(command(), "full", at);
        // Linking unchanged files may fail: they are then copied, or written again.
        ASSERT_TRUE(outcome.exit == 0 ? isNew() : isOld())
            << at << ": " << outcome.exit << outcome.err << difference(old_, contents());
        if (outcome.exit != 0) {
            ++failed;
            ASSERT_EQ(outcome.exit, 1) << at;
            ASSERT_TRUE(saysWhy(outcome)) << at << ": " << outcome.err;
        }
    }
    // Every failure of a call that takes space must be noticed, or the fault is not effective.
    EXPECT_EQ(failed, struck.size());
    expectLoadable();
}

TEST_F(CompileFaults, FailingCallLeavesFilesWhole) {
    const int calls = countCalls(command(), "error");
    ASSERT_GT(calls, 40);
    const std::vector<int> struck = struckCalls(calls);
    std::size_t failed = 0;
    for (const int at : struck) {
        restore("old");
        const Outcome outcome = runWithFault(command(), "error", at);
        expectWhole();
        if (outcome.exit == 0) {
            EXPECT_TRUE(isNew()) << at << difference(new_, contents());
        } else {
            ++failed;
            EXPECT_EQ(outcome.exit, 1) << at;
            EXPECT_TRUE(saysWhy(outcome)) << at << ": " << outcome.err;
            // No file remains that is in neither state.
            Contents known = old_;
            known.insert(new_.begin(), new_.end());
            for (const auto& [name, ignored] : contents()) {
                EXPECT_TRUE(known.contains(name)) << at << ": " << name;
            }
        }
        ASSERT_FALSE(HasFailure()) << at << outcome.err;
    }
    // Other calls only clean up, or keep a file of the earlier package.
    EXPECT_GE(2 * failed, struck.size());
    expectLoadable();
}

TEST_F(CompileFaults, InterruptionWaitsForTheEnd) {
    const int calls = countCalls(command(), "term");
    ASSERT_GT(calls, 40);
    for (const int at : struckCalls(calls)) {
        restore("old");
        const Outcome outcome = runWithFault(command(), "term", at);
        ASSERT_EQ(outcome.exit, -1) << at;
        ASSERT_TRUE(isNew()) << at << difference(new_, contents());
    }
    expectLoadable();
}

TEST_F(CompileFaults, KilledRunLeavesFilesWholeAndTheNextOneCleansUp) {
    const int calls = countCalls(command(), "kill");
    ASSERT_GT(calls, 40);
    for (const int at : struckCalls(calls)) {
        restore("old");
        ASSERT_EQ(runWithFault(command(), "kill", at).exit, -1) << at;
        expectWhole();
        expectLoadable();
        must(run(command()));
        EXPECT_TRUE(isNew()) << difference(new_, contents());
        ASSERT_FALSE(HasFailure()) << at;
    }
}

TEST_F(CompileFaults, CacheThatCannotBeWrittenFailsNothing) {
    // The cache has the modules of this package alone, so that each of them is one that the run needs.
    writeText(path("new.lock"), new_.at("ids.lock"));
    restore("old");
    fs::copy_file(path("new.lock"), path("work/ids.lock"), fs::copy_options::overwrite_existing);
    fs::remove_all(path("cache"));
    ASSERT_EQ(run(command()).exit, 0);
    fs::copy(path("cache"), path("warm"), fs::copy_options::recursive);
    for (const std::string kind : {"full", "error"}) {
        const auto forget = [&] {
            restore("old");
            // A run that changes its own input is not stored.
            fs::copy_file(path("new.lock"), path("work/ids.lock"), fs::copy_options::overwrite_existing);
            // One module is compiled again, so the run does not repeat an earlier one.
            fs::remove_all(path("cache"));
            fs::copy(path("warm"), path("cache"), fs::copy_options::recursive);
            fs::path smallest;
            for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path("cache"))) {
                const bool isModule = entry.path().extension() == ".module";
                if (isModule && (smallest.empty() || entry.file_size() < fs::file_size(smallest))) {
                    smallest = entry.path();
                }
            }
            ASSERT_TRUE(fs::remove_all(smallest.parent_path()) > 0);
        };
        forget();
        const int calls = countCalls(command(), kind, "cache");
        ASSERT_GE(calls, 7);
        int noted = 0;
        for (const int at : struckCalls(calls)) {
            forget();
            const Outcome outcome = runWithFault(command(), kind, at, "cache");
            ASSERT_EQ(outcome.exit, 0) << kind << at << outcome.err;
            ASSERT_TRUE(isNew()) << kind << at << difference(new_, contents());
            if (outcome.err.find("[cache-write]") == std::string::npos) {
                continue;
            }
            ++noted;
            // The current contents of the cache give the same package.
            restore("old");
            ASSERT_EQ(run(command()).exit, 0) << kind << at;
            ASSERT_TRUE(isNew()) << kind << at;
        }
        EXPECT_GE(noted, test::nightly() ? 6 : 1) << kind;
    }
}

// compare --diff stands for every command that writes an image or a file of measurements.
TEST_F(Faults, ImageIsWholeOrTheEarlierOne) {
    LinearImage image{64, 64, {}};
    image.pixels.assign(std::size_t{64} * 64, {0.5F, 0.5F, 0.5F, 1.0F});
    ASSERT_TRUE(image::writeImage(path("a.exr"), image, 0.0));
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        image.pixels[i][0] = static_cast<float>(i % 97);
    }
    ASSERT_TRUE(image::writeImage(path("b.exr"), image, 0.0));
    const std::vector<std::string> command{"compare", "b.exr", "a.exr", "--diff", "work/map.png"};
    ASSERT_EQ(run({"compare", "a.exr", "a.exr", "--diff", "work/map.png"}).exit, 0);
    const Contents before = contents();
    keep("old");
    ASSERT_EQ(run(command).exit, 0);
    const Contents after = contents();
    ASSERT_NE(before, after);
    for (const std::string kind : {"full", "error", "term", "kill"}) {
        restore("old");
        const int calls = countCalls(command, kind);
        ASSERT_GE(calls, 3) << kind;
        for (int at = 1; at <= calls; ++at) {
            restore("old");
            const Outcome outcome = runWithFault(command, kind, at);
            if (kind == "full" || kind == "error") {
                EXPECT_EQ(outcome.exit, 1) << kind << at;
                EXPECT_TRUE(saysWhy(outcome)) << kind << at << outcome.err;
                EXPECT_EQ(contents(), before) << kind << at << difference(contents(), before);
            } else {
                EXPECT_EQ(outcome.exit, -1) << kind << at;
                const std::string map = contents().at("map.png");
                EXPECT_TRUE(map == before.at("map.png") || map == after.at("map.png")) << kind << at;
            }
        }
        // The next run removes what killed runs left.
        ASSERT_EQ(run(command).exit, 0);
        EXPECT_EQ(contents(), after) << kind << difference(contents(), after);
    }
}

}  // namespace
}  // namespace glint::testing
