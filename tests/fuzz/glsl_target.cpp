// Fuzzes GLSL, which packs give: the passes over the text of a module. A pass that can't read something
// leaves it as it is.
#include "emit/glsl/passes.h"
#include "fuzz/fuzz_target.h"

#include <optional>
#include <string>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using glint::fuzz::require;
    const std::string text = "#version 460\n" + std::string(glint::fuzz::asText(data, size));
    const auto include = [](std::string_view name) {
        return name == "a" ? std::optional<std::string_view>("float a(float x) { return x; }\n")
                           : std::nullopt;
    };
    const auto unit =
        glint::compiler::flatten("fuzz.glsl", text, include, glint::compiler::FlattenSide::Glsl);
    if (!unit) {
        require(!unit.error().id.empty() && !unit.error().where.empty(), "an error has an id and a place");
        return 0;
    }
    const glint::compiler::GlslUnit used = glint::compiler::dropUnused(glint::compiler::cutDecided(*unit));
    require(glint::compiler::dropUnused(used).text() == used.text(),
            "what is used is dropped by no second call");
    const std::string essential = glint::compiler::essentialText(used.text());
    require(glint::compiler::essentialText(essential) == essential, "nothing is left to be taken away");
    const std::string shorter = glint::compiler::withConstParameters(essential, {});
    require(glint::compiler::withConstParameters(shorter, {}) == shorter, "parameters become const at once");
    glint::compiler::prefixNames(essential);
    glint::compiler::makeReadable(*unit, "// Made.\n");
    return 0;
}
