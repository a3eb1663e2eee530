// Checks by the #include lines that tool/plan depends only on the standard library, fmt, and headers of the
// runtime that are plain data: the tables of effects and of modules, and names of enumerators.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

bool isPure(const std::string& materials) {
    constexpr std::string_view kPure[] = {"effect_declaration", "expression",     "interval",
                                          "material",           "material_model", "value_type"};
    return std::ranges::find(kPure, materials) != std::end(kPure);
}

TEST(PlanPurity, IncludesTheStandardLibraryAndFmtOnly) {
    const std::regex include(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
    const std::regex standard(R"([a-z_]+)");  // standard headers have no folder and no suffix
    int lines = 0;
    std::vector<fs::directory_entry> entries;
    for (const char* const folder : {GLINT_SOURCE_DIR "/tool/plan", GLINT_SOURCE_DIR "/tool/materials"}) {
        for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
            entries.push_back(entry);
        }
    }
    for (const fs::directory_entry& entry : entries) {
        const std::string suffix = entry.path().extension().string();
        // Planning includes headers of the materials. They are as pure as itself.
        const bool isPlan =
            entry.path().parent_path().filename() == "plan" || isPure(entry.path().stem().string());
        if ((suffix != ".h" && suffix != ".cpp") || !isPlan) {
            continue;
        }
        std::ifstream file(entry.path());
        for (std::string line; std::getline(file, line);) {
            std::smatch match;
            if (!std::regex_search(line, match, include)) {
                continue;
            }
            ++lines;
            const std::string name = match[2].str();
            const bool allowed =
                match[1].str() == "\""
                    ? name.starts_with("plan/") ||
                          (name.starts_with("materials/") && isPure(fs::path(name).stem().string()))
                    : std::regex_match(name, standard) || name.starts_with("fmt/") ||
                          name == "interop/models.h" || name == "glint/layers.h" ||
                          name == "glint/package_shape.h" || name == "glint/internal/package_format.h" ||
                          name == "glint/internal/package_modules.h" || name == "glint/result.h";
            EXPECT_TRUE(allowed) << entry.path() << " includes " << name;
        }
    }
    EXPECT_GT(lines, 5) << "no sources found";
}

}  // namespace
