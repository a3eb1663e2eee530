#include "cache/packing.h"

#include <cstring>

namespace glint::compiler {

Packer& Packer::add(std::uint64_t number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    bytes_.append(bytes, sizeof bytes);
    return *this;
}

Packer& Packer::add(std::string_view text) {
    add(static_cast<std::uint64_t>(text.size()));
    bytes_ += text;
    return *this;
}

std::optional<std::uint64_t> Unpacker::number() {
    std::uint64_t number = 0;
    failed_ = failed_ || rest_.size() < sizeof number;
    if (failed_) {
        return std::nullopt;
    }
    std::memcpy(&number, rest_.data(), sizeof number);
    rest_.remove_prefix(sizeof number);
    return number;
}

std::optional<std::uint64_t> Unpacker::count(std::size_t leastBytes) {
    const std::optional<std::uint64_t> value = number();
    failed_ = failed_ || *value > rest_.size() / leastBytes;
    return failed_ ? std::nullopt : value;
}

std::optional<std::string_view> Unpacker::text() {
    const std::optional<std::uint64_t> size = count(1);
    if (!size) {
        return std::nullopt;
    }
    const std::string_view text = rest_.substr(0, *size);
    rest_.remove_prefix(*size);
    return text;
}

}  // namespace glint::compiler
