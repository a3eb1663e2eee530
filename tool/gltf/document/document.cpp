#include "gltf/document/document.h"

#include "base/json.h"
#include "gltf/document/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <system_error>
#include <utility>

namespace glint::gltf {

namespace {

// ---- GLB and JSON ----

// tinygltf's own functions are not used. They refuse a GLB whose binary chunk is empty or no multiple of 4
// bytes long, which exporters write, and copy that chunk. Its parser refuses a document for a number such as
// 1e400 in the extras, and its messages name no place.

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
constexpr const char* kEnvironment = "name a scene, and give the picture with --environment";
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
    {"#?RADIANCE"sv, 0, "a picture (Radiance HDR)", kEnvironment},
    {"#?RGBE"sv, 0, "a picture (Radiance HDR)", kEnvironment},
    {"\x76\x2F\x31\x01"sv, 0, "a picture (OpenEXR)", kEnvironment},
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
std::uint32_t readWord(ByteView bytes, std::size_t offset) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, sizeof word);
    return word;
}

Result<ByteView> glbBody(Document& document, ByteView bytes) {
    if (bytes.size() < kGlbHeaderSize) {
        return document.error("glb-length", "", "is shorter than the header of a GLB", kExportHint);
    }
    if (const std::uint32_t version = readWord(bytes, 4); version != 2) {
        return document.error("glb-version", "", fmt::format("is a GLB of version {}", version),
                              "convert the file to glTF 2.0");
    }
    const std::size_t length = readWord(bytes, 8);
    if (length > bytes.size() || length < kGlbHeaderSize) {
        return document.error(
            "glb-length", "",
            fmt::format("its GLB header says {} bytes, the file has {}", length, bytes.size()), kExportHint);
    }
    if (length < bytes.size()) {
        document.warn("glb-length", "",
                      fmt::format("{} bytes after the end of the GLB are ignored", bytes.size() - length));
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

struct Container {
    ByteView json;
    std::optional<ByteView> binary;  // the BIN chunk
};

// Splits a GLB. A file without GLB's magic number is JSON as a whole. The spans view `bytes`.
Result<Container> splitContainer(Document& document, ByteView bytes) {
    if (bytes.size() < sizeof kGlbMagic || readWord(bytes, 0) != kGlbMagic) {
        return Container{bytes, std::nullopt};
    }
    GLINT_TRY(const auto body, glbBody(document, bytes));
    Container container;
    bool hasJson = false;
    for (auto rest = body; !rest.empty();) {
        if (rest.size() < kChunkHeaderSize) {
            return document.error("glb-chunk", "", "ends within the header of a GLB chunk", kExportHint);
        }
        const std::size_t length = readWord(rest, 0);
        const std::uint32_t type = readWord(rest, 4);
        rest = rest.subspan(kChunkHeaderSize);
        if (length > rest.size()) {
            return document.error("glb-chunk", "",
                                  fmt::format("a GLB chunk of {} bytes goes beyond the end", length),
                                  kExportHint);
        }
        if (hasJson == (type == kJsonChunk)) {
            return document.error(
                "glb-chunk", "", hasJson ? "has more than one JSON chunk" : "its first GLB chunk is not JSON",
                kExportHint);
        }
        if (length % 4 != 0) {
            document.warn(
                "glb-chunk", "",
                fmt::format("a GLB chunk of {} bytes does not end at a multiple of 4 bytes", length),
                kExportHint);
        }
        if (type == kJsonChunk) {
            container.json = rest.first(length);
            hasJson = true;
        } else if (type == kBinaryChunk && !container.binary) {
            container.binary = rest.first(length);
        } else {
            document.warn("glb-chunk", "", fmt::format("a GLB chunk of type {:#010x} is ignored", type));
        }
        rest = rest.subspan(length);
    }
    if (!hasJson) {
        return document.error("glb-chunk", "", "has no JSON chunk", kExportHint);
    }
    return container;
}

// A number that a double can't hold becomes a text that isHugeNumber() recognises, so that it does not matter
// where nothing reads it.
Result<Json> parseJson(Document& document, ByteView bytes) {
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.find_first_not_of(kWhiteSpace) == std::string_view::npos) {
        return document.error(
            "scene-empty", "", text.empty() ? "is empty" : "holds nothing but white space",
            "name a .gltf or .glb file that holds a scene; this one was perhaps not written to its end");
    }
    if (const ForeignKind* const kind = findForeign(text)) {
        return document.error("scene-format", "", fmt::format("is {}, not a glTF scene", kind->name),
                              kind->hint);
    }
    // Some exporters pad the JSON of a GLB with zeros.
    if (const std::size_t zeros = text.size() - 1 - text.find_last_not_of('\0'); zeros > 0) {
        text.remove_suffix(zeros);
        document.warn("json-padding", "", fmt::format("{} zero bytes after the JSON are ignored", zeros));
    }
    // The parser would take a zero byte for the end.
    if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos) {
        return document.error("json-syntax", "", fmt::format("is no valid JSON: byte {} is zero", zero),
                              kCheckWhole);
    }
    if (base::nestsTooDeep(bytes)) {
        return document.error("json-depth", "",
                              fmt::format("its JSON is nested more than {} levels deep", base::kMaxJsonDepth),
                              "remove the deeply nested extras");
    }
    try {
        Json root = parseLeniently(text);
        if (!root.is_object()) {
            return document.error("json-type", "", "its JSON is no object", "check that this is a glTF file");
        }
        return root;
    } catch (const Json::exception& exception) {
        // The library starts its messages with "[json.exception.type.number] ".
        const std::string_view message(exception.what());
        const std::size_t tag = message.find("] ");
        return document.error(
            "json-syntax", "",
            fmt::format("is no valid JSON: {}", message.substr(tag == std::string_view::npos ? 0 : tag + 2)),
            kCheckWhole);
    }
}

