// Tests what a run does again, and what it leaves unchanged.
#include "cli/command.h"
#include "cli/many_keys.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

namespace fs = std::filesystem;

using Words = std::vector<std::string>;

class Incremental : public CommandTest {
protected:
    void SetUp() override {
        CommandTest::SetUp();
        writeManyKeys(path("scene"));
    }
    // Runs once, with a cache of the test's own.
    Outcome compile(const Words& options = {}) const {
        Words words = options;
        if (std::ranges::find(options, "--cache") == options.end()) {
            words.insert(words.end(), {"--cache", "cache"});
        }
        return compileShared(words);
    }
    // The same with the cache of all tests, for those that do not count what is compiled at first.
    Outcome compileShared(const Words& options = {}) const {
        Words words{"compile", "scene/scene.gltf", "--merge", "none", "--json"};
        const Words defaults{"--strategy", "uber,visibility", "-o", "package"};
        for (std::size_t i = 0; i < defaults.size(); i += 2) {
            if (std::ranges::find(options, defaults[i]) == options.end()) {
                words.insert(words.end(), {defaults[i], defaults[i + 1]});
            }
        }
        return must(runWith(words, options));
    }
    // Gives every file of the package an old time stamp, so that a written file shows.
    void age() const {
        for (const auto& [file, bytes] : contentsOf(path("package"))) {
            fs::last_write_time(path("package") / file, old_);
        }
    }
    std::set<std::string> writtenFiles() const {
        std::set<std::string> files;
        for (const auto& [file, bytes] : contentsOf(path("package"))) {
            if (fs::last_write_time(path("package") / file) != old_) {
                files.insert(file);
            }
        }
        return files;
    }

private:
    fs::file_time_type old_ = fs::file_time_type::clock::now() - std::chrono::hours(2);
};

int compiled(const Outcome& outcome) {
    return outcome.json().at("modules").at("compiled").get<int>();
}

// Returns how many parts were compiled for the modules that were joined in the run.
int partsCompiled(const Outcome& outcome) {
    return outcome.json().at("modules").at("parts").at("compiled").get<int>();
}

int partsCached(const Outcome& outcome) {
    return outcome.json().at("modules").at("parts").at("cached").get<int>();
}

bool isUpToDate(const Outcome& outcome) {
    return outcome.json().at("upToDate").get<bool>();
}

TEST_F(Incremental, AColdRunCompilesAndAWarmOneDoesNothing) {
    const Outcome cold = compile();
    EXPECT_GT(compiled(cold), 5);
    EXPECT_FALSE(isUpToDate(cold));
    age();
    const Outcome warm = compile();
    EXPECT_EQ(compiled(warm), 0);
    EXPECT_TRUE(isUpToDate(warm));
    EXPECT_EQ(writtenFiles(), std::set<std::string>{});
    nlohmann::json first = cold.json();
    nlohmann::json second = warm.json();
    for (const char* const member : {"milliseconds", "modules", "upToDate"}) {
        first.erase(member);
        second.erase(member);
    }
    EXPECT_EQ(first, second);
}

// A package has no pixels, because renderers read the scene's images.
TEST_F(Incremental, ATexturesPixelsAreInNoPackage) {
    compileShared();
    age();
    writeBaseTexture(path("scene"), 10);
    // It has to look at them.
    const Outcome changed = compileShared();
    EXPECT_FALSE(isUpToDate(changed));
    EXPECT_EQ(compiled(changed), 0);
    // The manifest lists the files that were read, with their hashes.
    EXPECT_EQ(writtenFiles(), std::set<std::string>{"manifest.json"});
    EXPECT_TRUE(isUpToDate(compileShared()));
    // It does not, if it may not conclude anything from them.
    compileShared({"--no-trust-textures"});
    writeBaseTexture(path("scene"), 11);
    EXPECT_TRUE(isUpToDate(compileShared({"--no-trust-textures"})));
}

