#include "cli/lint_files.h"

#include "base/files.h"
#include "base/json_depth.h"

#include <glint/package_format.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>
#include <system_error>

namespace glint {

namespace fs = std::filesystem;

namespace {

constexpr const char* kExtension = ".spv";

std::string textOf(const nlohmann::ordered_json& object, const char* member) {
    const auto found = object.find(member);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

// Finds every object with a "file" that is SPIR-V, wherever it is in the manifest, so that future strategies
// need no change here.
class ManifestWalk {
public:
    explicit ManifestWalk(fs::path folder) : folder_(std::move(folder)) {}

    void visit(const nlohmann::ordered_json& value, const std::string& name) {
        if (value.is_array()) {
            for (const auto& element : value) {
                visit(element, name);
            }
        } else if (value.is_object()) {
            visitObject(value, name);
        }
    }
    std::vector<LintFile> take() {
        return std::move(files_);
    }

private:
    void visitObject(const nlohmann::ordered_json& object, std::string name) {
        if (const std::string role = textOf(object, "role"); !role.empty()) {
            name = role;
        }
        const std::string file = textOf(object, "file");
        if (fs::path(file).extension() == kExtension && seen_.insert(file).second) {
            files_.push_back({folder_ / file, name});
        }
        const bool isShader = object.contains("stages");
        for (const auto& [key, member] : object.items()) {
            if (isShader && key == "stages" && member.is_object()) {
                for (const auto& [stage, module] : member.items()) {
                    visit(module, textOf(object, "name") + " " + stage);
                }
            } else {
                visit(member, name);
            }
        }
    }

    fs::path folder_;
    std::vector<LintFile> files_;
    std::set<std::string> seen_;
};

Result<std::vector<LintFile>> filesOfPackage(const fs::path& folder) {
    const fs::path path = folder / package::kManifestFile;
    const Result<Bytes> bytes = readFile(path);
    if (!bytes) {
        return bytes.error();
    }
    const auto json = nestsTooDeep(*bytes)
                          ? nlohmann::ordered_json()
                          : nlohmann::ordered_json::parse(bytes->begin(), bytes->end(), nullptr, false);
    if (!json.is_object()) {
        return makeError("manifest-format", path.string(), "is no manifest that can be read",
                         "compile the package again");
    }
    ManifestWalk walk(folder);
    // The list of all files comes after those that have a name.
    walk.visit(json, "");
    return walk.take();
}

Result<std::vector<LintFile>> filesBelow(const fs::path& folder) {
    std::vector<LintFile> files;
    std::error_code error;
    for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
        std::error_code ignored;
        if (it->path().extension() == kExtension && it->is_regular_file(ignored)) {
            files.push_back({it->path(), ""});
        }
    }
    if (error) {
        return makeError("lint-path", folder.string(), "can't be listed: " + error.message());
    }
    std::ranges::sort(files, {}, &LintFile::path);
    return files;
}

}  // namespace

Result<LintFiles> findLintFiles(const fs::path& path) {
    std::error_code error;
    if (!fs::is_directory(path, error)) {
        if (!fs::exists(path, error)) {
            return makeError("lint-path", path.string(), "is not there",
                             "name a SPIR-V file, a package or a folder of SPIR-V files");
        }
        return LintFiles{false, {{path, ""}}};
    }
    Result<std::vector<LintFile>> files =
        fs::exists(path / package::kManifestFile, error) ? filesOfPackage(path) : filesBelow(path);
    if (!files) {
        return files.error();
    }
    if (files->empty()) {
        return makeError("lint-path", path.string(), "holds no SPIR-V file",
                         "name a package or a folder of .spv files");
    }
    return LintFiles{true, std::move(*files)};
}

}  // namespace glint
