// Tests packages whose modules Ninja compiles one by one.
#include "cli/command.h"
#include "cli/many_keys.h"
#include "cli/tiny_scene.h"

#include <chrono>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace glint::testing {
namespace {

namespace fs = std::filesystem;

using Words = std::vector<std::string>;

int count(const std::string& text, const std::string& part) {
    int found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++found;
    }
    return found;
}

class Farm : public CommandTest {
protected:
    Outcome compile(const Words& scenes, const Words& options) const {
        Words words{"compile"};
        words.insert(words.end(), scenes.begin(), scenes.end());
        words.insert(words.end(), options.begin(), options.end());
        return run(words);
    }
    Outcome ninja(const std::string& plan = "plan") const {
        return runProgram({"ninja", "-f", plan + "/build.ninja"}, {{"NINJA_STATUS", ""}});
    }
    // The numbers of things that Ninja compiles and makes now; both are below 0 if it fails.
    struct Work {
        int modules = -1;
        int packages = -1;
    };
    Work work(const std::string& plan = "plan") const {
        const Outcome outcome = must(ninja(plan));
        return outcome.exit == 0 ? Work{count(outcome.out, "MODULE "), count(outcome.out, "PACKAGE ")}
                                 : Work{};
    }
    Words filesOf(const std::string& folder, const std::string& extension) const {
        Words files;
        for (const std::string& file : filesBelow(path(folder))) {
            if (file.ends_with(extension)) {
                files.push_back(file);
            }
        }
        return files;
    }
};

TEST_F(Farm, MakesTheSamePackageToTheByte) {
    writeManyKeys(path("many"));
    writeTinyScene(path(""), {.variants = true});
    const std::string many = "many/scene.gltf";
    const std::string tiny = "scene.gltf";
    const std::vector<std::pair<Words, Words>> runs{
        {{many}, {"--strategy", "uber", "--merge", "none"}},
        {{many, tiny}, {"--strategy", "visibility,hit-shaders", "--tracer", "all", "--emit", "glsl,header"}},
        {{tiny}, {"--strategy", "sorted-uber", "--merge", "all", "--debug-info"}},
        {{tiny},
         {"--strategy", "hit-shaders", "--variant", "Day", "--alpha=tested", "--hit-lobes=base,sheen"}},
        {{tiny}, {"--strategy", "uber,visibility", "--no-optimize"}},
    };
    for (const auto& [scenes, options] : runs) {
        Words whole = options;
        whole.insert(whole.end(), {"-o", "whole", "--cache", "none"});
        ASSERT_EQ(compile(scenes, whole).exit, 0);
        Words planned = options;
        planned.insert(planned.end(), {"-o", "parts", "--plan-only", "plan"});
        ASSERT_EQ(compile(scenes, planned).exit, 0);
        EXPECT_FALSE(fs::exists(path("parts")));
        const Work first = work();
        EXPECT_GT(first.modules, 0);
        EXPECT_EQ(static_cast<std::size_t>(first.modules), filesOf("plan", ".module").size());
        EXPECT_EQ(first.packages, 1);
        EXPECT_TRUE(contentsOf(path("whole")) == contentsOf(path("parts"))) << options[1];
        EXPECT_TRUE(has(ninja().out, "no work to do"));
        fs::remove_all(path("plan"));
        fs::remove_all(path("parts"));
    }
}

TEST_F(Farm, PathsMayHaveWhatNinjaAndShellsTakeForTheirOwn) {
    writeManyKeys(path("a b$c#d:e(f)"));
    const std::string scene = "a b$c#d:e(f)/scene.gltf";
    ASSERT_EQ(compile({scene}, {"-o", "whole", "--cache", "none", "--strategy", "uber"}).exit, 0);
    const Outcome planned = must(compile(
        {scene}, {"-o", "x y$z", "--plan-only", "p$l a:n", "--embed", "e e.cpp", "--strategy", "uber"}));
    EXPECT_TRUE(has(planned.out, "ninja -f 'p$l a:n/build.ninja'")) << planned.out;
    EXPECT_GT(work("p$l a:n").modules, 0);
    EXPECT_TRUE(contentsOf(path("whole")) == contentsOf(path("x y$z")));
    EXPECT_TRUE(fs::exists(path("e e.cpp")));
    EXPECT_TRUE(has(ninja("p$l a:n").out, "no work to do"));
}

