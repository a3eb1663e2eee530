#include "gltf/document/document.h"

#include "gltf/codecs/compression.h"
#include "gltf/codecs/meshopt.h"
#include "gltf/document/conformance.h"
#include "gltf/document/container.h"
#include "gltf/document/extensions.h"
#include "gltf/document/uri.h"
#include "gltf/document/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace glint::gltf {

namespace {

// A hostile file can name one small image many times, and an image of one colour takes a few bytes whatever
// its size. A scene's images may therefore decode to kFreeImageBytes plus kMaxImageRatio times the bytes of
// its files, but to kMaxImageBytes at most. Photographs stay below 100 : 1, and drawings seldom reach 1000 :
// 1.
constexpr std::uint64_t kFreeImageBytes = 1ULL << 28;
constexpr std::uint64_t kMaxImageRatio = 1024;
constexpr std::uint64_t kMaxImageBytes = 1ULL << 33;

// Chooses a hint by the kind of failure. The pointer and the message already say where and what.
std::string hintFor(const std::string& id) {
    if (id == "index-range") {
        return "the file refers to something it does not hold: export it again";
    }
    return "correct the value, or export the file again; the Khronos glTF validator explains the rules";
}

}  // namespace

Document::Document(const std::filesystem::path& path, const ImportOptions& options)
    : name_(path.string()),
      options_(options),
      source_(path, options.maxFileBytes, options.strictPaths ? OuterLinks::Refuse : OuterLinks::Follow),
      verticesLeft_(options.maxVertices),
      unpackedBytesLeft_(options.maxFileBytes) {}

Result<std::unique_ptr<Document>> Document::open(const std::filesystem::path& path,
                                                 const ImportOptions& options) {
    std::unique_ptr<Document> document(new Document(path, options));
    GLINT_TRY_DO(document->parse());
    return document;
}

Status Document::parse() {
    GLINT_TRY(file_, source_.readScene());
    GLINT_TRY(const auto container, splitContainer(file_, name_, warnings_));
    binary_ = container.binary;
    GLINT_TRY(json_, parseJson(container.json, name_, warnings_));
    GLINT_TRY_DO(checkVersion());
    GLINT_TRY_DO(checkExtensions(*this));
    auto failure = checkDocument(json_, *options_.materialModel);
    if (!failure) {
        failure = checkCompression(json_);
    }
    if (failure) {
        return error(failure->id, failure->pointer, failure->message, hintFor(failure->id));
    }
    readElements();
    warnOfBrokenRules(*this);
    return okStatus();
}

void Document::readElements() {
    buffers_.resize(arraySize(json_, "/buffers"));
    for (const Json& view : arrayMember(json_, "bufferViews")) {
        views_.push_back(readBufferView(view));
    }
    unpackedViews_.resize(views_.size());
    const std::vector<bool> used = usedAccessors(json_, *options_.materialModel);
    accessors_.resize(used.size());
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i]) {
            accessors_[i] = readAccessor(json_["accessors"][i]);
        }
    }
}

Status Document::checkVersion() {
    const Json* asset = find(json_, "asset");
    const Json* version = asset == nullptr ? nullptr : find(*asset, "version");
    if (version == nullptr || !version->is_string()) {
        return error("asset-version", "/asset", "has no \"version\"", "check that this is a glTF 2.0 file");
    }
    const Json* minVersion = find(*asset, "minVersion");
    const bool hasMin = minVersion != nullptr && minVersion->is_string();
    const auto target = version->get<std::string>();
    if (hasMin && *minVersion != "2.0") {
        return error("asset-version", "/asset/minVersion",
                     fmt::format("needs glTF {}; Glint reads 2.0", minVersion->get<std::string>()),
                     "convert the file to glTF 2.0");
    }
    if (!target.starts_with("2.")) {
        return error("asset-version", "/asset/version", fmt::format("needs glTF {}; Glint reads 2.0", target),
                     "convert the file to glTF 2.0");
    }
    const bool isNumber = target.size() > 2 && std::ranges::all_of(target.substr(2), [](unsigned char c) {
                              return std::isdigit(c) != 0;
                          });
    if (!isNumber) {
        warn("asset-version", "/asset/version",
             fmt::format("\"{}\" is no version; it is read as 2.0", target), "write 2.0");
    }
    return okStatus();
}

