#include "inspect/manifest_file.h"

#include "base/files.h"
#include "base/json.h"

#include <glint/package_format.h>

namespace glint::inspect {

Diagnostic manifestError(const std::filesystem::path& folder, const std::string& why) {
    return makeError("manifest-format", (folder / package::kManifestFile).string(),
                     "is no manifest that can be read: " + why, "compile the package again");
}

Result<base::Json> readManifestFile(const std::filesystem::path& folder) {
    GLINT_TRY(const auto bytes, base::readFile(folder / package::kManifestFile));
    if (base::nestsTooDeep(bytes)) {
        return manifestError(folder, "nests too deep");
    }
    base::Json json = base::Json::parse(bytes.begin(), bytes.end(), nullptr, false);
    if (!json.is_object()) {
        return manifestError(folder, "is no JSON object");
    }
    return json;
}

}  // namespace glint::inspect
