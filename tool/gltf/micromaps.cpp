#include "gltf/micromaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

namespace glint::gltf {

namespace {

// Levels up to which the bytes of a record are a number of 32 bits.
constexpr std::uint32_t kMostLevels = 12;
constexpr int kByte = 5121;
constexpr int kSignedShort = 5122;
constexpr int kShort = 5123;
constexpr int kSignedInt = 5124;
constexpr int kInt = 5125;

Diagnostic micromapFault(std::string pointer, std::string message) {
    return makeError("micromap", std::move(pointer), std::move(message),
                     "bake the micromaps again, or leave the extension out");
}

bool isCount(const Json& json) {
    return json.is_number_integer() && json.get<std::int64_t>() >= 0;
}

// Returns a member that is a number of at least 0, or nothing.
std::optional<std::size_t> numberOf(const Json& json, const char* name) {
    const auto found = json.find(name);
    return found == json.end() || !isCount(*found) ? std::nullopt : std::optional(found->get<std::size_t>());
}

const Json* micromapsOf(const Json& json) {
    const auto extensions = json.find("extensions");
    if (extensions == json.end()) {
        return nullptr;
    }
    const auto found = extensions->find(kMicromapExtension);
    return found == extensions->end() || !found->is_object() ? nullptr : &*found;
}

class MicromapReader {
public:
    MicromapReader(const Json& json, const ReadBufferView& read) : json_(json), read_(read) {}

    Result<std::vector<PrimitiveMicromap>> run() {
        GLINT_TRY_DO(readArrays());
        std::vector<PrimitiveMicromap> found;
        const Json meshes = json_.value("meshes", Json::array());
        for (std::size_t mesh = 0; mesh < meshes.size(); ++mesh) {
            const Json primitives = meshes[mesh].value("primitives", Json::array());
            for (std::size_t i = 0; i < primitives.size(); ++i) {
                const Json* const extension = micromapsOf(primitives[i]);
                if (extension == nullptr) {
                    continue;
                }
                const std::string pointer =
                    fmt::format("/meshes/{}/primitives/{}/extensions/{}", mesh, i, kMicromapExtension);
                GLINT_TRY(auto array, readPrimitive(primitives[i], *extension, pointer));
                found.push_back({mesh, i, std::move(array)});
            }
        }
        return found;
    }

private:
    Status readArrays() {
        const Json* const root = micromapsOf(json_);
        const Json list = root == nullptr ? Json::array() : root->value("micromaps", Json::array());
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string pointer = fmt::format("/extensions/{}/micromaps/{}", kMicromapExtension, i);
            GLINT_TRY(auto array, readArray(list[i], pointer));
            arrays_.push_back(std::move(array));
        }
        return okStatus();
    }

    Result<std::span<const std::uint8_t>> view(const Json& json, const char* name, const std::string& pointer,
                                               std::size_t& index) {
        const std::optional<std::size_t> number = numberOf(json, name);
        if (!number || *number >= json_.value("bufferViews", Json::array()).size()) {
            return micromapFault(pointer + "/" + name, "names no buffer view");
        }
        index = *number;
        return read_(index);
    }

    Result<opacity::MicromapArray> readArray(const Json& json, const std::string& pointer) {
        opacity::MicromapArray array;
        std::size_t index = 0;
        GLINT_TRY(auto data, view(json, "data", pointer, index));
        array.data.assign(data.begin(), data.end());
        GLINT_TRY(auto records, view(json, "triangles", pointer, index));
        const std::size_t stride = json_["bufferViews"][index].value("byteStride", std::size_t{8});
        if (stride < sizeof(opacity::MicromapRecord) || stride % 4 != 0) {
            return micromapFault(pointer + "/triangles", "has a stride below 8, or none of 4");
        }
        for (std::size_t at = 0; at + sizeof(opacity::MicromapRecord) <= records.size(); at += stride) {
            std::memcpy(&array.records.emplace_back(), records.data() + at, sizeof(opacity::MicromapRecord));
        }
        const Json counts = json.value("usageCounts", Json::array());
        const Json levels = json.value("usageLevels", Json::array());
        const Json formats = json.value("usageFormats", Json::array());
        if (counts.size() != levels.size() || counts.size() != formats.size()) {
            return micromapFault(pointer, "has usageCounts, usageLevels and usageFormats of other lengths");
        }
        for (std::size_t i = 0; i < counts.size(); ++i) {
            const bool isNumber = isCount(counts[i]) && isCount(levels[i]) && isCount(formats[i]);
            if (!isNumber || counts[i] == 0) {
                return micromapFault(pointer, fmt::format("has a usage {} that counts nothing", i));
            }
            array.usages.push_back({counts[i].get<std::uint32_t>(), levels[i].get<std::uint32_t>(),
                                    formats[i].get<std::uint32_t>()});
        }
        if (const std::optional<const char*> fault = opacity::faultIn(array, kMostLevels)) {
            return micromapFault(pointer, *fault);
        }
        return array;
    }

