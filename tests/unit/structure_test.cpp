// The shape of the source tree: how large folders are, and which part may know which.
#include <glint/internal/package_modules.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;
namespace package = glint::package;

// The parts of the tool, from what knows least to what knows most. A part includes itself and the parts
// before it.
constexpr std::string_view kParts[] = {"base",      "materials", "plan",    "gltf", "scene",   "spirv",
                                       "cache",     "settings",  "resolve", "emit", "inspect", "image",
                                       "synthetic", "session",   "measure", "view", "cli"};
// The first part that may use the runtime and Vulkan, and not only the headers that say what a package is and
// what a renderer is asked for.
constexpr std::string_view kFirstWithRuntime = "inspect";
constexpr std::string_view kPlainHeaders[] = {
    "glint/layers.h",        "glint/internal/package_format.h", "glint/internal/package_modules.h",
    "glint/package_shape.h", "glint/renderer_options.h",        "glint/result.h",
    "glint/scene_view.h"};

// The folders of the runtime, in the same order.
constexpr std::string_view kRuntimeFolders[] = {"modules", "context", "package",  "data", "sky",
                                                "scene",   "frame",   "renderer", "steps"};

std::optional<std::size_t> rankOf(std::string_view part) {
    const auto* const found = std::ranges::find(kParts, part);
    return found == std::end(kParts) ? std::nullopt
                                     : std::optional(static_cast<std::size_t>(found - std::begin(kParts)));
}

bool isSource(const fs::path& path) {
    constexpr std::string_view kSuffixes[] = {".h",     ".cpp",   ".cu",    ".py",   ".sh",
                                              ".glsl",  ".comp",  ".vert",  ".frag", ".rgen",
                                              ".rchit", ".rahit", ".rmiss", ".js"};
    return std::ranges::find(kSuffixes, path.extension().string()) != std::end(kSuffixes);
}

// Calls `visit` for each source below a folder of the repository.
void visitSources(const std::string& folder, const std::function<void(const fs::path&)>& visit) {
    for (const fs::directory_entry& entry :
         fs::recursive_directory_iterator(fs::path(GLINT_SOURCE_DIR) / folder)) {
        if (entry.is_regular_file() && isSource(entry.path())) {
            visit(entry.path());
        }
    }
}

