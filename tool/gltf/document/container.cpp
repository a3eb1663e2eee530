#include "gltf/document/container.h"

#include "base/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <string_view>

namespace glint::gltf {

namespace {

constexpr std::uint32_t kGlbMagic = 0x46546C67;  // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr std::size_t kGlbHeaderSize = 12;
constexpr std::size_t kChunkHeaderSize = 8;

constexpr const char* kExportHint = "the file is damaged or incomplete: export or download it again";
constexpr const char* kCheckWhole = "check that this is a glTF file, and whole";

// A kind of file that people name in place of a scene, which its first bytes tell.
struct ForeignKind {
    std::string_view magic;
    std::size_t offset;
    const char* name;
    const char* hint;
};

constexpr const char* kNameScene = "name the .gltf or .glb file of a scene";
constexpr const char* kConvert = "convert it to glTF 2.0, with Blender for instance";
constexpr const char* kDownload = "download the scene itself";

constexpr std::string_view kWhiteSpace = " \t\r\n";

using namespace std::string_view_literals;

constexpr ForeignKind kForeignKinds[] = {
    {"\x89PNG"sv, 0, "a picture (PNG)", kNameScene},
    {"\xFF\xD8\xFF"sv, 0, "a picture (JPEG)", kNameScene},
    {"WEBP"sv, 8, "a picture (WebP)", kNameScene},
    {"ftypavif"sv, 4, "a picture (AVIF)", kNameScene},
    {"GIF8"sv, 0, "a picture (GIF)", kNameScene},
    {"BM"sv, 0, "a picture (BMP)", kNameScene},
    {"II*\0"sv, 0, "a picture (TIFF)", kNameScene},
    {"MM\0*"sv, 0, "a picture (TIFF)", kNameScene},
    {"\xABKTX"sv, 0, "a texture (KTX)", kNameScene},
    {"DDS "sv, 0, "a texture (DDS)", kNameScene},
    {"#?RADIANCE"sv, 0, "a picture (Radiance HDR)", "name a scene, and give the picture with --environment"},
    {"#?RGBE"sv, 0, "a picture (Radiance HDR)", "name a scene, and give the picture with --environment"},
    {"\x76\x2F\x31\x01"sv, 0, "a picture (OpenEXR)", "name a scene, and give the picture with --environment"},
    {"Kaydara FBX Binary"sv, 0, "an FBX scene", kConvert},
    {"BLENDER"sv, 0, "a Blender scene", "export it from Blender as glTF 2.0"},
    {"PXR-USDC"sv, 0, "a USD scene", kConvert},
    {"#usda"sv, 0, "a USD scene", kConvert},
    {"ply"sv, 0, "a PLY mesh", kConvert},
    {"<?xml"sv, 0, "an XML file (a COLLADA scene perhaps)", kConvert},
    {"<!DOCTYPE"sv, 0, "a web page", kDownload},
    {"<!doctype"sv, 0, "a web page", kDownload},
    {"<html"sv, 0, "a web page", kDownload},
    {"version https://git-lfs"sv, 0, "a pointer of Git LFS", "fetch the file itself: git lfs pull"},
    {"PK\x03\x04"sv, 0, "a ZIP archive", "unpack it, and name the .gltf or .glb file in it"},
    {"\x1F\x8B"sv, 0, "a gzip archive", "unpack it first"},
    {"%PDF"sv, 0, "a PDF document", kNameScene},
    {"\xFF\xFE"sv, 0, "text in UTF-16", "save it in UTF-8"},
    {"\xFE\xFF"sv, 0, "text in UTF-16", "save it in UTF-8"},
    {"\x7F"
     "ELF"sv,
     0, "a program", kNameScene},
};

const ForeignKind* findForeign(std::string_view text) {
    if (text[text.find_first_not_of(kWhiteSpace)] == '{') {
        return nullptr;
    }
    const auto* const found = std::ranges::find_if(kForeignKinds, [&](const ForeignKind& kind) {
        return text.size() > kind.offset && text.substr(kind.offset).starts_with(kind.magic);
    });
    return found == std::end(kForeignKinds) ? nullptr : found;
}

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

bool isNumberCharacter(char c) {
    return (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.' || c == 'e' || c == 'E';
}

// Puts quotes and a mark about numbers that a double can't hold.
std::string quoteHugeNumbers(std::string_view json) {
    std::string text;
    bool inString = false;
    for (std::size_t i = 0; i < json.size();) {
        std::size_t end = i + 1;
        if (!inString && (json[i] == '-' || (json[i] >= '0' && json[i] <= '9'))) {
            while (end < json.size() && isNumberCharacter(json[end])) {
                ++end;
            }
            const std::string number(json.substr(i, end - i));
            text += std::isinf(std::strtod(number.c_str(), nullptr))
                        ? fmt::format("\"\\u0000{}{}\"", kHugeNumberMark.substr(1), number)
                        : number;
        } else {
            end += inString && json[i] == '\\' && end < json.size() ? 1 : 0;
            inString = inString != (json[i] == '"');
            text += json.substr(i, end - i);
        }
        i = end;
    }
    return text;
}

// JSON does not bound its numbers, but the library throws where a double can't hold one.
Json parseLeniently(std::string_view text) {
    try {
        return Json::parse(text);
    } catch (const Json::out_of_range&) {
        return Json::parse(quoteHugeNumbers(text));
    }
}

}  // namespace

Result<Container> splitContainer(std::span<const std::uint8_t> bytes, const std::string& file,
                                 std::vector<Diagnostic>& warnings) {
    if (bytes.size() < sizeof kGlbMagic || readWord(bytes, 0) != kGlbMagic) {
        return Container{bytes, std::nullopt};
    }
    GLINT_TRY(const auto body, glbBody(bytes, file, warnings));
    Container container;
    bool hasJson = false;
    for (auto rest = body; !rest.empty();) {
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

Result<Json> parseJson(std::span<const std::uint8_t> bytes, const std::string& file,
                       std::vector<Diagnostic>& warnings) {
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.find_first_not_of(kWhiteSpace) == std::string_view::npos) {
        return makeError(
            "scene-empty", file, text.empty() ? "is empty" : "holds nothing but white space",
            "name a .gltf or .glb file that holds a scene; this one was perhaps not written to its end");
    }
    if (const ForeignKind* const kind = findForeign(text)) {
        return makeError("scene-format", file, fmt::format("is {}, not a glTF scene", kind->name),
                         kind->hint);
    }
    // Some exporters pad the JSON of a GLB with zeros.
    if (const std::size_t zeros = text.size() - 1 - text.find_last_not_of('\0'); zeros > 0) {
        text.remove_suffix(zeros);
        warnings.push_back(makeWarning("json-padding", file,
                                       fmt::format("{} zero bytes after the JSON are ignored", zeros)));
    }
    // The parser would take a zero byte for the end.
    if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos) {
        return makeError("json-syntax", file, fmt::format("is no valid JSON: byte {} is zero", zero),
                         kCheckWhole);
    }
    if (base::nestsTooDeep(bytes)) {
        return makeError("json-depth", file,
                         fmt::format("its JSON is nested more than {} levels deep", base::kMaxJsonDepth),
                         "remove the deeply nested extras");
    }
    try {
        Json root = parseLeniently(text);
        if (!root.is_object()) {
            return makeError("json-type", file, "its JSON is no object", "check that this is a glTF file");
        }
        return root;
    } catch (const Json::exception& exception) {
        // The library starts its messages with "[json.exception.type.number] ".
        const std::string_view message(exception.what());
        const std::size_t tag = message.find("] ");
        return makeError(
            "json-syntax", file,
            fmt::format("is no valid JSON: {}", message.substr(tag == std::string_view::npos ? 0 : tag + 2)),
            kCheckWhole);
    }
}

}  // namespace glint::gltf
