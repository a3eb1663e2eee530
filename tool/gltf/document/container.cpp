#include "gltf/document/container.h"

#include "base/json_depth.h"

#include <fmt/format.h>

#include <cstring>
#include <string_view>

namespace glint::gltf {

namespace {

constexpr std::uint32_t kGlbMagic = 0x46546C67;  // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr std::size_t kGlbHeaderSize = 12;
constexpr std::size_t kChunkHeaderSize = 8;

constexpr const char* kExportHint = "the file is damaged or incomplete: export or download it again";

// Reads a little-endian word. All machines that Glint supports are little-endian.
std::uint32_t readWord(std::span<const std::uint8_t> bytes, std::size_t offset) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, sizeof word);
    return word;
}

Result<std::span<const std::uint8_t>> glbBody(std::span<const std::uint8_t> bytes, const std::string& file,
                                              std::vector<Diagnostic>& warnings) {
    if (bytes.size() < kGlbHeaderSize) {
        return makeError("glb-length", file, "is shorter than the header of a GLB", kExportHint);
    }
    if (const std::uint32_t version = readWord(bytes, 4); version != 2) {
        return makeError("glb-version", file, fmt::format("is a GLB of version {}", version),
                         "convert the file to glTF 2.0");
    }
    const std::size_t length = readWord(bytes, 8);
    if (length > bytes.size() || length < kGlbHeaderSize) {
        return makeError("glb-length", file,
                         fmt::format("its GLB header says {} bytes, the file has {}", length, bytes.size()),
                         kExportHint);
    }
    if (length < bytes.size()) {
        warnings.push_back(
            makeWarning("glb-length", file,
                        fmt::format("{} bytes after the end of the GLB are ignored", bytes.size() - length)));
    }
    return bytes.subspan(kGlbHeaderSize, length - kGlbHeaderSize);
}

}  // namespace

Result<Container> splitContainer(std::span<const std::uint8_t> bytes, const std::string& file,
                                 std::vector<Diagnostic>& warnings) {
    if (bytes.size() < sizeof kGlbMagic || readWord(bytes, 0) != kGlbMagic) {
        return Container{bytes, std::nullopt};
    }
    const auto body = glbBody(bytes, file, warnings);
    if (!body) {
        return body.error();
    }
    Container container;
    bool hasJson = false;
    for (auto rest = *body; !rest.empty();) {
        if (rest.size() < kChunkHeaderSize) {
            return makeError("glb-chunk", file, "ends within the header of a GLB chunk", kExportHint);
        }
        const std::size_t length = readWord(rest, 0);
        const std::uint32_t type = readWord(rest, 4);
        rest = rest.subspan(kChunkHeaderSize);
        if (length > rest.size()) {
            return makeError("glb-chunk", file,
                             fmt::format("a GLB chunk of {} bytes goes beyond the end", length), kExportHint);
        }
        if (hasJson == (type == kJsonChunk)) {
            return makeError("glb-chunk", file,
                             hasJson ? "has more than one JSON chunk" : "its first GLB chunk is not JSON",
                             kExportHint);
        }
        if (length % 4 != 0) {
            warnings.push_back(makeWarning(
                "glb-chunk", file,
                fmt::format("a GLB chunk of {} bytes does not end at a multiple of 4 bytes", length),
                kExportHint));
        }
        if (type == kJsonChunk) {
            container.json = rest.first(length);
            hasJson = true;
        } else if (type == kBinaryChunk && !container.binary) {
            container.binary = rest.first(length);
        } else {
            warnings.push_back(
                makeWarning("glb-chunk", file, fmt::format("a GLB chunk of type {:#010x} is ignored", type)));
        }
        rest = rest.subspan(length);
    }
    if (!hasJson) {
        return makeError("glb-chunk", file, "has no JSON chunk", kExportHint);
    }
    return container;
}

Result<Json> parseJson(std::span<const std::uint8_t> bytes, const std::string& file) {
    if (base::nestsTooDeep(bytes)) {
        return makeError("json-depth", file,
                         fmt::format("its JSON is nested more than {} levels deep", base::kMaxJsonDepth),
                         "remove the deeply nested extras");
    }
    try {
        Json root = Json::parse(bytes.begin(), bytes.end());
        if (!root.is_object()) {
            return makeError("json-type", file, "its JSON is no object", "check that this is a glTF file");
        }
        return root;
    } catch (const Json::exception& exception) {
        // The library starts its messages with "[json.exception.type.number] ".
        const std::string_view text(exception.what());
        const std::size_t tag = text.find("] ");
        return makeError(
            "json-syntax", file,
            fmt::format("is no valid JSON: {}", text.substr(tag == std::string_view::npos ? 0 : tag + 2)),
            "check that this is a glTF file, and whole");
    }
}

}  // namespace glint::gltf