TEST_F(Farm, CompilesOnlyWhatChanged) {
    writeManyKeys(path(""));
    const Words options{"-o", "parts", "--merge", "none", "--strategy", "visibility", "--plan-only", "plan"};
    ASSERT_EQ(compile({"scene.gltf"}, options).exit, 0);
    const int all = work().modules;
    ASSERT_GT(all, 4);
    EXPECT_EQ(work().packages, 0);

    // Ninja makes the plan again by itself. A value is only in the tables.
    writeManyKeys(path(""), kFourLobes, 0.25);
    const Work value = work();
    EXPECT_EQ(value.modules, 0);
    EXPECT_EQ(value.packages, 1);

    // This is a new combination of features that the scene already has.
    writeManyKeys(path(""), {{"clearcoat", "sheen"}, {"clearcoat"}, {"sheen"}, {"textured"}}, 0.25);
    EXPECT_EQ(work().modules, 2);  // for first hits and for hits of rays
    EXPECT_TRUE(has(ninja().out, "no work to do"));
    ASSERT_EQ(compile({"scene.gltf"}, {"-o", "whole", "--merge", "none", "--strategy", "visibility"}).exit,
              0);
    EXPECT_TRUE(contentsOf(path("whole")) == contentsOf(path("parts")));
    // Files that are no longer in the plan are removed.
    EXPECT_EQ(filesOf("plan", ".module").size(), static_cast<std::size_t>(all));
    EXPECT_EQ(filesOf("plan", ".glsl").size(), static_cast<std::size_t>(all));
}

TEST_F(Farm, PlanningAgainTouchesNothing) {
    writeManyKeys(path(""));
    const Words options{"-o", "parts", "--plan-only", "plan", "--strategy", "uber", "--lock", "glint.lock"};
    ASSERT_EQ(compile({"scene.gltf"}, options).exit, 0);
    EXPECT_TRUE(fs::exists(path("glint.lock")));
    const auto longAgo = fs::file_time_type::clock::now() - std::chrono::hours(1);
    for (const std::string& file : filesBelow(path("plan"))) {
        fs::last_write_time(path("plan") / file, longAgo);
    }
    Words asJson = options;
    asJson.emplace_back("--json");
    const Outcome again = must(compile({"scene.gltf"}, asJson));
    EXPECT_EQ(again.json().at("plan").at("ninja"), "plan/build.ninja");
    EXPECT_EQ(again.json().at("plan").at("modules"), filesOf("plan", ".glsl").size());
    for (const std::string& file : filesBelow(path("plan"))) {
        if (fs::is_regular_file(path("plan") / file)) {
            EXPECT_EQ(fs::last_write_time(path("plan") / file), longAgo) << file;
        }
    }
    EXPECT_GT(work().modules, 0);
    EXPECT_TRUE(has(ninja().out, "no work to do"));
}

TEST_F(Farm, CompilingAModuleReadsOneFileAndWritesOne) {
    writeManyKeys(path(""));
    ASSERT_EQ(compile({"scene.gltf"}, {"-o", "parts", "--plan-only", "plan", "--strategy", "uber"}).exit, 0);
    ASSERT_GT(work().modules, 0);
    const std::string input = filesOf("plan", ".glsl").front();
    fs::create_directory(path("elsewhere"));
    fs::copy(path("plan") / input, path("elsewhere/other name.glsl"));
    const Outcome alone = must(runProgram({"env", "-i", "-C", path("elsewhere").string(), commandPath(),
                                           "compile-module", "other name.glsl", "-o", "out"}));
    EXPECT_TRUE(alone.out.empty()) << alone.out;
    EXPECT_EQ(filesBelow(path("elsewhere")), (Words{"other name.glsl", "out"}));
    const fs::path compiled = (path("plan") / input).replace_extension(".module");
    EXPECT_TRUE(readText(path("elsewhere/out")) == readText(compiled));
}

TEST_F(Farm, TheLauncherRunsEachCompilation) {
    writeManyKeys(path(""));
    const std::string launcher = "sh -c 'echo \"$2\" >> log; exec \"$0\" \"$@\"'";
    ASSERT_EQ(compile({"scene.gltf"},
                      {"-o", "parts", "--plan-only", "plan", "--strategy", "uber", "--launcher", launcher})
                  .exit,
              0);
    const int modules = work().modules;
    EXPECT_GT(modules, 0);
    EXPECT_EQ(count(readText(path("log")), "\n"), modules);
    EXPECT_EQ(count(readText(path("log")), ".glsl\n"), modules);
}

