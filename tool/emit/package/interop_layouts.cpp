#include "emit/package/interop_layouts.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>

namespace glint::compiler {

namespace {

struct TypeSize {
    std::string_view name;
    std::uint32_t bytes;
    std::uint32_t alignment;
};

constexpr TypeSize kTypes[] = {{"uint", 4, 4},  {"float", 4, 4}, {"vec2", 8, 4},
                               {"vec3", 12, 4}, {"vec4", 16, 4}, {"uvec2", 8, 4}};
constexpr TypeSize kAddress{"GLINT_ADDRESS(", 8, 8};

const TypeSize* findType(std::string_view name) {
    const auto* const found = std::ranges::find(kTypes, name, &TypeSize::name);
    return name.starts_with(kAddress.name) ? &kAddress : found == std::end(kTypes) ? nullptr : found;
}

constexpr std::uint32_t alignedTo(std::uint32_t value, std::uint32_t alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

// Cuts the first line off `text`, and returns it without its comment and the blanks around it.
std::string_view takeLine(std::string_view& text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    line = line.substr(0, line.find("//"));
    const std::size_t first = std::min(line.find_first_not_of(' '), line.size());
    line.remove_prefix(first);
    return line.substr(0, line.find_last_not_of(' ') + 1);
}

// Adds the member that a line declares: "vec4 objectToWorld[3];".
Status addMember(std::string_view line, StructLayout& layout, std::uint32_t& alignment) {
    const std::size_t blank = line.find(' ');
    const TypeSize* const type = findType(line.substr(0, blank));
    if (type == nullptr || blank == std::string_view::npos || !line.ends_with(';')) {
        return makeError(
            "internal", "shaders/interop",
            fmt::format("{} has a member that is no scalar, vector or address: {}", layout.name, line),
            "use a type of interop/types.h");
    }
    std::string_view name = line.substr(blank + 1, line.size() - blank - 2);
    std::uint32_t count = 1;
    if (const std::size_t bracket = name.find('['); bracket != std::string_view::npos) {
        std::from_chars(name.data() + bracket + 1, name.data() + name.size(), count);
        name = name.substr(0, bracket);
    }
    const std::uint32_t offset = alignedTo(layout.bytes, type->alignment);
    layout.members.push_back({std::string(name), offset});
    layout.bytes = offset + count * type->bytes;
    alignment = std::max(alignment, type->alignment);
    return okStatus();
}

}  // namespace

Result<std::vector<StructLayout>> interopLayouts(std::string_view declarations) {
    constexpr std::string_view kBegin = "struct ";
    std::vector<StructLayout> layouts;
    while (!declarations.empty()) {
        const std::string_view begin = takeLine(declarations);
        if (!begin.starts_with(kBegin)) {
            continue;
        }
        StructLayout layout{
            std::string(begin.substr(kBegin.size(), begin.find(" {") - kBegin.size())), 0, {}};
        if (findType(layout.name) != nullptr) {
            continue;  // a vector of GLSL in C++
        }
        std::uint32_t alignment = 1;
        for (std::string_view line = takeLine(declarations); line != "};"; line = takeLine(declarations)) {
            if (declarations.empty()) {
                return makeError("internal", "shaders/interop", layout.name + " has no end",
                                 "end it with };");
            }
            // Members that GLSL has only in some packages are always there in C++.
            if (line.empty() || line.starts_with('#')) {
                continue;
            }
            GLINT_TRY_DO(addMember(line, layout, alignment));
        }
        layout.bytes = alignedTo(layout.bytes, alignment);
        layouts.push_back(std::move(layout));
    }
    return layouts;
}

}  // namespace glint::compiler
