// Sizes and offsets of the structures that host and device share, as their declarations give them.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

struct MemberLayout {
    std::string name;
    std::uint32_t offset;  // bytes
};

struct StructLayout {
    std::string name;
    std::uint32_t bytes;
    std::vector<MemberLayout> members;  // all members, in order
};

// Lays out every structure of `declarations`, the text of interopDeclarations(), in the `scalar` layout,
// which is also that of C++. A member is of a type of interop/types.h, or an array of one. Error
// "interop-type" for other members.
Result<std::vector<StructLayout>> interopLayouts(std::string_view declarations);

}  // namespace glint::compiler
