#include "emit/package/in_place.h"

#include "base/files.h"
#include "emit/package/swap.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace glint::compiler {

namespace fs = std::filesystem;

namespace {

Diagnostic placeError(const fs::path& path, const std::string& why) {
    return makeError("output-write", path.string(), "can't be written: " + why,
                     "check the folder, its permissions and the free space; nothing was changed");
}

// tables.bin leaves first and arrives last. The manifest does the opposite, because a later run recognises
// the folder as a package by it.
int rank(const std::string& name) {
    return name == package::kTablesFile ? 0 : name == package::kManifestFile ? 2 : 1;
}

void removeEmptyParents(fs::path file, const fs::path& folder) {
    std::error_code error;
    for (file = file.parent_path(); file != folder && fs::remove(file, error); file = file.parent_path()) {
    }
}

bool isReal(const fs::path& path) {
    std::error_code error;
    return fs::canonical(path, error) == path && !error;
}

// A list of renames. They are undone in reverse order unless they are kept.
class Moves {
public:
    explicit Moves(fs::path folder) : folder_(std::move(folder)) {}
    Moves(const Moves&) = delete;
    Moves& operator=(const Moves&) = delete;
    ~Moves() {
        std::error_code ignored;
        for (auto move = done_.rbegin(); move != done_.rend(); ++move) {
            const auto& [from, to] = *move;
            fs::rename(to, from, ignored);
            removeEmptyParents(to, folder_);
        }
    }

    // Moves a file. `to` must not exist; its parent folders are created. The path must not contain a link,
    // because that could lead out of the folder.
    std::error_code move(const fs::path& from, const fs::path& to) {
        std::error_code error;
        if (fs::exists(fs::symlink_status(to, error))) {
            return std::make_error_code(std::errc::file_exists);
        }
        fs::create_directories(to.parent_path(), error);
        if (!error && !(isReal(from.parent_path()) && isReal(to.parent_path()))) {
            return std::make_error_code(std::errc::too_many_symbolic_link_levels);
        }
        if (!error) {
            fs::rename(from, to, error);
        }
        if (!error) {
            done_.emplace_back(from, to);
        }
        return error;
    }
    void keep() {
        done_.clear();
    }

private:
    fs::path folder_;
    std::vector<std::pair<fs::path, fs::path>> done_;
};

}  // namespace

Status replaceInPlace(std::span<const PackageFile* const> arriving, const std::vector<std::string>& leaving,
                      const fs::path& folder) {
    Result<StagingFolder> staging = StagingFolder::create(innerStaging(folder));
    if (!staging) {
        Diagnostic error = staging.error();
        error.where = folder.string();
        return error;
    }
    std::vector<const PackageFile*> incoming(arriving.begin(), arriving.end());
    std::ranges::sort(incoming, std::greater<>{}, [](const PackageFile* file) { return rank(file->name); });
    std::vector<std::string> outgoing = leaving;
    std::ranges::sort(outgoing, std::less<>{}, rank);

    // Writing the files comes first, because only that can fail for lack of space.
    const fs::path fresh = staging->path() / "new";
    for (const PackageFile* file : incoming) {
        std::error_code error;
        fs::create_directories((fresh / file->name).parent_path(), error);
        Status written = error ? Status(placeError(folder, error.message())) : okStatus();
        written = written ? base::writeStaged(fresh / file->name, file->bytes) : written;
        if (!written) {
            return placeError(folder / file->name, written.error().message);
        }
    }

    Moves moves(folder);
    for (const std::string& name : outgoing) {
        if (const std::error_code error = moves.move(folder / name, staging->path() / "old" / name)) {
            return placeError(folder / name, error.message());
        }
    }
    for (const PackageFile* file : incoming) {
        if (const std::error_code error = moves.move(fresh / file->name, folder / file->name)) {
            return placeError(folder / file->name, error.message());
        }
    }
    moves.keep();
    for (const std::string& name : outgoing) {
        removeEmptyParents(folder / name, folder);
    }
    return okStatus();
}

}  // namespace glint::compiler
