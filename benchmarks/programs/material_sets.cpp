// glint_material_sets: measures how long a program waits for the package of its materials: when it compiles
// them first, and when it edits or adds one.
#include "base/clock.h"
#include "emit/material_compiler.h"
#include "program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace glint {

namespace {

constexpr std::size_t kMostCases = 256;

struct Arguments {
    std::size_t materials = 200;
    std::size_t cases = 20;
    std::string strategy = "visibility";
    std::string cache;
    int rounds = 9;
    int jobs = 0;
    bool fallback = false;
    bool steps = false;
    bool noOptimize = false;
    bool fold = false;
};

// Returns the material of a case: eight switches, which are mixed so that any few cases have each of them.
gltf::MaterialDescription materialOf(std::size_t number, std::size_t which) {
    gltf::MaterialDescription made;
    made.name = fmt::format("material {}", number);
    made.values["roughnessFactor"] = {0.2 + 0.7 * static_cast<double>(number % 101) / 100.0};
    made.attributes = {"NORMAL", "TANGENT", "TEXCOORD_0"};
    const std::size_t switches = which * 37 % kMostCases;
    const auto has = [&](unsigned bit) { return (switches >> bit & 1U) != 0; };
    const char* const textures[] = {"baseColorTexture", "metallicRoughnessTexture", "normalTexture",
                                    "emissiveTexture"};
    for (unsigned bit = 0; bit < std::size(textures); ++bit) {
        if (has(bit)) {
            made.textures[textures[bit]] = {};
        }
    }
    if (has(3)) {
        made.values["emissiveFactor"] = {1.0, 1.0, 1.0};
    }
    const char* const lobes[] = {"clearcoatFactor", "iridescenceFactor", "anisotropyStrength"};
    for (unsigned bit = 0; bit < std::size(lobes); ++bit) {
        if (has(bit + 4)) {
            made.values[lobes[bit]] = {0.75};
        }
    }
    if (has(7)) {
        made.values["sheenColorFactor"] = {0.5, 0.25, 0.125};
    }
    return made;
}

// Milliseconds of a call of MaterialCompiler::compile().
struct Times {
    double read = 0.0;     // checks, the scene and what no other part counts
    double plan = 0.0;     // keys, cases and GLSL
    double compile = 0.0;  // SPIR-V
    double tables = 0.0;
    double whole = 0.0;
    double processor = 0.0;
    std::size_t cases = 0;
    std::size_t modules = 0;  // that were compiled
};

Result<Times> measure(compiler::MaterialCompiler& compiler, const gltf::MaterialSet& set,
                      compiler::NewShaders newShaders = compiler::NewShaders::Optimized) {
    const std::clock_t clock = std::clock();
    const base::Clock::time_point start = base::Clock::now();
    GLINT_TRY(const auto compiled, compiler.compile(set, newShaders));
    Times times;
    times.whole = base::millisecondsSince(start);
    times.processor = 1e3 * static_cast<double>(std::clock() - clock) / CLOCKS_PER_SEC;
    times.plan = compiled.package.planMs;
    times.compile = compiled.package.compileMs;
    times.tables = compiled.package.tablesMs;
    times.read = times.whole - times.plan - times.compile - times.tables;
    times.cases = compiled.package.plan.cases.size();
    times.modules = static_cast<std::size_t>(std::ranges::count_if(
        compiled.package.modules, [](const compiler::CompiledModule& module) { return module.compiled; }));
    return times;
}

void printRow(const char* step, std::vector<Times> rows) {
    std::ranges::sort(rows, {}, &Times::whole);
    const Times& median = rows[rows.size() / 2];
    fmt::print("| {} | {} | {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.0f} ({:.0f} to {:.0f}) | {:.0f} |\n",
               step, median.cases, median.modules, median.read, median.plan, median.compile, median.tables,
               median.whole, rows.front().whole, rows.back().whole, median.processor);
}

Status measure(const Arguments& arguments) {
    compiler::Settings settings;
    settings.compile.strategies = package::findStrategy(arguments.strategy)->strategy;
    settings.compile.plan.merge = compiler::MergePolicy::None;
    settings.compile.plan.fallback = arguments.fallback;
    settings.compile.optimize = !arguments.noOptimize;
    settings.compile.passes = arguments.steps ? package::Passes::Steps : package::Passes::Frame;
    settings.compile.jobs = arguments.jobs;
    gltf::MaterialSet set;
    for (std::size_t i = 0; i < arguments.materials; ++i) {
        set.materials.push_back(materialOf(i, i % arguments.cases));
    }
    GLINT_TRY(auto compiler, compiler::MaterialCompiler::create(settings, arguments.cache));
    GLINT_TRY(const auto cold, measure(compiler, set));
    std::map<std::string, std::vector<Times>> rows;
    const auto newShaders = arguments.fold ? compiler::NewShaders::Folded : compiler::NewShaders::Optimized;
    const auto add = [&](const char* row) -> Status {
        GLINT_TRY(rows[row].emplace_back(), measure(compiler, set, newShaders));
        if (arguments.fold) {
            GLINT_TRY(rows["optimized"].emplace_back(), measure(compiler, set));
        }
        return okStatus();
    };
    std::size_t cases = arguments.cases;
    for (int round = 0; round < arguments.rounds && cases < kMostCases; ++round) {
        GLINT_TRY(rows["same"].emplace_back(), measure(compiler, set));
        set.materials.front().values["roughnessFactor"] = {0.3 + 0.01 * round};
        GLINT_TRY(rows["value"].emplace_back(), measure(compiler, set));
        set.materials.push_back(materialOf(set.materials.size(), 0));
        GLINT_TRY(rows["known"].emplace_back(), measure(compiler, set));
        set.materials.push_back(materialOf(set.materials.size(), cases++));
        GLINT_TRY_DO(add("added"));
        set.materials.back() = materialOf(set.materials.size() - 1, kMostCases - 1 - cases);
        GLINT_TRY_DO(add("changed"));
    }
    fmt::print("{} materials, strategy {}, {} rounds; milliseconds\n\n", arguments.materials,
               arguments.strategy, arguments.rounds);
    fmt::print(
        "| | cases | modules compiled | read | plan | SPIR-V | tables | whole call | processor |\n"
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    printRow("first call", {cold});
    printRow("nothing changed", rows["same"]);
    printRow("another value", rows["value"]);
    printRow("a material more, of a known case", rows["known"]);
    printRow("a material more, of a new case", rows["added"]);
    printRow("a material changed to a new case", rows["changed"]);
    if (arguments.fold) {
        printRow("the same, optimised by another call", rows["optimized"]);
    }
    return okStatus();
}

}  // namespace

}  // namespace glint

int main(int count, char** words) {
    glint::Arguments arguments;
    return glint::benchmarks::runProgram(
        "Measures how long a program waits for the package of its materials.",
        {{"--materials", &arguments.materials, "of the set"},
         {"--cases", &arguments.cases, "of these materials"},
         {"--strategy", &arguments.strategy, "name of the strategy"},
         {"--cache", &arguments.cache, "folder of compiled shaders; without it, memory alone"},
         glint::benchmarks::roundsOption(arguments.rounds, "edits of each kind"),
         {"--jobs", &arguments.jobs, "threads; 0: one for each core"},
         {"--steps", &arguments.steps, "for rays of an engine's own, without a frame"},
         {"--fallback", &arguments.fallback, "compile a fallback, too"},
         {"--no-optimize", &arguments.noOptimize, "as of glint compile"},
         {"--fold", &arguments.fold, "new shaders are folded first, then optimised by another call"}},
        count, words, [&] { return glint::measure(arguments); });
}
