#include "cli/temporary_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

namespace glint {

namespace fs = std::filesystem;

Result<TemporaryFolder> TemporaryFolder::create() {
    std::error_code error;
    const fs::path parent = fs::temp_directory_path(error);
    if (error) {
        return makeError("temporary-folder", "", "there is no folder for temporary files: " + error.message(),
                         "set TMPDIR to one");
    }
    std::string pattern = (parent / "glint-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) {
        return makeError("temporary-folder", parent.string(),
                         std::string("can't hold a temporary folder: ") + std::strerror(errno),
                         "set TMPDIR to a folder that can be written");
    }
    return TemporaryFolder(fs::path(pattern));
}

TemporaryFolder::TemporaryFolder(TemporaryFolder&& other) noexcept
    : path_(std::exchange(other.path_, fs::path())) {}

TemporaryFolder::~TemporaryFolder() {
    if (!path_.empty()) {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
}

}  // namespace glint
