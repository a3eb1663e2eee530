// Fuzzes a profile of counted hits.
#include "fuzz/fuzz_target.h"
#include "fuzz/scratch_file.h"
#include "support/temporary_folder.h"

#include <glint/measure/profile.h>

#include <string>

namespace {

glint::Result<glint::measure::Profile> read(std::span<const std::uint8_t> bytes) {
    static const glint::test::TemporaryFolder folder;
    static glint::fuzz::ScratchFile file(folder.path() / "profile.json");
    return glint::measure::readProfile(file.hold(bytes));
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using glint::fuzz::require;
    const glint::Result<glint::measure::Profile> profile = read({data, size});
    if (!profile) {
        require(!profile.error().id.empty(), "an error of a profile has an id");
        return 0;
    }
    const std::string text = glint::measure::toText(*profile);
    const glint::Result<glint::measure::Profile> again =
        read({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    require(again.ok() && glint::measure::toText(*again) == text, "a profile reads back as it was written");
    return 0;
}