// ---- Files ----

namespace fs = std::filesystem;

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

// Returns why the file that a decoded URI names must not be opened, or an empty text if it may be. Examines
// only the text.
std::string whyUnsafe(std::string_view uri, std::string_view decoded) {
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
    return {};
}

// ---- The document ----

Status checkVersion(Document& document, const Json& root) {
    const Json* asset = find(root, "asset");
    const Json* version = asset == nullptr ? nullptr : find(*asset, "version");
    if (version == nullptr || !version->is_string()) {
        return document.error("asset-version", "/asset", "has no \"version\"",
                              "check that this is a glTF 2.0 file");
    }
    const Json* minVersion = find(*asset, "minVersion");
    const bool hasMin = minVersion != nullptr && minVersion->is_string();
    const auto target = version->get<std::string>();
    if (hasMin && *minVersion != "2.0") {
        return document.error("asset-version", "/asset/minVersion",
                              fmt::format("needs glTF {}; Glint reads 2.0", minVersion->get<std::string>()),
                              "convert the file to glTF 2.0");
    }
    if (!target.starts_with("2.")) {
        return document.error("asset-version", "/asset/version",
                              fmt::format("needs glTF {}; Glint reads 2.0", target),
                              "convert the file to glTF 2.0");
    }
    const bool isNumber = target.size() > 2 && std::ranges::all_of(target.substr(2), [](unsigned char c) {
                              return std::isdigit(c) != 0;
                          });
    if (!isNumber) {
        document.warn("asset-version", "/asset/version",
                      fmt::format("\"{}\" is no version; it is read as 2.0", target), "write 2.0");
    }
    return okStatus();
}

}  // namespace

Document::Document(const std::filesystem::path& path, const ImportOptions& options)
    : name_(path.string()),
      options_(options),
      vertices_(options.maxVertices),
      unpackedBytes_(options.maxFileBytes),
      fileBytes_(options.maxFileBytes) {}

Result<std::unique_ptr<Document>> Document::open(const std::filesystem::path& path,
                                                 const ImportOptions& options) {
    std::unique_ptr<Document> document(new Document(path, options));
    GLINT_TRY_DO(document->parse());
    return document;
}

Result<std::unique_ptr<Document>> Document::open(const MaterialSet& set, const ImportOptions& options) {
    std::unique_ptr<Document> document(new Document(set.path, options));
    GLINT_TRY_DO(checkMaterialSet(set));
    GLINT_TRY_DO(document->expand(set));
    GLINT_TRY_DO(document->check());
    return document;
}

Status Document::parse() {
    GLINT_TRY(file_, readFile(name_));
    GLINT_TRY(const auto container, splitContainer(*this, file_));
    binary_ = container.binary;
    if (isMaterialX(container.json)) {
        GLINT_TRY(const auto set, readMaterialX(container.json, name_, *options_.materialModel));
        GLINT_TRY_DO(expand(set));
        return check();
    }
    GLINT_TRY(json_, parseJson(*this, container.json));
    if (isMaterialList(json_)) {
        GLINT_TRY(const auto set, readMaterialList(container.json, name_));
        GLINT_TRY_DO(expand(set));
    }
    return check();
}

Status Document::expand(const MaterialSet& set) {
    GLINT_TRY(auto expanded, expandMaterials(set, *options_.materialModel));
    json_ = std::move(expanded.document);
    file_ = std::move(expanded.buffer);
    binary_ = file_;
    places_ = std::move(expanded.places);
    edited_ = std::move(expanded.edited);
    return okStatus();
}

