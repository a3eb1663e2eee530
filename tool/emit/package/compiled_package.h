// A package in memory: its modules, and the files that are written.
#pragma once

#include "base/files.h"
#include "base/shared_array.h"
#include "plan/plan.h"
#include "spirv/statistics.h"

#include <glint/internal/package_modules.h>
#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::compiler {

class ModuleGlsl;

// One SPIR-V module of the package. Modules with equal bytes share `file`.
struct CompiledModule {
    package::ModuleKey key;
    std::string name;  // "uber.comp", "shade_2_BaseTex.comp"; the GLSL file has the same name
    std::string file;  // name within the package: "uber.spv"
    base::SharedArray<std::uint32_t> spirv;
    std::shared_ptr<const ModuleGlsl> glsl;
    SpirvStatistics statistics;
    std::uint64_t hash = 0;  // of the bytes of `spirv`
    bool compiled = true;    // in this run; false if it was cached or has the text of another module
    bool folded = false;     // by NewShaders::Folded
    // How many of the parts that it was joined from in this run were compiled, and how many were cached.
    // Parts of several modules count for the first of them.
    int partsCompiled = 0;
    int partsCached = 0;
};

struct PackageFile {
    PackageFile(std::string fileName, const base::SharedArray<std::uint8_t>& contents)
        : PackageFile(std::move(fileName), contents, base::hashBytes(contents)) {}
    PackageFile(std::string fileName, base::SharedArray<std::uint8_t> contents, std::uint64_t hashOfBytes)
        : name(std::move(fileName)), bytes(std::move(contents)), hash(hashOfBytes) {}

    std::string name;  // relative, '/' between folders
    base::SharedArray<std::uint8_t> bytes;
    std::uint64_t hash = 0;  // base::hashBytes() of them
};

struct CompiledPackage {
    Plan plan;
    std::vector<CompiledModule> modules;  // in order of their keys
    std::vector<PackageFile> files;       // everything that writePackage() writes, sorted by name
    int uniqueSpirv = 0;
    std::uint64_t spirvBytes = 0;  // sum over the distinct modules
    // Wall clock: planning and making GLSL, making SPIR-V of it, and all else.
    double planMs = 0.0;
    double compileMs = 0.0;
    double tablesMs = 0.0;
};

// A text to compile, of a module or a part of modules. Several modules of a package may have the same text.
struct PlannedModule {
    std::string file;                // without a suffix: nameOfModuleText()
    std::string name;                // name of the first module that has the text, for people
    std::string text;                // as made by makeModuleText()
    std::vector<std::string> parts;  // files that have to be compiled before it
};

// The contents of a package before anything is compiled.
struct PackagePlan {
    Plan plan;
    std::vector<PlannedModule> modules;
};

// Returns the error that writePackage() would have, as far as it can be known before there is a package: the
// folder holds something else, or takes no files. Leaves nothing behind.
Status checkPackageFolder(const std::filesystem::path& folder);

// The files that a process has written to a folder, in the state in which it left them. So it need not read
// them again to know what they hold.
class WrittenPackage {
public:
    using Names = std::set<std::string, std::less<>>;

    // Returns whether the folder still has the file, with those contents.
    bool holds(const std::filesystem::path& folder, const PackageFile& file) const;
    // Returns the names of the files if the folder still has this package; empty otherwise.
    Names names(const std::filesystem::path& folder) const;
    // Takes the files of a package that was just written to the folder.
    void take(const CompiledPackage& package, const std::filesystem::path& folder);

private:
    struct State {
        std::int64_t time = 0;  // of the last change, in nanoseconds of the file system's clock
        std::uint64_t bytes = 0;
        std::uint64_t number = 0;  // of the file

        friend bool operator==(const State&, const State&) = default;
    };
    struct File {
        std::optional<State> state;
        std::uint64_t hash = 0;
    };
    static std::optional<State> stateOf(const std::filesystem::path& path);
    bool isUnchanged(const std::filesystem::path& folder, std::string_view name) const;

    std::filesystem::path folder_;
    std::map<std::string, File, std::less<>> files_;
};

// Replaces the contents of `folder` by the package. Files that did not change keep their time stamps, and
// files of the earlier package that are no longer part of it are removed. tables.bin is written last, so that
// a reader never sees a mixture that passes its checks. A failure leaves the earlier package whole. It is an
// error if the folder holds something other than a package. `written`, which may be null, is what the process
// wrote to the folder last.
Status writePackage(const CompiledPackage& package, const std::filesystem::path& folder,
                    WrittenPackage* written = nullptr);

}  // namespace glint::compiler
