// Numbers and texts in one string of bytes, and back with every length checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace glint {

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

// Takes apart what a Packer made, in the same order. Nothing from the first mismatch on.
class Unpacker {
public:
    explicit Unpacker(std::string_view bytes) : rest_(bytes) {}

    std::optional<std::uint64_t> number();
    // A number of things that take at least `leastBytes` each, so that what is left of the bytes can hold
    // them.
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

}  // namespace glint
