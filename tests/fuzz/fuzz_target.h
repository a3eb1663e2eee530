// The common parts of fuzz targets: libFuzzer's entry points, which replay_main.cpp calls if there is no
// libFuzzer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

// Names that libFuzzer gives.
// NOLINTBEGIN(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
// Exists in targets whose inputs have a structure that blind mutations would break.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t maxSize,
                                               unsigned int seed);
// libFuzzer's own mutations; returns the new size.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t maxSize);
// NOLINTEND(readability-identifier-naming)

namespace glint::fuzz {

// Checks a property that holds for every input. If it does not hold, the process ends, which is a finding.
inline void require(bool holds, const char* property) {
    if (!holds) {
        std::fprintf(stderr, "fuzz: does not hold: %s\n", property);
        std::abort();
    }
}

inline std::string_view asText(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

}  // namespace glint::fuzz
