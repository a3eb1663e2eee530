// Sizes and offsets of the structures that host and device share, as the C++ compiler lays them out.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace glint::compiler {

struct MemberLayout {
    std::string_view name;
    std::uint32_t offset;  // bytes
};

struct StructLayout {
    std::string_view name;
    std::uint32_t bytes;
    std::span<const MemberLayout> members;  // all members, in order
};

// Returns every structure of shaders/interop, except those of deformLayouts(). Static storage.
std::span<const StructLayout> interopLayouts();
// Returns the structures of interop/deform.h. The C++ header of a package leaves them out, because only the
// runtime fills them.
std::span<const StructLayout> deformLayouts();

}  // namespace glint::compiler
