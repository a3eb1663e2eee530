// Fuzzes a profile of counted hits.
#include "base/files.h"
#include "cli/profile.h"
#include "fuzz/fuzz_target.h"
#include "support/temporary_folder.h"

#include <string>

namespace {

glint::Result<glint::Profile> read(std::span<const std::uint8_t> bytes) {
    static const glint::test::TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "profile.json";
    glint::fuzz::require(glint::writeFile(path, bytes).ok(), "the temporary folder can be written");
    return glint::readProfile(path);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using glint::fuzz::require;
    const glint::Result<glint::Profile> profile = read({data, size});
    if (!profile) {
        require(!profile.error().id.empty(), "an error of a profile has an id");
        return 0;
    }
    const std::string text = glint::toText(*profile);
    const glint::Result<glint::Profile> again =
        read({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    require(again.ok() && glint::toText(*again) == text, "a profile reads back as it was written");
    return 0;
}
