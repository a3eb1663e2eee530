// Sizes and offsets of the structures that host and device share, as the C++ compiler lays them out.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace glint {

struct MemberLayout {
    std::string_view name;
    std::uint32_t offset;  // bytes
};

struct StructLayout {
    std::string_view name;
    std::uint32_t bytes;
    std::span<const MemberLayout> members;  // all of them, in order
};

// Every structure of shaders/interop but the following. Static storage.
std::span<const StructLayout> interopLayouts();
// Those of interop/deform.h, which the C++ header of a package leaves out: only the runtime fills them.
std::span<const StructLayout> deformLayouts();

}  // namespace glint