TEST_F(Farm, MissingAndForeignModulesAreErrors) {
    writeManyKeys(path(""));
    ASSERT_EQ(compile({"scene.gltf"}, {"-o", "parts", "--plan-only", "plan", "--strategy", "uber"}).exit, 0);
    const Words take{"-o", "parts", "--modules", "plan/modules", "--strategy", "uber"};
    const Outcome missing = compile({"scene.gltf"}, take);
    EXPECT_EQ(missing.exit, 1);
    EXPECT_TRUE(has(missing.err, "[module-missing]")) << missing.err;
    EXPECT_FALSE(fs::exists(path("parts")));

    ASSERT_GT(work().modules, 0);
    ASSERT_EQ(compile({"scene.gltf"}, take).exit, 0);
    const auto whole = contentsOf(path("parts"));
    // Those that the package itself takes: parts have been joined into others.
    Words modules;
    for (const std::string& module : filesOf("plan", ".module")) {
        const std::string content = readText(path("plan") / module);
        fs::remove(path("plan") / module);
        if (compile({"scene.gltf"}, take).exit != 0) {
            modules.push_back(module);
        }
        writeText(path("plan") / module, content);
        if (modules.size() == 2) {
            break;
        }
    }
    ASSERT_EQ(modules.size(), 2U);
    const std::string first = readText(path("plan") / modules[0]);
    writeText(path("plan") / modules[0], readText(path("plan") / modules[1]));
    const Outcome stale = compile({"scene.gltf"}, take);
    EXPECT_EQ(stale.exit, 1);
    EXPECT_TRUE(has(stale.err, "[module-stale]")) << stale.err;
    for (const std::string& torn : {first.substr(0, first.size() / 2), first + "x", std::string("?")}) {
        writeText(path("plan") / modules[0], torn);
        const Outcome damaged = compile({"scene.gltf"}, take);
        EXPECT_EQ(damaged.exit, 1);
        EXPECT_TRUE(has(damaged.err, "[module-format]")) << damaged.err;
    }
    EXPECT_TRUE(contentsOf(path("parts")) == whole);
}

TEST_F(Farm, MisuseIsRefused) {
    writeManyKeys(path(""));
    for (const Words& options : std::vector<Words>{{"--plan-only", "plan"},
                                                   {"-o", "p", "--launcher", "env"},
                                                   {"-o", "p", "--plan-only", "plan", "--dry-run"},
                                                   {"-o", "p", "--plan-only", "plan", "--modules", "m"},
                                                   {"-o", "p", "--modules", "m", "--dry-run"}}) {
        EXPECT_EQ(compile({"scene.gltf"}, options).exit, 2) << options.back();
    }
    fs::create_directory(path("theirs"));
    writeText(path("theirs/build.ninja"), "# theirs\n");
    const Outcome foreign = compile({"scene.gltf"}, {"-o", "p", "--plan-only", "theirs"});
    EXPECT_EQ(foreign.exit, 1);
    EXPECT_TRUE(has(foreign.err, "[output-not-a-plan]")) << foreign.err;
    EXPECT_EQ(readText(path("theirs/build.ninja")), "# theirs\n");
    EXPECT_EQ(filesBelow(path("theirs")), Words{"build.ninja"});
    const Outcome bar = compile({"scene.gltf"}, {"-o", "p", "--plan-only", "a|b"});
    EXPECT_EQ(bar.exit, 1);
    EXPECT_TRUE(has(bar.err, "[ninja-name]")) << bar.err;

    const std::string sound = "// glint module 2\n// stage comp\n//\n#version 460\nvoid main() {}\n";
    for (const auto& [text, id] : std::vector<std::pair<std::string, std::string>>{
             {"", "[module-format]"},
             {"#version 460\nvoid main() {}\n", "[module-format]"},
             {"// glint module 2\n// stage comp\n", "[module-format]"},
             {"// glint module 2\n// stage tess\n//\n", "[module-format]"},
             {"// glint module 2\n//\n#version 460\n", "[module-format]"},
             {"// glint module 2\n// colour red\n//\n", "[module-format]"},
             {sound + "wrong", "[glsl]"}}) {
        writeText(path("in"), text);
        const Outcome outcome = run({"compile-module", "in", "-o", "out"});
        EXPECT_EQ(outcome.exit, 1) << text;
        EXPECT_TRUE(has(outcome.err, id)) << outcome.err;
        EXPECT_FALSE(fs::exists(path("out")));
    }
    writeText(path("in"), sound);
    EXPECT_EQ(run({"compile-module", "in", "-o", "out"}).exit, 0);
    EXPECT_EQ(run({"compile-module", "in"}).exit, 2);
    EXPECT_EQ(run({"compile-module", "nothing", "-o", "out"}).exit, 1);
    EXPECT_EQ(run({"compile-module", "in", "-o", "no/such/out"}).exit, 1);
}

}  // namespace
}  // namespace glint::testing
