#include "image/exr_bounds.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string_view>

namespace glint {

namespace {

// Layout: "OpenEXR File Layout", https://openexr.com/en/latest/OpenEXRFileLayout.html
constexpr std::size_t kHeaderStart = 8;
constexpr std::uint32_t kMultipart = 0x1000;

class Reader {
public:
    Reader(std::string_view bytes, std::size_t start) : rest_(bytes.substr(std::min(start, bytes.size()))) {}

    // A text that ends in zero; nothing at the end of the file.
    std::optional<std::string_view> text() {
        const std::size_t end = rest_.find('\0');
        if (end == std::string_view::npos) {
            return std::nullopt;
        }
        const std::string_view found = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        return found;
    }
    std::optional<std::uint32_t> word() {
        std::uint32_t value = 0;
        if (rest_.size() < sizeof value) {
            return std::nullopt;
        }
        std::memcpy(&value, rest_.data(), sizeof value);
        rest_.remove_prefix(sizeof value);
        return value;
    }
    bool skip(std::size_t size) {
        if (size > rest_.size()) {
            return false;
        }
        rest_.remove_prefix(size);
        return true;
    }

private:
    std::string_view rest_;
};

}  // namespace

std::string findExrExcess(std::span<const std::uint8_t> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::optional<std::uint32_t> version = Reader(text, sizeof(std::uint32_t)).word();
    Reader reader(text, kHeaderStart);
    bool isEmpty = true;
    while (version) {
        const std::optional<std::string_view> name = reader.text();
        if (!name) {
            return "its header ends early";
        }
        if (name->empty()) {
            // The end of a header; of several, an empty one is the last.
            if ((*version & kMultipart) == 0 || isEmpty) {
                break;
            }
            isEmpty = true;
            continue;
        }
        isEmpty = false;
        const bool hasType = reader.text().has_value();
        const std::optional<std::uint32_t> size = hasType ? reader.word() : std::nullopt;
        if (!size || !reader.skip(*size)) {
            return "an attribute goes beyond its end: " + std::string(*name);
        }
    }
    return {};
}

}  // namespace glint
