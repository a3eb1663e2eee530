// A file of a package in memory. `glint compile --embed` makes such files, and Package::load() reads them.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace glint::package {

struct EmbeddedFile {
    std::string_view name;                // file name in the package's folder: "tables.bin", "uber.spv"
    std::span<const std::uint8_t> bytes;  // any alignment; not owned
};

}  // namespace glint::package
