// Packs numbers and texts into one string of bytes, and unpacks them with every length checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace glint::compiler {

class Packer {
public:
    Packer& add(std::uint64_t number);
    Packer& add(std::string_view text);
    std::string take() {
        return std::move(bytes_);
    }

private:
    std::string bytes_;
};

// Unpacks the values of a Packer, in the same order. From the first mismatch on it returns nothing.
class Unpacker {
public:
    explicit Unpacker(std::string_view bytes) : rest_(bytes) {}

    std::optional<std::uint64_t> number();
    // A number of things that take at least `leastBytes` each, so that the remaining bytes can hold them.
    std::optional<std::uint64_t> count(std::size_t leastBytes);
    // Valid as long as the bytes.
    std::optional<std::string_view> text();
    bool atEnd() const {
        return !failed_ && rest_.empty();
    }

private:
    bool failed_ = false;
    std::string_view rest_;
};

}  // namespace glint::compiler
