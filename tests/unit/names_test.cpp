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

// Returns the namespace that a line opens, or an empty text.
std::string openedNamespace(std::string_view line) {
    constexpr std::string_view kKeyword = "namespace ";
    return line.starts_with(kKeyword) && line.ends_with(" {")
               ? std::string(line.substr(kKeyword.size(), line.size() - kKeyword.size() - 2))
               : std::string();
}

// Returns where the headers below `folder` define each type of each namespace.
std::map<std::string, std::string> typesBelow(const fs::path& folder) {
    std::map<std::string, std::string> types;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".h") {
            continue;
        }
        std::ifstream file(entry.path());
        std::string scope;
        for (std::string line; std::getline(file, line);) {
            if (const std::string opened = openedNamespace(line); !opened.empty()) {
                scope = opened;
            }
            if (const std::string name = definedType(line); !name.empty()) {
                const auto [other, isNew] = types.emplace(scope + "::" + name, entry.path().string());
                EXPECT_TRUE(isNew) << name << " stands in " << entry.path() << " and " << other->second;
            }
        }
    }
    return types;
}

TEST(Names, ToolAndRuntimeShareNoType) {
    const std::map<std::string, std::string> runtime = typesBelow(GLINT_SOURCE_DIR "/runtime");
    const std::map<std::string, std::string> tool = typesBelow(GLINT_SOURCE_DIR "/tool");
    ASSERT_TRUE(runtime.contains("glint::DeviceImage"));
    ASSERT_TRUE(tool.contains("glint::Scene"));
    for (const auto& [name, path] : tool) {
        const auto same = runtime.find(name);
        EXPECT_TRUE(same == runtime.end()) << name << " stands in " << path << " and " << same->second;
    }
}

}  // namespace