TEST_F(Incremental, AnotherTextureIsInTheTablesAlone) {
    writeManyKeys(path("scene"), {{"textured"}, {"clearcoat", "textured"}});
    compileShared();
    age();
    nlohmann::json scene = nlohmann::json::parse(readText(path("scene/scene.gltf")));
    scene["images"].push_back({{"uri", "other.png"}});
    scene["textures"].push_back({{"source", 1}});
    scene["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 1;
    writeText(path("scene/scene.gltf"), scene.dump());
    const Outcome changed = compileShared();
    EXPECT_FALSE(isUpToDate(changed));
    EXPECT_EQ(compiled(changed), 0);
    EXPECT_EQ(writtenFiles(), (std::set<std::string>{"manifest.json", "tables.bin"}));
}

TEST_F(Incremental, AValueIsInTheTablesAlone) {
    compileShared();
    age();
    writeManyKeys(path("scene"), kFourLobes, 0.25);
    const Outcome changed = compileShared();
    EXPECT_FALSE(isUpToDate(changed));
    EXPECT_EQ(compiled(changed), 0);
    EXPECT_EQ(writtenFiles(), (std::set<std::string>{"manifest.json", "tables.bin"}));
}

TEST_F(Incremental, ACombinationCompilesItsModuleAndThoseOfAllCases) {
    compile();
    // The scene has these features already; only the combination is new.
    writeManyKeys(path("scene"), {{"clearcoat", "sheen"}, {"clearcoat"}, {"sheen"}, {"textured"}});
    EXPECT_EQ(compiled(compile({"--strategy", "visibility", "-o", "other"})), 2);
    const Outcome changed = compile();
    EXPECT_EQ(compiled(changed), 1);       // uber.comp; the case's first hits are those of the other package
    EXPECT_EQ(partsCompiled(changed), 2);  // the switch, and the new case
    EXPECT_EQ(partsCached(changed), 3);
    writeManyKeys(path("scene"), kFourLobes);
    EXPECT_EQ(compiled(compile()), 0);
}

TEST_F(Incremental, OneCaseMoreCompilesItsOwnModulesAlone) {
    const Words options{"--strategy", "visibility"};
    compile(options);
    Lobes lobes = kFourLobes;
    lobes.push_back({"clearcoat", "sheen"});
    writeManyKeys(path("scene"), lobes);
    EXPECT_EQ(compiled(compile(options)), 2);  // first hits and those of rays
    const auto package = contentsOf(path("package"));
    compile({"--strategy", "visibility", "--cache", "none"});
    EXPECT_EQ(contentsOf(path("package")), package);
}

// The shaders of strategies that choose among cases are joined from the same parts.
TEST_F(Incremental, StrategiesAndTracersShareTheParts) {
    const Outcome uber = compile({"--strategy", "uber", "-o", "first"});
    EXPECT_EQ(partsCompiled(uber), 5);  // the switch and four cases
    const Outcome both = compile({"--strategy", "uber,sorted-uber", "-o", "second"});
    EXPECT_EQ(partsCompiled(both), 1);  // the other switch
    EXPECT_EQ(partsCached(both), 4);
    const Outcome traced = compile({"--strategy", "uber", "--tracer", "ray-pipeline", "-o", "third"});
    // The switch is a ray generation shader now.
    EXPECT_EQ(partsCompiled(traced), 1);
    EXPECT_EQ(partsCached(traced), 4);
}

TEST_F(Incremental, WithoutACacheEverythingIsCompiledAndNothingRewritten) {
    const Words options{"--cache", "none", "--strategy", "visibility"};
    const int all = compiled(compile(options));
    age();
    const Outcome again = compile(options);
    EXPECT_EQ(compiled(again), all);
    EXPECT_FALSE(isUpToDate(again));
    EXPECT_EQ(writtenFiles(), std::set<std::string>{});
}

TEST_F(Incremental, TornEntriesOfTheCacheAreCompiledAgain) {
    const int all = compiled(compile());
    const auto package = contentsOf(path("package"));
    int number = 0;
    for (const std::string& file : filesBelow(path("cache"))) {
        if (!fs::is_regular_file(path("cache") / file)) {
            continue;
        }
        std::string bytes = readText(path("cache") / file);
        if (++number % 2 == 0) {
            bytes.resize(bytes.size() / 2);
        } else {
            bytes[bytes.size() - 5] ^= 1;
        }
        writeText(path("cache") / file, bytes);
    }
    ASSERT_GT(number, all);
    fs::remove_all(path("package"));
    const Outcome again = compile();
    EXPECT_EQ(compiled(again), all);
    EXPECT_TRUE(contentsOf(path("package")) == package);
    EXPECT_TRUE(isUpToDate(compile()));
}

TEST_F(Incremental, ProcessesShareACache) {
    const std::string script =
        "\"$0\" compile scene/scene.gltf --cache cache --strategy visibility -o a --quiet & first=$!\n"
        "\"$0\" compile scene/scene.gltf --cache cache --strategy visibility -o b --quiet & second=$!\n"
        "wait $first && wait $second";
    const Outcome both = must(runProgram({"sh", "-c", script, commandPath()}));
    EXPECT_EQ(both.err, "");
    EXPECT_FALSE(contentsOf(path("a")).empty());
    EXPECT_TRUE(contentsOf(path("a")) == contentsOf(path("b")));
    for (const std::string& file : filesBelow(path("cache"))) {
        EXPECT_EQ(file.find(".tmp"), std::string::npos) << file;
    }
    const Outcome third = run(
        {"compile", "scene/scene.gltf", "--cache", "cache", "--strategy", "visibility", "-o", "c", "--json"});
    EXPECT_EQ(compiled(third), 0);
}

TEST_F(Incremental, JobsChangeNoByte) {
    compile({"--cache", "none", "--strategy", "visibility", "--jobs", "1", "-o", "one"});
    compile({"--cache", "none", "--strategy", "visibility", "--jobs", "2", "-o", "two"});
    EXPECT_FALSE(contentsOf(path("one")).empty());
    EXPECT_TRUE(contentsOf(path("one")) == contentsOf(path("two")));
}

// Scenes below a folder whose name contains characters that Make and Ninja escape.
class Dependencies : public Incremental {
protected:
    void SetUp() override {
        Incremental::SetUp();
        writeManyKeys(path(folder_));
        must(run({"compile", folder_ + "/scene.gltf", "-o", "pack age", "--depfile", "list.d"}));
    }
    // Makes a file newer than the package.
    void touch(const std::string& name) const {
        const auto later = fs::file_time_type::clock::now() + std::chrono::seconds(5);
        fs::last_write_time(path(folder_) / name, later);
    }

private:
    const std::string folder_ = "a b#c$d:e";
};

TEST_F(Dependencies, AreReadByNinja) {
    writeText(path("build.ninja"),
              "rule run\n  command = echo run >> log\n  depfile = list.d\n"
              "build pack$ age/manifest.json: run\n");
    const Words ninja{"ninja", "-d", "explain", "-n"};
    // Ninja's log is empty, so it runs once.
    ASSERT_EQ(runProgram({"ninja"}).exit, 0);
    const Outcome clean = runProgram(ninja);
    EXPECT_NE(clean.out.find("no work to do"), std::string::npos) << clean.out << clean.err;
    for (const char* const name : {"scene.gltf", "scene.bin"}) {
        const fs::path file = path("a b#c$d:e") / name;
        const auto before = fs::last_write_time(file);
        touch(name);
        const Outcome dirty = runProgram(ninja);
        EXPECT_EQ(dirty.out.find("no work to do"), std::string::npos) << name;
        fs::last_write_time(file, before);
    }
}

TEST_F(Dependencies, AreReadByMake) {
    writeText(path("Makefile"),
              "all: pack\\ age/manifest.json\npack\\ age/manifest.json:\n\techo run\ninclude list.d\n");
    const Words make{"make", "-q", "all"};
    EXPECT_EQ(runProgram(make).exit, 0) << runProgram(make).err;
    for (const char* const name : {"scene.gltf", "scene.bin"}) {
        const fs::path file = path("a b#c$d:e") / name;
        const auto before = fs::last_write_time(file);
        touch(name);
        EXPECT_EQ(runProgram(make).exit, 1) << name;
        fs::last_write_time(file, before);
    }
}

}  // namespace
}  // namespace glint::testing
