// A file of a package in memory: what `glint compile --embed` makes, and Package::load() reads.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace glint::package {

struct EmbeddedFile {
    std::string_view name;                // as in the package's folder: "tables.bin", "uber.spv"
    std::span<const std::uint8_t> bytes;  // of any alignment
};

}  // namespace glint::package