    std::optional<std::size_t> accessorCount(const Json& owner, const char* name) const {
        const std::optional<std::size_t> accessor = numberOf(owner, name);
        const Json accessors = json_.value("accessors", Json::array());
        return accessor && *accessor < accessors.size() ? numberOf(accessors[*accessor], "count")
                                                        : std::nullopt;
    }

    Result<opacity::MicromapArray> readPrimitive(const Json& primitive, const Json& extension,
                                                 const std::string& pointer) {
        const std::optional<std::size_t> number = numberOf(extension, "micromap");
        if (!number || *number >= arrays_.size()) {
            return micromapFault(pointer + "/micromap", "names no micromap");
        }
        if (primitive.value("mode", 4) != 4) {
            return micromapFault(pointer, "is of a primitive that is no list of triangles");
        }
        const Json attributes = primitive.value("attributes", Json::object());
        const std::optional<std::size_t> corners = primitive.contains("indices")
                                                       ? accessorCount(primitive, "indices")
                                                       : accessorCount(attributes, "POSITION");
        if (!corners) {
            return micromapFault(pointer, "is of a primitive without vertices");
        }
        opacity::MicromapArray array = arrays_[*number];
        const std::size_t base = numberOf(extension, "micromapBaseTriangle").value_or(0);
        GLINT_TRY(auto values, readIndices(extension, *corners / 3, pointer));
        for (const std::int64_t value : values) {
            const std::int64_t index = value < 0 ? value : value + static_cast<std::int64_t>(base);
            if (index < -4 || index >= static_cast<std::int64_t>(array.records.size())) {
                return micromapFault(pointer,
                                     "has an index that is neither that of a record nor a special one");
            }
            array.indices.push_back(static_cast<std::int32_t>(index));
        }
        return array;
    }

    // Returns an index for each triangle: its own number if there is no accessor. Those in unsigned numbers
    // may be special, too.
    Result<std::vector<std::int64_t>> readIndices(const Json& extension, std::size_t triangles,
                                                  const std::string& pointer) {
        std::vector<std::int64_t> values(triangles);
        if (!extension.contains("micromapIndices")) {
            for (std::size_t i = 0; i < triangles; ++i) {
                values[i] = static_cast<std::int64_t>(i);
            }
            return values;
        }
        const std::string where = pointer + "/micromapIndices";
        const std::optional<std::size_t> number = numberOf(extension, "micromapIndices");
        const Json accessors = json_.value("accessors", Json::array());
        if (!number || *number >= accessors.size()) {
            return micromapFault(where, "names no accessor");
        }
        const Json& accessor = accessors[*number];
        if (accessor.value("type", "") != "SCALAR" || numberOf(accessor, "count") != triangles ||
            accessor.contains("sparse")) {
            return micromapFault(where, "names an accessor that has not one number for each triangle");
        }
        std::size_t index = 0;
        GLINT_TRY(auto bytes, view(accessor, "bufferView", where, index));
        const int type = accessor.value("componentType", 0);
        const std::size_t size = type == kByte ? 1 : type == kShort || type == kSignedShort ? 2 : 4;
        const bool known =
            type == kByte || type == kSignedShort || type == kShort || type == kSignedInt || type == kInt;
        const std::size_t stride = json_["bufferViews"][index].value("byteStride", size);
        const std::size_t offset = accessor.value("byteOffset", std::size_t{0});
        const std::size_t needed = triangles == 0 ? 0 : offset + (triangles - 1) * stride + size;
        if (!known || needed > bytes.size()) {
            return micromapFault(where, "names an accessor of another type, or one beyond its buffer view");
        }
        for (std::size_t i = 0; i < triangles; ++i) {
            std::uint32_t word = 0;
            std::memcpy(&word, bytes.data() + offset + i * stride, size);
            values[i] = signedOf(word, 8 * size, type == kSignedShort || type == kSignedInt);
        }
        return values;
    }

