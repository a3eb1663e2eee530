// Fuzzes manifest.json, as `glint compile` reads the one that it replaces. The files that it lists may be
// deleted, so no name may lead out of the package's folder.
#include "emit/package/manifest.h"
#include "fuzz/fuzz_target.h"

#include <algorithm>
#include <filesystem>
#include <string>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    namespace fs = std::filesystem;
    for (const std::string& name : glint::compiler::manifestFiles(glint::fuzz::asText(data, size))) {
        const fs::path path(name);
        glint::fuzz::require(!name.empty() && !path.is_absolute(), "files of a manifest have relative names");
        glint::fuzz::require(std::ranges::find(path, "..") == path.end(),
                             "files of a manifest lie in its folder");
    }
    return 0;
}