Result<ByteView> Document::bufferView(int index) {
    const BufferView& view = views_[static_cast<std::size_t>(index)];
    const std::string pointer = fmt::format("/bufferViews/{}", index);
    if (const Json* extension = findMeshopt(json_["bufferViews"][static_cast<std::size_t>(index)])) {
        return unpackedView(index, *extension, pointer);
    }
    return bufferRange(view.buffer, view.offset, view.length, pointer);
}

Result<ByteView> Document::unpackedView(int index, const Json& extension, const std::string& pointer) {
    std::optional<base::Bytes>& unpacked = unpackedViews_[static_cast<std::size_t>(index)];
    if (!unpacked) {
        const Json* offset = find(extension, "byteOffset");
        GLINT_TRY(const auto packed, bufferRange(extension["buffer"].get<int>(),
                                                 offset == nullptr ? 0 : offset->get<std::uint64_t>(),
                                                 extension["byteLength"].get<std::uint64_t>(), pointer));
        GLINT_TRY(unpacked, unpackMeshopt(*this, extension, pointer, packed,
                                          views_[static_cast<std::size_t>(index)].length));
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
    const Json* uri = find(buffer, "uri");
    if (uri == nullptr) {
        if (findMeshopt(buffer) != nullptr) {
            return error(
                "buffer-data", pointer,
                "is a fallback that holds no data, but a buffer view without compressed data is read "
                "from it",
                "export the scene again");
        }
        return error("buffer-external", pointer,
                     "has neither a \"uri\" nor the binary chunk of a GLB: its data is not in the file",
                     "export the scene with its data");
    }
    const std::string& text = uri->get_ref<const std::string&>();
    if (!isDataUri(text)) {
        return readFile(text, pointer);
    }
    std::optional<DataUri> data = decodeDataUri(text);
    if (!data) {
        return error("data-uri", pointer + "/uri", "is no valid data URI", "export the scene again");
    }
    return std::move(data->bytes);
}

Result<base::Bytes> Document::readFile(std::string_view uri, const std::string& pointer) {
    return source_.readRelative(uri, where(pointer + "/uri"));
}

Status Document::chargeVertices(std::uint64_t count, std::string_view pointer) {
    if (count > verticesLeft_) {
        return error(
            "vertex-limit", pointer,
            fmt::format("with its {} elements the scene passes the limit of {}", count, options_.maxVertices),
            "split the scene, or raise ImportOptions::maxVertices");
    }
    verticesLeft_ -= count;
    return okStatus();
}

bool Document::chargeUnpackedBytes(std::uint64_t bytes) {
    if (bytes > unpackedBytesLeft_) {
        return false;
    }
    unpackedBytesLeft_ -= bytes;
    return true;
}

bool Document::chargeZeroElements(std::uint64_t count) {
    if (count > zeroElementsLeft_) {
        return false;
    }
    zeroElementsLeft_ -= count;
    return true;
}

bool Document::chargeImageBytes(std::uint64_t bytes) {
    // This can't overflow, because the contents of the files are below 2^54 bytes, as memory is.
    std::uint64_t limit = kFreeImageBytes;
    for (const SourceFile& file : files()) {
        limit += kMaxImageRatio * file.bytes;
    }
    limit = std::min(limit, kMaxImageBytes);
    if (imageBytes_ > limit || bytes > limit - imageBytes_) {
        return false;
    }
    imageBytes_ += bytes;
    return true;
}

std::string Document::where(std::string_view pointer) const {
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

}  // namespace glint::gltf