Status Document::check() {
    GLINT_TRY_DO(checkVersion(*this, json_));
    GLINT_TRY_DO(checkExtensions(*this, json_));
    if (const Status status = checkDocument(json_, *options_.materialModel); !status) {
        const Diagnostic& failure = status.error();
        return error(failure.id, failure.where, failure.message, failure.hint);
    }
    warnOfBrokenRules(*this, json_);
    const std::vector<bool> used = usedAccessors(json_, *options_.materialModel);
    if (std::string problem = readModel(json_, used, model_); !problem.empty()) {
        return error("gltf", "", std::move(problem),
                     "export the scene again; the Khronos glTF validator explains the rules");
    }
    if (!binary_) {
        file_ = {};  // it was text, and nobody reads it any more
    }
    buffers_.resize(arrayMember(json_, "buffers").size());
    unpackedViews_.resize(model_.bufferViews.size());
    return okStatus();
}

bool Document::requiresExtension(std::string_view extension) const {
    return std::ranges::find(model_.extensionsRequired, extension) != model_.extensionsRequired.end();
}

Result<ByteView> Document::bufferView(int index) {
    const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(index)];
    const std::string pointer = fmt::format("/bufferViews/{}", index);
    for (const char* const name : kMeshoptExtensions) {
        if (const Value* const extension = extensionOf(view.extensions, name)) {
            return unpackedView(index, *extension, pointer);
        }
    }
    return bufferRange(view.buffer, view.byteOffset, view.byteLength, pointer);
}

Result<ByteView> Document::unpackedView(int index, const Value& extension, const std::string& pointer) {
    const auto slot = static_cast<std::size_t>(index);
    std::optional<base::Bytes>& unpacked = unpackedViews_[slot];
    if (!unpacked) {
        GLINT_TRY(const auto packed,
                  bufferRange(memberOr(extension, "buffer", -1),
                              memberOr<std::uint64_t>(extension, "byteOffset", 0),
                              memberOr<std::uint64_t>(extension, "byteLength", 0), pointer));
        GLINT_TRY(unpacked,
                  unpackMeshopt(*this, extension, pointer, packed, model_.bufferViews[slot].byteLength));
    }
    return ByteView(*unpacked);
}

Result<ByteView> Document::bufferRange(int index, std::uint64_t offset, std::uint64_t length,
                                       const std::string& pointer) {
    GLINT_TRY(const auto bytes, buffer(index));
    if (offset > bytes.size() || length > bytes.size() - offset) {
        return error("buffer-view-range", pointer,
                     fmt::format("bytes {} to {} go beyond the {} bytes of /buffers/{}", offset,
                                 offset + length, bytes.size(), index),
                     "the file is damaged: export it again");
    }
    return bytes.subspan(offset, length);
}

Result<ByteView> Document::buffer(int index) {
    const auto slot = static_cast<std::size_t>(index);
    const Json& json = json_["buffers"][slot];
    const std::string pointer = fmt::format("/buffers/{}", index);
    const auto length = json["byteLength"].get<std::uint64_t>();
    ByteView bytes;
    if (!json.contains("uri") && index == 0 && binary_) {
        bytes = *binary_;
    } else {
        if (!buffers_[slot]) {
            GLINT_TRY(buffers_[slot], loadBuffer(json, pointer));
        }
        bytes = *buffers_[slot];
    }
    if (bytes.size() < length) {
        return error("buffer-size", pointer,
                     fmt::format("has {} bytes of data, {} are announced", bytes.size(), length),
                     "the buffer's file is damaged or another one: export the scene again");
    }
    return bytes.first(length);
}

Result<base::Bytes> Document::loadBuffer(const Json& buffer, const std::string& pointer) {
    if (const Json* const uri = find(buffer, "uri")) {
        return readUri(uri->get_ref<const std::string&>(), pointer);
    }
    for (const char* const name : kMeshoptExtensions) {
        if (findExtension(buffer, name) != nullptr) {
            return error(
                "buffer-data", pointer,
                "is a fallback that holds no data, but a buffer view without compressed data is read "
                "from it",
                "export the scene again");
        }
    }
    return error("buffer-external", pointer,
                 "has neither a \"uri\" nor the binary chunk of a GLB: its data is not in the file",
                 "export the scene with its data");
}

Result<base::Bytes> Document::readUri(const std::string& uri, const std::string& pointer) {
    const std::string place = pointer + "/uri";
    if (!isDataUri(uri)) {
        return readRelative(uri, place);
    }
    std::optional<base::Bytes> data = decodeDataUri(uri);
    if (!data) {
        return error("data-uri", place, "is no valid data URI", "export the scene again");
    }
    return std::move(*data);
}