// Calls `visit` for each file that a source includes.
void visitIncludes(const fs::path& source, const std::function<void(const std::string&)>& visit) {
    static const std::regex kInclude(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
    std::ifstream file(source);
    for (std::string line; std::getline(file, line);) {
        std::smatch match;
        if (std::regex_search(line, match, kInclude)) {
            visit(match[1].str());
        }
    }
}

// Returns "measure" for "measure/page.h" and "glint/measure/bed.h"; empty if the file is of no part of the
// tool.
std::string partOf(const std::string& included) {
    const std::string path = included.starts_with("glint/") ? included.substr(6) : included;
    const std::size_t slash = path.find('/');
    return slash != std::string::npos && rankOf(path.substr(0, slash)) ? path.substr(0, slash)
                                                                       : std::string();
}

TEST(Structure, FoldersHoldAtMostFortySources) {
    constexpr int kMost = 40;
    std::map<std::string, int> sizes;
    for (const char* const folder :
         {"benchmarks", "examples", "runtime", "scripts", "shaders", "tool", "verify"}) {
        visitSources(folder, [&](const fs::path& path) {
            ++sizes[fs::relative(path.parent_path(), GLINT_SOURCE_DIR).generic_string()];
        });
    }
    ASSERT_TRUE(sizes.contains("tool/measure"));
    ASSERT_TRUE(sizes.contains("runtime/src/renderer"));
    for (const auto& [folder, size] : sizes) {
        EXPECT_LE(size, kMost) << folder;
    }
}

TEST(Structure, PartsOfTheToolIncludeThoseBeforeThem) {
    int includes = 0;
    for (const std::string_view part : kParts) {
        const std::string folder = "tool/" + std::string(part);
        visitSources(folder, [&](const fs::path& source) {
            visitIncludes(source, [&](const std::string& included) {
                // The proofs are above the tool, and can be left out.
                EXPECT_FALSE(included.starts_with("verify/")) << source << " includes " << included;
                const std::string other = partOf(included);
                if (other.empty()) {
                    return;
                }
                ++includes;
                EXPECT_LE(*rankOf(other), *rankOf(part)) << source << " includes " << included;
                // Reading glTF needs materials, but no planning.
                EXPECT_TRUE(part != "gltf" || other != "plan") << source << " includes " << included;
            });
        });
    }
    EXPECT_GT(includes, 500);
}

TEST(Structure, EveryFolderOfTheToolIsAPart) {
    visitSources("tool", [](const fs::path& source) {
        const fs::path part = *fs::relative(source, GLINT_SOURCE_DIR "/tool").begin();
        EXPECT_TRUE(rankOf(part.string())) << source;
    });
}

// What the runtime declares is in `glint` itself. The parts of the compiler share a namespace, because they
// are one library.
TEST(Structure, EveryPartOfTheToolHasANamespaceOfItsOwn) {
    const std::map<std::string, std::string, std::less<>> shared{
        {"plan", "compiler"},     {"scene", "compiler"},   {"spirv", "compiler"}, {"cache", "compiler"},
        {"settings", "compiler"}, {"resolve", "compiler"}, {"emit", "compiler"}};
    static const std::regex kNamespace(R"(^namespace (glint[\w:]*) \{)");
    static const std::regex kAllowed(
        R"(^(class |struct |using base::|(static )?base::Fields fieldsOf\(|[ }]))");
    for (const std::string_view part : kParts) {
        const auto found = shared.find(part);
        const std::string own = "glint::" + (found == shared.end() ? std::string(part) : found->second);
        visitSources("tool/" + std::string(part), [&](const fs::path& path) {
            std::ifstream file(path);
            // Whether a namespace only declares what another part defines, or gives the JSON of its types.
            bool forwards = true;
            for (std::string line, opened; std::getline(file, line);) {
                std::smatch match;
                if (std::regex_search(line, match, kNamespace)) {
                    opened = match[1];
                    forwards = true;
                } else if (line == "}  // namespace " + opened) {
                    EXPECT_TRUE(forwards || opened.starts_with(own)) << path << " opens " << opened;
                    opened.clear();
                } else if (!opened.empty() && !line.empty() && !std::regex_search(line, kAllowed)) {
                    forwards = false;
                }
            }
        });
    }
}

TEST(Structure, TheCompilerKnowsNoVulkan) {
    for (const std::string_view part : kParts) {
        if (part == kFirstWithRuntime) {
            break;
        }
        visitSources("tool/" + std::string(part), [&](const fs::path& source) {
            visitIncludes(source, [&](const std::string& included) {
                const bool ofRuntime = included.starts_with("glint/") && partOf(included).empty();
                const bool plain = std::ranges::find(kPlainHeaders, included) != std::end(kPlainHeaders);
                EXPECT_FALSE(included.starts_with("vulkan/") || (ofRuntime && !plain))
                    << source << " includes " << included;
            });
        });
    }
}

// A strategy is its row and its folder. What else names one would have to be touched for a new one.
TEST(Structure, StrategiesAreNamedByTheirRowsAndFolders) {
    const std::set<std::string> allowed{
        "runtime/src/modules/strategies.cpp",     // the rows
        "runtime/include/glint/package_shape.h",  // names for programs, and the default
        "tool/plan/strategy_constants.h",         // measured costs, which a script writes
    };
    // Strategies in constants, quotes, options and paths, and modules in quotes.
    std::vector<std::string> namings{"kStrategyUber", "kStrategyVisibility", "kStrategySortedUber",
                                     "kStrategyHitShaders"};
    for (const package::StrategyInfo& info : package::strategyTable()) {
        const std::string name(info.name);
        std::string folder = name;
        std::ranges::replace(folder, '-', '_');
        namings.insert(namings.end(), {"\"" + name + "\"", "--strategy " + name, "--strategy=" + name,
                                       "strategies/" + folder});
        if (name != folder) {
            namings.push_back(name);  // in comments and messages, too
        }
        for (const package::StrategyModule& module : info.modules) {
            namings.push_back("\"" + std::string(module.name) + "\"");
            namings.push_back("\"" + std::string(module.fallback.empty() ? module.name : module.fallback) +
                              "\"");
        }
    }
    int files = 0;
    for (const char* const folder : {"cmake", "runtime", "shaders", "templates", "tool"}) {
        for (const fs::directory_entry& entry :
             fs::recursive_directory_iterator(fs::path(GLINT_SOURCE_DIR) / folder)) {
            const std::string path = fs::relative(entry.path(), GLINT_SOURCE_DIR).generic_string();
            if (!entry.is_regular_file() || allowed.contains(path) ||
                path.starts_with("shaders/strategies/")) {
                continue;
            }
            ++files;
            std::ifstream file(entry.path());
            const std::string text{std::istreambuf_iterator<char>(file), {}};
            for (const std::string& naming : namings) {
                EXPECT_EQ(text.find(naming), std::string::npos) << path << " has " << naming;
            }
        }
    }
    EXPECT_GT(files, 500);
}

TEST(Structure, TheRuntimeIncludesNothingOfTheTool) {
    int includes = 0;
    visitSources("runtime", [&](const fs::path& source) {
        visitIncludes(source, [&](const std::string& included) {
            EXPECT_TRUE(!included.starts_with("glint/") || partOf(included).empty())
                << source << " includes " << included;
            const std::size_t slash = included.find('/');
            const std::string folder = slash == std::string::npos ? std::string() : included.substr(0, slash);
            if (std::ranges::find(kRuntimeFolders, folder) != std::end(kRuntimeFolders)) {
                ++includes;
                EXPECT_TRUE(fs::exists(fs::path(GLINT_SOURCE_DIR "/runtime/src") / included))
                    << source << " includes " << included;
            } else {
                EXPECT_TRUE(rankOf(folder) == std::nullopt) << source << " includes " << included;
            }
        });
    });
    EXPECT_GT(includes, 100);
}

// Returns "spirv/lint" for tool/spirv/lint.h and tool/spirv/lint.cpp: a header and its source are one unit.
std::string unitOf(const std::string& included) {
    const std::string path = included.starts_with("glint/") ? included.substr(6) : included;
    return path.substr(0, path.rfind('.'));
}

// The units that each unit includes.
using Units = std::map<std::string, std::set<std::string>>;

// Types stand below what uses them, so no unit includes itself through others.
void expectNoCycles(const Units& includes) {
    for (const auto& [start, direct] : includes) {
        std::set<std::string> reached;
        std::vector<std::string> open(direct.begin(), direct.end());
        while (!open.empty()) {
            const std::string unit = std::move(open.back());
            open.pop_back();
            if (const auto found = includes.find(unit);
                found != includes.end() && reached.insert(unit).second) {
                open.insert(open.end(), found->second.begin(), found->second.end());
            }
        }
        EXPECT_FALSE(reached.contains(start)) << start << " includes itself through others";
    }
}

TEST(Structure, UnitsOfTheToolIncludeNoCycles) {
    Units includes;
    for (const char* const folder : {"tool", "verify"}) {
        visitSources(folder, [&](const fs::path& source) {
            std::string path = fs::relative(source, GLINT_SOURCE_DIR).generic_string();
            if (path.starts_with("tool/")) {
                path = path.substr(5);
            }
            if (const std::size_t glint = path.find("include/glint/"); glint != std::string::npos) {
                path = path.substr(glint + 8);
            }
            const std::string unit = unitOf(path);
            std::set<std::string>& included = includes[unit];
            visitIncludes(source, [&](const std::string& name) {
                if (unitOf(name) != unit) {
                    included.insert(unitOf(name));
                }
            });
        });
    }
    EXPECT_GT(includes.size(), 200U);
    expectNoCycles(includes);
}

// Returns the units of the runtime by folder and name, such as "scene/gpu_scene". A public header is a unit
// by itself, which sources below that of its name may include, too. It is in the folder of that source, or in
// the folder of its own name. All others are plain, as the package's modules are.
Units unitsOfTheRuntime() {
    std::map<std::string, std::string> folders;  // by the name of a public header
    visitSources("runtime/src", [&](const fs::path& source) {
        folders[source.stem().string()] = source.parent_path().filename().string();
    });
    for (const std::string_view folder : kRuntimeFolders) {
        folders.emplace(folder, folder);
    }
    const auto runtimeUnit = [&](const std::string& included) {
        const fs::path path(included);
        const std::string name = path.stem().string();
        if (!included.starts_with("glint/")) {
            return path.parent_path().filename().string() + "/" + name;
        }
        const auto found = folders.find(name);
        return (found == folders.end() ? "modules" : found->second) + "/glint/" + name;
    };
    Units includes;
    visitSources("runtime", [&](const fs::path& source) {
        const std::string path = fs::relative(source, GLINT_SOURCE_DIR "/runtime/include").generic_string();
        const std::string unit = runtimeUnit(path);
        std::set<std::string>& included = includes[unit];
        visitIncludes(source, [&](const std::string& name) {
            const std::string other = runtimeUnit(name);
            const bool isOfRuntime = std::ranges::find(kRuntimeFolders, other.substr(0, other.find('/'))) !=
                                     std::end(kRuntimeFolders);
            if (isOfRuntime && other != unit) {
                included.insert(other);
            }
        });
    });
    return includes;
}

TEST(Structure, UnitsOfTheRuntimeIncludeNoCycles) {
    const Units includes = unitsOfTheRuntime();
    EXPECT_GT(includes.size(), 50U);
    expectNoCycles(includes);
}

TEST(Structure, FoldersOfTheRuntimeIncludeThoseBeforeThem) {
    const auto rank = [](const std::string& unit) {
        return std::ranges::find(kRuntimeFolders, unit.substr(0, unit.find('/'))) - kRuntimeFolders;
    };
    for (const auto& [unit, included] : unitsOfTheRuntime()) {
        EXPECT_LT(rank(unit), std::ssize(kRuntimeFolders)) << unit;
        for (const std::string& other : included) {
            EXPECT_LE(rank(other), rank(unit)) << unit << " includes " << other;
        }
    }
}

// An engine includes few headers. Those in internal/ are for Glint's own tools, and not installed.
TEST(Structure, TheRuntimeHasFewPublicHeaders) {
    int headers = 0;
    visitSources("runtime/include/glint", [&](const fs::path& source) {
        headers += source.parent_path().filename() == "internal" ? 0 : 1;
    });
    EXPECT_GT(headers, 5);
    EXPECT_LE(headers, 12);
}

}  // namespace
