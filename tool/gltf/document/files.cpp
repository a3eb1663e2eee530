#include "gltf/document/files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <utility>

namespace glint::gltf {

namespace {

constexpr std::string_view kDataScheme = "data:";

// The number that each character stands for, or -1.
constexpr std::array<int, 256> kBase64Digits = [] {
    std::array<int, 256> digits{};
    digits.fill(-1);
    // The first alphabet is the usual one, and the second the URL-safe one (RFC 4648, sections 4 and 5).
    for (const std::string_view alphabet :
         {"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/",
          "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"}) {
        for (std::size_t i = 0; i < alphabet.size(); ++i) {
            digits[static_cast<std::uint8_t>(alphabet[i])] = static_cast<int>(i);
        }
    }
    return digits;
}();

// White space is skipped, as browsers do.
std::optional<base::Bytes> decodeBase64(std::string_view text) {
    const auto isSpace = [](char c) {
        return std::string_view(" \t\n\f\r").find(c) != std::string_view::npos;
    };
    while (!text.empty() && (text.back() == '=' || isSpace(text.back()))) {
        text.remove_suffix(1);
    }
    base::Bytes bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int bitCount = 0;
    for (const char c : text) {
        if (isSpace(c)) {
            continue;
        }
        const int digit = kBase64Digits[static_cast<std::uint8_t>(c)];
        if (digit < 0) {
            return std::nullopt;
        }
        bits = (bits << 6U | static_cast<std::uint32_t>(digit)) & 0xFFFFFFU;
        bitCount += 6;
        if (bitCount >= 8) {
            bitCount -= 8;
            bytes.push_back(static_cast<std::uint8_t>(bits >> static_cast<unsigned>(bitCount)));
        }
    }
    // One digit after the last whole group would hold six bits, which is less than a byte.
    return bitCount == 6 ? std::nullopt : std::optional(std::move(bytes));
}

bool equalsIgnoringCase(std::string_view text, std::string_view lower) {
    return std::ranges::equal(text, lower, [](char c, char expected) {
        return std::tolower(static_cast<unsigned char>(c)) == expected;
    });
}

// Whether a header ends in ";base64", where spaces may follow the semicolon.
bool endsInBase64(std::string_view header) {
    constexpr std::string_view kBase64 = "base64";
    if (header.size() < kBase64.size() ||
        !equalsIgnoringCase(header.substr(header.size() - kBase64.size()), kBase64)) {
        return false;
    }
    const std::string_view rest = header.substr(0, header.size() - kBase64.size());
    return rest.substr(0, rest.find_last_not_of(' ') + 1).ends_with(';');
}

}  // namespace

bool isDataUri(std::string_view uri) {
    return equalsIgnoringCase(uri.substr(0, kDataScheme.size()), kDataScheme);
}

std::optional<base::Bytes> decodeDataUri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (!isDataUri(uri) || comma == std::string_view::npos) {
        return std::nullopt;
    }
    const std::string_view header = uri.substr(kDataScheme.size(), comma - kDataScheme.size());
    const std::string_view payload = uri.substr(comma + 1);
    const bool isBase64 = endsInBase64(header);
    if (isBase64 && payload.find('%') == std::string_view::npos) {
        return decodeBase64(payload);  // without a copy of much data
    }
    // '+', '/' and '=' of base64 may be percent-encoded, too.
    const std::string decoded = percentDecode(payload);
    return isBase64 ? decodeBase64(decoded) : base::Bytes(decoded.begin(), decoded.end());
}

std::string percentDecode(std::string_view text) {
    std::string decoded;
    decoded.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::string_view digits = text.substr(i + 1, 2);
        std::uint8_t byte = 0;
        if (text[i] == '%' && digits.size() == 2 &&
            std::from_chars(digits.data(), digits.data() + 2, byte, 16).ptr == digits.data() + 2) {
            decoded += static_cast<char>(byte);
            i += 2;
        } else {
            decoded += text[i];
        }
    }
    return decoded;
}

}  // namespace glint::gltf
