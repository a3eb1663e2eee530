// glint compile --watch, as a process of its own.
#include "cli/command.h"
#include "cli/many_keys.h"
#include "cli/tiny_scene.h"
#include "support/must.h"

#include <glint/internal/package_modules.h>
#include <glint/package.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

namespace glint::testing {
namespace {

namespace fs = std::filesystem;

using Words = std::vector<std::string>;

// Returns the path of a file of the test beside a folder that is watched. After a failure any file in the
// folder counts.
fs::path beside(const fs::path& folder, const std::string& name) {
    return (folder / name).lexically_normal().parent_path().string() + "." + name;
}

// A command that runs beside the test.
class Running {
public:
    // Other names than those of CommandTest::run(), which removes its files.
    Running(const fs::path& folder, Words words)
        : out_(beside(folder, "watch-out")), err_(beside(folder, "watch-err")) {
        words.insert(words.begin(), commandPath());
        const std::string cache = (folder / "cache").string();
        child_ = fork();
        if (child_ == 0) {
            constexpr int kMode = 0600;
            const int out = open(out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode);
            const int err = open(err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode);
            std::vector<char*> pointers;
            for (std::string& word : words) {
                pointers.push_back(word.data());
            }
            pointers.push_back(nullptr);
            setenv("GLINT_CACHE", cache.c_str(), 1);
            if (dup2(out, STDOUT_FILENO) >= 0 && dup2(err, STDERR_FILENO) >= 0 &&
                chdir(folder.c_str()) == 0) {
                execv(pointers[0], pointers.data());
            }
            _exit(127);
        }
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    ~Running() {
        if (child_ > 0) {
            kill(child_, SIGKILL);
            waitpid(child_, nullptr, 0);
        }
        fs::remove(out_);
        fs::remove(err_);
    }

    std::vector<std::string> lines() const {
        std::vector<std::string> lines;
        std::istringstream text(readText(out_));
        for (std::string line; std::getline(text, line);) {
            lines.push_back(line);
        }
        return lines;
    }
    // Waits for the line of a run, counted from 1.
    std::string line(std::size_t number) const {
        constexpr int kPatience = 6000;
        for (int i = 0; i < kPatience; ++i) {
            for (const std::string& one : lines()) {
                if (one.starts_with(std::to_string(number) + ". ")) {
                    return one;
                }
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        ADD_FAILURE() << "no line " << number << ": " << readText(out_) << errors();
        return {};
    }
    std::string errors() const {
        return readText(err_);
    }
    // Returns the exit code, or -1.
    int interrupt() {
        kill(child_, SIGINT);
        int status = 0;
        const bool ended = waitpid(child_, &status, 0) == child_ && WIFEXITED(status);
        child_ = -1;
        return ended ? WEXITSTATUS(status) : -1;
    }

private:
    fs::path out_;
    fs::path err_;
    pid_t child_ = -1;
};

class Watching : public CommandTest {
protected:
    void SetUp() override {
        CommandTest::SetUp();
        addMud(writeTinyScene(path(".")), 0.5);
        writeMudPack(path("pack"), 0.25);
    }
    static Words words(const Words& more = {}) {
        Words all{"compile", "scene.gltf", "-o",          "package", "--strategy", "visibility",
                  "--merge", "none",       "--materials", "pack",    "--watch"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    std::optional<std::uint64_t> stamp() const {
        return package::readStamp(path("package.stamp"));
    }
    // Writes a file as editors do.
    void replace(const std::string& name, const std::string& text) const {
        const fs::path edited = beside(path("."), "edited");
        writeText(edited, text);
        fs::rename(edited, path(name));
    }
    static std::string settingsText(const std::string& merge) {
        return R"({"format": "glint-settings", "version": 1, "settings": {"merge": ")" + merge + "\"}}";
    }
    std::string mud(double shade) const {
        const fs::path other = beside(path("."), "other");
        writeMudPack(other, shade);
        std::string text = readText(other / "mud.glsl");
        fs::remove_all(other);
        return text;
    }
};

TEST_F(Watching, AnEditMakesANewPackageOfTheCasesItTouches) {
    Running watch(path("."), words());
    EXPECT_TRUE(has(watch.line(1), "1. first run: new package; cases: 2 compiled, 0 kept")) << watch.line(1);
    EXPECT_EQ(stamp(), 1U);
    Package::Watch packages(path("package"));
    EXPECT_EQ(packages.counter(), 1U);
    Result<std::shared_ptr<const Package>> package = packages.poll();
    ASSERT_TRUE(package);
    EXPECT_EQ(*package, nullptr);

    replace("pack/mud.glsl", mud(0.5));
    const std::string line = watch.line(2);
    EXPECT_TRUE(has(line, "2. pack/mud.glsl: new package; cases: 1 compiled, 1 kept; other modules: "))
        << line;
    // Nothing but the shaders of that case has the pack's code.
    EXPECT_TRUE(has(line, "other modules: 0 compiled, ")) << line;
    EXPECT_TRUE(
        std::regex_search(line, std::regex(R"(kept; \d+ ms: read \d+, plan \d+, compile \d+, write \d+$)")))
        << line;
    EXPECT_EQ(watch.lines().size(), 2U);
    EXPECT_EQ(stamp(), 2U);
    package = packages.poll();
    ASSERT_TRUE(package) << toString(package.error());
    ASSERT_NE(*package, nullptr);
    EXPECT_EQ((*package)->caseCount(), 2U);
    EXPECT_EQ(packages.counter(), 2U);
    EXPECT_EQ(*packages.poll(), nullptr);
    EXPECT_EQ(watch.errors(), "");

    // The package is what a run of its own makes, and earlier modules come from memory.
    Words once{"compile", "scene.gltf", "-o", "again", "--strategy", "visibility", "--merge", "none"};
    once.insert(once.end(), {"--materials", "pack"});
    EXPECT_EQ(run(once).exit, 0);
    EXPECT_EQ(contentsOf(path("package")), contentsOf(path("again")));
    fs::remove_all(path("cache"));
    replace("pack/mud.glsl", mud(0.25));
    EXPECT_TRUE(has(watch.line(3), "new package; cases: 0 compiled, 2 kept; other modules: 0 compiled"))
        << watch.line(3);
    EXPECT_EQ(stamp(), 3U);
    EXPECT_EQ(watch.interrupt(), 0);
}

TEST_F(Watching, ThePackageOfEachEditIsThatOfAFreshRun) {
    const std::string include = "#include \"shared.glsl\"\n";
    const std::string declaration = readText(path("pack/mud.json"));
    writeText(path("pack/shared.glsl"), "float mudShare() { return 0.5; }\n");
    const auto sharing = [&](double shade) {
        std::string text = include + mud(shade);
        text.replace(text.find("mud);"), 4, "mud * mudShare())");
        return text;
    };
    replace("pack/mud.glsl", sharing(0.25));
    const std::vector<std::pair<std::string, std::string>> edits{
        {"pack/mud.glsl", sharing(0.5)},
        {"pack/shared.glsl", "float mudShare() { return 0.25; }\n"},
        {"pack/shared.glsl", "float mudShare() {\n"},
        {"pack/shared.glsl", "float mudShare() { return 0.125; }\n"},
        {"pack/mud.json", std::regex_replace(declaration, std::regex("\"default\": 0"), "\"default\": 0.5")},
        {"pack/mud.json", "{"},
        {"pack/mud.json", declaration},
        {"pack/dust.json", std::regex_replace(declaration, std::regex("mud"), "dust")},
        {"pack/dust.glsl", std::regex_replace(std::regex_replace(mud(0.75), std::regex("mud"), "dust"),
                                              std::regex("MUD"), "DUST")},
    };
    Running watch(path("."), words());
    watch.line(1);
    std::size_t number = 1;
    for (const auto& [name, text] : edits) {
        replace(name, text);
        const std::string line = watch.line(++number);
        Words once{"compile", "scene.gltf", "-o", "again", "--strategy", "visibility", "--merge", "none"};
        once.insert(once.end(), {"--materials", "pack", "--cache", "none"});
        const bool works = run(once).exit == 0;
        EXPECT_EQ(has(line, "failed"), !works) << line;
        EXPECT_TRUE(!works || contentsOf(path("package")) == contentsOf(path("again"))) << line;
    }
    EXPECT_EQ(watch.interrupt(), 0);
}

// The watch knows what it has written. Others may change it all the same.
TEST_F(Watching, AFileOfThePackageThatOthersChangeIsWrittenAgain) {
    Running watch(path("."), words());
    watch.line(1);
    std::string name;
    for (const fs::directory_entry& entry : fs::directory_iterator(path("package"))) {
        name = entry.path().extension() == ".spv" ? entry.path().filename().string() : name;
    }
    std::string other = readText(path("package/" + name));
    other.back() ^= 1;
    replace("package/" + name, other);
    replace("pack/mud.glsl", mud(0.5));
    EXPECT_TRUE(has(watch.line(2), "new package")) << watch.line(2) << watch.errors();
    Words once{"compile", "scene.gltf", "-o", "again", "--strategy", "visibility", "--merge", "none"};
    once.insert(once.end(), {"--materials", "pack"});
    EXPECT_EQ(run(once).exit, 0);
    EXPECT_EQ(contentsOf(path("package")), contentsOf(path("again")));
    EXPECT_EQ(watch.interrupt(), 0);
}

TEST_F(Watching, AMistakeIsReportedAndThePackageStays) {
    Running watch(path("."), words());
    watch.line(1);
    const auto before = contentsOf(path("package"));
    std::string broken = mud(0.5);
    broken.replace(broken.find("float mud"), 9, "float mod");
    replace("pack/mud.glsl", broken);
    EXPECT_TRUE(has(watch.line(2), "2. pack/mud.glsl: failed, the package stays as it was")) << watch.line(2);
    EXPECT_TRUE(has(watch.errors(), "pack/mud.glsl:")) << watch.errors();
    EXPECT_TRUE(has(watch.errors(), "[glsl]")) << watch.errors();
    EXPECT_EQ(contentsOf(path("package")), before);
    EXPECT_EQ(stamp(), 1U);
    replace("pack/mud.glsl", mud(0.5));
    EXPECT_TRUE(has(watch.line(3), "new package; cases: 1 compiled, 1 kept")) << watch.line(3);
    EXPECT_EQ(stamp(), 2U);
    EXPECT_EQ(watch.interrupt(), 0);
}

TEST_F(Watching, FilesThatAreOnlyTouchedAreNoChangeAndThoseThatStayAwayAreAnError) {
    Running watch(path("."), words());
    watch.line(1);
    fs::last_write_time(path("pack/mud.json"), fs::file_time_type::clock::now());
    writeText(path("pack/mud.glsl"), mud(0.75));
    EXPECT_TRUE(has(watch.line(2), "2. pack/mud.glsl: new package")) << watch.line(2);
    fs::remove(path("pack/mud.glsl"));
    EXPECT_TRUE(has(watch.line(3), "failed")) << watch.line(3);
    EXPECT_TRUE(has(watch.errors(), "[materials-glsl]")) << watch.errors();
    writeText(path("pack/mud.glsl"), mud(0.75));
    EXPECT_TRUE(has(watch.line(4), "same package")) << watch.line(4);
    EXPECT_EQ(stamp(), 2U);
    EXPECT_EQ(watch.interrupt(), 0);
}

TEST_F(Watching, DeclarationsOfPacksAreInputs) {
    Running watch(path("."), words());
    watch.line(1);
    std::string declaration = readText(path("pack/mud.json"));
    declaration.replace(declaration.find("there is no mud"), 15, "it has no mud..");
    replace("pack/mud.json", declaration);
    const std::string line = watch.line(2);
    EXPECT_TRUE(has(line, "2. pack/mud.json: ")) << line;
    EXPECT_FALSE(has(line, "failed")) << line << watch.errors();
    EXPECT_EQ(watch.interrupt(), 0);
}

TEST_F(Watching, ScenesAndSettingsFilesAreInputs) {
    writeText(path("settings.json"), settingsText("none"));
    Words all = words({"--settings", "settings.json"});
    all.erase(std::ranges::find(all, "--merge"), std::ranges::find(all, "--merge") + 2);
    Running watch(path("."), all);
    EXPECT_TRUE(has(watch.line(1), "cases: 2 compiled")) << watch.line(1);
    addMud(path("scene.gltf"), 0.75);
    EXPECT_TRUE(has(watch.line(2), "2. scene.gltf: new package; cases: 0 compiled, 2 kept")) << watch.line(2);
    replace("settings.json", settingsText("all"));
    EXPECT_TRUE(has(watch.line(3), "3. settings.json: new package; cases: 1 compiled, 0 kept"))
        << watch.line(3) << watch.errors();
    replace("settings.json", settingsText("some"));
    EXPECT_TRUE(has(watch.line(4), "failed")) << watch.line(4);
    EXPECT_TRUE(has(watch.errors(), "settings")) << watch.errors();
    replace("settings.json", settingsText("none"));
    EXPECT_TRUE(has(watch.line(5), "5. settings.json: new package; cases: 0 compiled, 2 kept"))
        << watch.line(5);
    EXPECT_EQ(stamp(), 4U);
    EXPECT_EQ(watch.interrupt(), 0);
}

// The folder may be replaced once more while it is read, so a package that can't be loaded is tried again.
TEST_F(Watching, APackageThatCannotBeLoadedIsAnErrorAfterSomeTries) {
    writeText(path("package.stamp"), "6 0000000000000000\n");
    Package::Watch packages(path("package/"));
    EXPECT_EQ(packages.counter(), 6U);
    writeText(path("package.stamp"), "7 0000000000000000\n");
    for (int i = 1; i < Package::Watch::kTries; ++i) {
        const Result<std::shared_ptr<const Package>> polled = packages.poll();
        ASSERT_TRUE(polled) << i;
        EXPECT_EQ(*polled, nullptr);
    }
    EXPECT_EQ(mustFail(packages.poll()).id, "package-missing");
    EXPECT_TRUE(packages.poll()) << "it is said once";
    writeText(path("package.stamp"), "no stamp");
    EXPECT_TRUE(packages.poll());
    EXPECT_EQ(packages.counter(), 7U);
}

TEST_F(Watching, NeedsAFolderAndPrintsNoJson) {
    EXPECT_EQ(run({"compile", "scene.gltf", "--watch", "--embed", "package.cpp"}).exit, 2);
    EXPECT_EQ(run({"compile", "scene.gltf", "--watch", "-o", "package", "--json"}).exit, 2);
    EXPECT_EQ(run({"compile", "scene.gltf", "--watch", "-o", "package", "--dry-run"}).exit, 2);
}

}  // namespace
}  // namespace glint::testing