Result<base::Bytes> Document::readRelative(const std::string& uri, const std::string& pointer) {
    const std::string decoded = percentDecode(uri);
    const auto refuse = [&](std::string_view why) {
        return error("uri-unsafe", pointer, fmt::format("the URI \"{}\" {}", uri, why),
                     "put the file into the scene's folder and refer to it by a relative path");
    };
    if (const std::string why = whyUnsafe(uri, decoded); !why.empty()) {
        return refuse(why);
    }
    const fs::path folder = fs::path(name_).parent_path();
    const fs::path relative = fs::path(decoded).lexically_normal();
    if (relative.is_absolute() || *relative.begin() == "..") {
        return refuse("leaves the scene's folder");
    }
    const fs::path path = folder / relative;
    if (options_.strictPaths && !liesWithin(path, folder)) {
        return refuse("leaves the scene's folder through a symbolic link, which strict paths forbid");
    }
    Result<base::Bytes> bytes = readFile(path);
    if (!bytes) {
        const Diagnostic& failure = bytes.error();
        return error(failure.id, pointer, fmt::format("\"{}\": {}", path.string(), failure.message),
                     failure.hint.empty() ? "check the file and the URI" : failure.hint);
    }
    return bytes;
}

Result<base::Bytes> Document::readFile(const fs::path& path) {
    Result<base::Bytes> bytes = base::readFile(path, fileBytes_);
    if (!bytes) {
        return bytes;
    }
    fileBytes_ -= std::min<std::uint64_t>(fileBytes_, bytes->size());
    const std::string name = path.string();
    if (std::ranges::find(files_, name, &SourceFile::path) == files_.end()) {
        files_.push_back({name, bytes->size(), base::hashBytes(*bytes)});
    }
    return bytes;
}

std::string Document::where(std::string_view pointer) const {
    // The longest part of the pointer that stands elsewhere in the list counts.
    for (std::size_t end = pointer.size(); !places_.empty() && end > 0 && end != std::string_view::npos;
         end = pointer.rfind('/', end - 1)) {
        const auto found = places_.find(pointer.substr(0, end));
        if (found != places_.end()) {
            return fmt::format("{}#{}{}", name_, found->second, pointer.substr(end));
        }
    }
    return pointer.empty() ? name_ : fmt::format("{}#{}", name_, pointer);
}

Diagnostic Document::error(std::string id, std::string_view pointer, std::string message,
                           std::string hint) const {
    return makeError(std::move(id), where(pointer), std::move(message), std::move(hint));
}

void Document::warn(std::string id, std::string_view pointer, std::string message, std::string hint) {
    warnings_.push_back(makeWarning(std::move(id), where(pointer), std::move(message), std::move(hint)));
}

void Document::note(std::string id, std::string_view pointer, std::string message, std::string hint) {
    warnings_.push_back({Severity::Note, std::move(id), where(pointer), std::move(message), std::move(hint)});
}

Status Document::chargeVertices(std::uint64_t count, std::string_view pointer) {
    return vertices_.take(count) ? okStatus()
                                 : error("vertex-limit", pointer,
                                         fmt::format("with its {} elements the scene passes the limit of {}",
                                                     count, options_.maxVertices),
                                         "split the scene, or raise ImportOptions::maxVertices");
}

bool Document::chargeImage(std::uint64_t bytes) {
    // A hostile file can name one small image many times, and an image of one colour takes a few bytes
    // whatever its size. A scene's images may therefore decode to kFreeImageBytes plus kMaxImageRatio times
    // the bytes of its files, but to kMaxImageBytes at most. Photographs stay below 100 : 1, and drawings
    // seldom reach 1000 : 1.
    constexpr std::uint64_t kFreeImageBytes = 1ULL << 28;
    constexpr std::uint64_t kMaxImageRatio = 1024;
    constexpr std::uint64_t kMaxImageBytes = 1ULL << 33;
    std::uint64_t fileBytes = 0;
    for (const SourceFile& file : files()) {
        fileBytes += file.bytes;
    }
    // This can't overflow, because the contents of the files are below 2^54 bytes, as memory is.
    const std::uint64_t limit = std::min(kFreeImageBytes + kMaxImageRatio * fileBytes, kMaxImageBytes);
    const bool isEnough = imageBytes_ <= limit && bytes <= limit - imageBytes_;
    imageBytes_ += isEnough ? bytes : 0;
    return isEnough;
}

}  // namespace glint::gltf
