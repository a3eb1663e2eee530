// The tool and the runtime share the namespace glint and are linked into one program. If both defined a type
// of the same name there, the linker would use one's functions for both.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>

namespace {

namespace fs = std::filesystem;

// Returns the name of the type that a line at the outermost level defines, or an empty text.
std::string definedType(std::string_view line) {
    for (const std::string_view keyword : {"enum class ", "enum ", "struct ", "class "}) {
        if (line.starts_with(keyword)) {
            const std::string_view rest = line.substr(keyword.size());
            // `struct Outer::Inner {` completes a nested type, which can't collide.
            const bool nested = rest.substr(0, rest.find_first_of(" {<")).find("::") != rest.npos;
            const bool isDefinition = rest.find('{') != rest.npos && rest.find('(') == rest.npos && !nested;
            return isDefinition ? std::string(rest.substr(0, rest.find_first_of(" :{<"))) : std::string();
        }
    }
    return {};
}

// Returns where the headers below `folder` define each type.
std::map<std::string, std::string> typesBelow(const fs::path& folder) {
    std::map<std::string, std::string> types;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".h") {
            continue;
        }
        std::ifstream file(entry.path());
        for (std::string line; std::getline(file, line);) {
            if (const std::string name = definedType(line); !name.empty()) {
                const auto [other, isNew] = types.emplace(name, entry.path().string());
                EXPECT_TRUE(isNew) << name << " stands in " << entry.path() << " and " << other->second;
            }
        }
    }
    return types;
}

TEST(Names, ToolAndRuntimeShareNoType) {
    const std::map<std::string, std::string> runtime = typesBelow(GLINT_SOURCE_DIR "/runtime");
    const std::map<std::string, std::string> tool = typesBelow(GLINT_SOURCE_DIR "/tool");
    ASSERT_TRUE(runtime.contains("DeviceImage"));
    ASSERT_TRUE(tool.contains("Scene"));
    for (const auto& [name, path] : tool) {
        const auto same = runtime.find(name);
        EXPECT_TRUE(same == runtime.end()) << name << " stands in " << path << " and " << same->second;
    }
}

}  // namespace
