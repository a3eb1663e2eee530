// Checks by the #include lines that tool/plan depends only on the standard library, fmt and the runtime's
// table of effects, which is plain data.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

namespace {

namespace fs = std::filesystem;

TEST(PlanPurity, IncludesTheStandardLibraryAndFmtOnly) {
    const std::regex include(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
    const std::regex standard(R"([a-z_]+)");  // standard headers have no folder and no suffix
    int lines = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(GLINT_SOURCE_DIR "/tool/plan")) {
        const std::string suffix = entry.path().extension().string();
        if (suffix != ".h" && suffix != ".cpp") {
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
            const bool allowed = match[1].str() == "\""
                                     ? name.starts_with("plan/")
                                     : std::regex_match(name, standard) || name.starts_with("fmt/") ||
                                           name == "glint/effects.h";
            EXPECT_TRUE(allowed) << entry.path() << " includes " << name;
        }
    }
    EXPECT_GT(lines, 5) << "no sources found";
}

}  // namespace
