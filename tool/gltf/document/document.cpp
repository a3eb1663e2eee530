#include "gltf/document/document.h"

#include "gltf/codecs/meshopt.h"
#include "gltf/document/conformance.h"
#include "gltf/document/container.h"
#include "gltf/document/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace glint::gltf {

namespace {

// Chooses a hint by the kind of failure. The pointer and the message already say where and what.
std::string hintFor(const std::string& id) {
    if (id == "index-range") {
        return "the file refers to something it does not hold: export it again";
    }
    return "correct the value, or export the file again; the Khronos glTF validator explains the rules";
}

Status checkVersion(Report& report, const Json& root) {
    const Json* asset = find(root, "asset");
    const Json* version = asset == nullptr ? nullptr : find(*asset, "version");
    if (version == nullptr || !version->is_string()) {
        return report.error("asset-version", "/asset", "has no \"version\"",
                            "check that this is a glTF 2.0 file");
    }
    const Json* minVersion = find(*asset, "minVersion");
    const bool hasMin = minVersion != nullptr && minVersion->is_string();
    const auto target = version->get<std::string>();
    if (hasMin && *minVersion != "2.0") {
        return report.error("asset-version", "/asset/minVersion",
                            fmt::format("needs glTF {}; Glint reads 2.0", minVersion->get<std::string>()),
                            "convert the file to glTF 2.0");
    }
    if (!target.starts_with("2.")) {
        return report.error("asset-version", "/asset/version",
                            fmt::format("needs glTF {}; Glint reads 2.0", target),
                            "convert the file to glTF 2.0");
    }
    const bool isNumber = target.size() > 2 && std::ranges::all_of(target.substr(2), [](unsigned char c) {
                              return std::isdigit(c) != 0;
                          });
    if (!isNumber) {
        report.warn("asset-version", "/asset/version",
                    fmt::format("\"{}\" is no version; it is read as 2.0", target), "write 2.0");
    }
    return okStatus();
}

}  // namespace

Document::Document(const std::filesystem::path& path, const ImportOptions& options)
    : Report(path.string(), options),
      source_(path, options.maxFileBytes, options.strictPaths ? OuterLinks::Refuse : OuterLinks::Follow) {}

Result<std::unique_ptr<Document>> Document::open(const std::filesystem::path& path,
                                                 const ImportOptions& options) {
    std::unique_ptr<Document> document(new Document(path, options));
    GLINT_TRY_DO(document->parse(path.string()));
    return document;
}

Status Document::parse(const std::string& name) {
    GLINT_TRY(file_, source_.readScene());
    GLINT_TRY(const auto container, splitContainer(file_, name, warnings()));
    binary_ = container.binary;
    GLINT_TRY(json_, parseJson(container.json, name, warnings()));
    GLINT_TRY_DO(checkVersion(*this, json_));
    GLINT_TRY_DO(checkExtensions(*this, json_));
    if (const auto failure = checkDocument(json_, *options().materialModel)) {
        return error(failure->id, failure->pointer, failure->message, hintFor(failure->id));
    }
    warnOfBrokenRules(*this, json_);
    const std::vector<bool> used = usedAccessors(json_, *options().materialModel);
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
                  bufferRange(indexMember(extension, "buffer"), sizeMember(extension, "byteOffset"),
                              sizeMember(extension, "byteLength"), pointer));
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
    if (!isDataUri(uri)) {
        return source_.readRelative(uri, where(pointer + "/uri"));
    }
    std::optional<DataUri> data = decodeDataUri(uri);
    if (!data) {
        return error("data-uri", pointer + "/uri", "is no valid data URI", "export the scene again");
    }
    return std::move(data->bytes);
}

bool Document::chargeImage(std::uint64_t bytes) {
    std::uint64_t fileBytes = 0;
    for (const SourceFile& file : files()) {
        fileBytes += file.bytes;
    }
    return chargeImageBytes(bytes, fileBytes);
}

}  // namespace glint::gltf
