#include "resolve/host.h"

#include "base/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>

namespace glint::compiler {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kHostFolder = "host/";
constexpr const char* kHint = "name a folder that has files of shaders/host, as docs/host.md describes";

// The names of Glint's own files: "geometry.glsl".
std::vector<std::string> ownFiles() {
    std::vector<std::string> names;
    for (const base::BuiltinFile& file : builtinFiles()) {
        if (file.name.starts_with(kHostFolder)) {
            names.emplace_back(file.name.substr(kHostFolder.size()));
        }
    }
    return names;
}

bool isOwnFolder(const std::string& name) {
    return std::ranges::any_of(
        builtinFiles(), [&](const base::BuiltinFile& file) { return file.name.starts_with(name + "/"); });
}

// Notes for readers, and what version control and editors keep.
bool isIgnored(const fs::path& path) {
    const std::string name = path.filename().string();
    return name.starts_with('.') || name.ends_with('~') || path.extension() == ".md";
}

Status checkFile(const fs::path& path, const std::vector<std::string>& own) {
    const std::string name = path.filename().string();
    if (std::ranges::find(own, name) == own.end()) {
        return makeError("host-unknown", path.generic_string(),
                         fmt::format("stands in for no file of a host{}", base::suggestion(name, own)),
                         fmt::format("these are {}; files that they include are in folders of their own",
                                     fmt::join(own, ", ")));
    }
    return okStatus();
}

// Adds the files below a folder of the host's folder.
Status addInner(const fs::path& folder, std::vector<fs::path>& files) {
    if (isOwnFolder(folder.filename().string())) {
        return makeError("host-unknown", folder.generic_string(),
                         "has the name of a folder of Glint's shaders",
                         "rename it: its files are included by that name");
    }
    std::error_code error;
    for (fs::recursive_directory_iterator place(folder, error);
         !error && place != fs::recursive_directory_iterator(); place.increment(error)) {
        const fs::path extension = place->path().extension();
        if ((extension == ".glsl" || extension == ".h") && place->is_regular_file(error)) {
            files.push_back(place->path());
        }
    }
    return error ? Status(makeError("host-folder", folder.generic_string(),
                                    "can't be listed: " + error.message(), kHint))
                 : okStatus();
}

}  // namespace

Result<std::vector<fs::path>> hostFiles(const std::string& folder) {
    std::vector<fs::path> files;
    if (folder.empty()) {
        return files;
    }
    const std::vector<std::string> own = ownFiles();
    bool replaces = false;
    std::error_code error;
    for (fs::directory_iterator place(folder, error); !error && place != fs::directory_iterator();
         place.increment(error)) {
        if (isIgnored(place->path())) {
            continue;
        }
        const bool isFolder = place->is_directory(error);
        GLINT_TRY_DO(isFolder ? addInner(place->path(), files) : checkFile(place->path(), own));
        if (!isFolder) {
            files.push_back(place->path());
            replaces = true;
        }
    }
    if (error) {
        return makeError("host-folder", folder, "can't be listed: " + error.message(), kHint);
    }
    if (!replaces) {
        return makeError("host-folder", folder, "has no file of a host", kHint);
    }
    std::ranges::sort(files);
    return files;
}

Result<std::vector<std::string>> replacedHostFiles(const std::string& folder) {
    GLINT_TRY(auto files, hostFiles(folder));
    std::vector<std::string> names;
    for (const fs::path& file : files) {
        if (const fs::path inner = file.lexically_relative(folder); !inner.has_parent_path()) {
            names.push_back(inner.string());
        }
    }
    return names;
}

bool isHostPlace(const std::string& where, const std::string& folder) {
    const std::string begin = (fs::path(folder) / "").generic_string();
    return where.starts_with(begin) || where.starts_with("./" + begin);
}

}  // namespace glint::compiler
