// Fuzzes a profile of counted hits.
#include "fuzz/fuzz_target.h"
#include "fuzz/scratch_file.h"
#include "resolve/profile.h"
#include "support/temporary_folder.h"

#include <string>

namespace {

glint::Result<glint::compiler::Profile> read(std::span<const std::uint8_t> bytes) {
    static const glint::test::TemporaryFolder folder;
    static glint::fuzz::ScratchFile file(folder.path() / "profile.json");
    return glint::compiler::readProfile(file.hold(bytes));
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using glint::fuzz::require;
    const glint::Result<glint::compiler::Profile> profile = read({data, size});
    if (!profile) {
        require(!profile.error().id.empty(), "an error of a profile has an id");
        return 0;
    }
    const std::string text = glint::compiler::toText(*profile);
    const glint::Result<glint::compiler::Profile> again =
        read({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    require(again.ok() && glint::compiler::toText(*again) == text, "a profile reads back as it was written");
    return 0;
}
