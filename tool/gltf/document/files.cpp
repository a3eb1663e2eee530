#include "gltf/document/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>
#include <utility>

namespace glint::gltf {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kDataScheme = "data:";

int hexDigit(char c) {
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

int base64Digit(char c) {
    if (c >= 'A' && c <= 'Z') {
        return c - 'A';
    }
    if (c >= 'a' && c <= 'z') {
        return c - 'a' + 26;
    }
    if (c >= '0' && c <= '9') {
        return c - '0' + 52;
    }
    // The second of each pair is the URL-safe alphabet (RFC 4648, section 5).
    if (c == '+' || c == '-') {
        return 62;
    }
    return c == '/' || c == '_' ? 63 : -1;
}

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
        const int digit = base64Digit(c);
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

// Removes ";base64" from the end of a header, where spaces may follow the semicolon. Returns whether it was
// there.
bool removeBase64(std::string_view& header) {
    constexpr std::string_view kBase64 = "base64";
    if (header.size() < kBase64.size() ||
        !equalsIgnoringCase(header.substr(header.size() - kBase64.size()), kBase64)) {
        return false;
    }
    std::string_view rest = header.substr(0, header.size() - kBase64.size());
    rest = rest.substr(0, rest.find_last_not_of(' ') + 1);
    if (!rest.ends_with(';')) {
        return false;
    }
    header = rest.substr(0, rest.size() - 1);
    return true;
}

bool hasScheme(std::string_view uri) {
    const std::size_t colon = uri.find(':');
    return colon != std::string_view::npos && colon < uri.find_first_of("/?#");
}

// Returns whether `path` lies below `folder` after following links.
bool liesWithin(const fs::path& path, const fs::path& folder) {
    std::error_code error;
    const fs::path canonicalFolder = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
    if (error) {
        return false;
    }
    const fs::path canonicalPath = fs::weakly_canonical(path, error);
    if (error) {
        return false;
    }
    const auto [end, ignored] = std::mismatch(canonicalFolder.begin(), canonicalFolder.end(),
                                              canonicalPath.begin(), canonicalPath.end());
    return end == canonicalFolder.end();
}

}  // namespace

bool isDataUri(std::string_view uri) {
    return equalsIgnoringCase(uri.substr(0, kDataScheme.size()), kDataScheme);
}

std::optional<DataUri> decodeDataUri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (!isDataUri(uri) || comma == std::string_view::npos) {
        return std::nullopt;
    }
    std::string_view header = uri.substr(kDataScheme.size(), comma - kDataScheme.size());
    const std::string_view payload = uri.substr(comma + 1);
    const bool base64 = removeBase64(header);
    DataUri data{std::string(header.substr(0, header.find(';'))), {}};
    if (base64) {
        // '+', '/' and '=' may be percent-encoded.
        const bool encoded = payload.find('%') != std::string_view::npos;
        std::optional<base::Bytes> bytes = decodeBase64(encoded ? percentDecode(payload) : payload);
        if (!bytes) {
            return std::nullopt;
        }
        data.bytes = std::move(*bytes);
    } else {
        const std::string decoded = percentDecode(payload);
        data.bytes.assign(decoded.begin(), decoded.end());
    }
    return data;
}

std::string percentDecode(std::string_view text) {
    std::string decoded;
    decoded.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && text.size() - i > 2) {
            const int high = hexDigit(text[i + 1]);
            const int low = hexDigit(text[i + 2]);
            if (high >= 0 && low >= 0) {
                decoded += static_cast<char>(high * 16 + low);
                i += 2;
                continue;
            }
        }
        decoded += text[i];
    }
    return decoded;
}

std::optional<std::string> whyUnsafe(std::string_view uri, std::string_view decoded) {
    if (decoded.empty()) {
        return "is empty";
    }
    if (hasScheme(uri)) {
        return "has a scheme; only relative paths and data URIs are read";
    }
    if (decoded.front() == '/' || decoded.front() == '\\') {
        return "is an absolute path";
    }
    if (decoded.find('\0') != std::string_view::npos) {
        return "holds a zero byte";
    }
    return std::nullopt;
}

FileSource::FileSource(const fs::path& scenePath, std::uint64_t maxBytes, OuterLinks links)
    : scenePath_(scenePath), bytesLeft_(maxBytes), links_(links) {}

Result<base::Bytes> FileSource::read(const fs::path& path) {
    Result<base::Bytes> bytes = base::readFile(path, bytesLeft_);
    if (!bytes) {
        return bytes;
    }
    bytesLeft_ -= std::min<std::uint64_t>(bytesLeft_, bytes->size());
    const std::string name = path.string();
    const bool known =
        std::any_of(files_.begin(), files_.end(), [&](const SourceFile& file) { return file.path == name; });
    if (!known) {
        files_.push_back({name, bytes->size(), base::hashBytes(*bytes)});
    }
    return bytes;
}

Result<base::Bytes> FileSource::readScene() {
    return read(scenePath_);
}

Result<base::Bytes> FileSource::readRelative(std::string_view uri, const std::string& where) {
    const std::string decoded = percentDecode(uri);
    const auto refuse = [&](std::string_view why) {
        return makeError("uri-unsafe", where, fmt::format("the URI \"{}\" {}", uri, why),
                         "put the file into the scene's folder and refer to it by a relative path");
    };
    if (const auto why = whyUnsafe(uri, decoded)) {
        return refuse(*why);
    }
    const fs::path folder = scenePath_.parent_path();
    const fs::path relative = fs::path(decoded).lexically_normal();
    if (relative.is_absolute() || *relative.begin() == "..") {
        return refuse("leaves the scene's folder");
    }
    const fs::path path = folder / relative;
    if (links_ == OuterLinks::Refuse && !liesWithin(path, folder)) {
        return refuse("leaves the scene's folder through a symbolic link, which strict paths forbid");
    }
    Result<base::Bytes> bytes = read(path);
    if (!bytes) {
        const Diagnostic& error = bytes.error();
        return makeError(error.id, where, fmt::format("\"{}\": {}", path.string(), error.message),
                         error.hint.empty() ? "check the file and the URI" : error.hint);
    }
    return bytes;
}

}  // namespace glint::gltf