    static std::int64_t signedOf(std::uint32_t word, std::size_t bits, bool isSigned) {
        const std::int64_t range = std::int64_t{1} << bits;
        const std::int64_t firstNegative = isSigned ? range / 2 : range - 4;
        return word >= firstNegative ? static_cast<std::int64_t>(word) - range
                                     : static_cast<std::int64_t>(word);
    }

    const Json& json_;
    const ReadBufferView& read_;
    std::vector<opacity::MicromapArray> arrays_;  // without indices
};

// Appends bytes as a buffer view and returns its number.
template <typename T>
std::size_t addView(const std::vector<T>& values, std::size_t buffer, Json& json,
                    std::vector<std::uint8_t>& bytes) {
    constexpr std::size_t kAlignment = 8;
    bytes.resize((bytes.size() + kAlignment - 1) / kAlignment * kAlignment);
    const std::size_t offset = bytes.size();
    const std::size_t length = values.size() * sizeof(T);
    bytes.resize(offset + std::max<std::size_t>(length, 1));
    if (length > 0) {
        std::memcpy(&bytes[offset], values.data(), length);
    }
    json["bufferViews"].push_back(
        {{"buffer", buffer}, {"byteOffset", offset}, {"byteLength", std::max<std::size_t>(length, 1)}});
    return json["bufferViews"].size() - 1;
}

}  // namespace

Result<std::vector<PrimitiveMicromap>> readMicromaps(const Json& json, const ReadBufferView& read) {
    return MicromapReader(json, read).run();
}

void writeMicromaps(std::span<const PrimitiveMicromap> micromaps, const std::string& uri, Json& json,
                    std::vector<std::uint8_t>& bytes) {
    Json& used = json["extensionsUsed"];
    if (std::find(used.begin(), used.end(), kMicromapExtension) == used.end()) {
        used.push_back(kMicromapExtension);
    }
    const std::size_t buffer = json["buffers"].size();
    Json list = Json::array();
    for (const PrimitiveMicromap& one : micromaps) {
        Json usageCounts = Json::array();
        Json usageLevels = Json::array();
        Json usageFormats = Json::array();
        for (const opacity::MicromapUsage& usage : one.array.usages) {
            usageCounts.push_back(usage.count);
            usageLevels.push_back(usage.subdivisionLevel);
            usageFormats.push_back(usage.format);
        }
        Json& extension =
            json["meshes"][one.mesh]["primitives"][one.primitive]["extensions"][kMicromapExtension];
        const std::size_t indices = addView(one.array.indices, buffer, json, bytes);
        json["accessors"].push_back({{"bufferView", indices},
                                     {"componentType", kInt},
                                     {"count", one.array.indices.size()},
                                     {"type", "SCALAR"}});
        extension = {{"micromap", list.size()}, {"micromapIndices", json["accessors"].size() - 1}};
        if (one.array.records.empty()) {
            // A micromap must have records, so where all triangles have special indices it gets one that none
            // uses.
            opacity::MicromapArray filler;
            filler.data = {1};
            filler.records = {{0, 0, opacity::kTwoStates}};
            list.push_back({{"data", addView(filler.data, buffer, json, bytes)},
                            {"triangles", addView(filler.records, buffer, json, bytes)},
                            {"usageCounts", {1}},
                            {"usageLevels", {0}},
                            {"usageFormats", {1}}});
            continue;
        }
        list.push_back({{"data", addView(one.array.data, buffer, json, bytes)},
                        {"triangles", addView(one.array.records, buffer, json, bytes)},
                        {"usageCounts", usageCounts},
                        {"usageLevels", usageLevels},
                        {"usageFormats", usageFormats}});
    }
    json["extensions"][kMicromapExtension]["micromaps"] = std::move(list);
    Json entry{{"byteLength", bytes.size()}};
    if (!uri.empty()) {
        entry["uri"] = uri;
    }
    json["buffers"].push_back(std::move(entry));
}

}  // namespace glint::gltf
