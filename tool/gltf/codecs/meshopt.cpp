#include "gltf/codecs/meshopt.h"

#include <fmt/format.h>

#include <meshoptimizer.h>
#include <optional>
#include <string>
#include <utility>

namespace glint::gltf {

namespace {

constexpr const char* kExportWithoutMeshopt = "export the scene again, or without meshopt compression";

// The vertex codec stores 16 values of one byte position in a quarter of a byte at best (a group header of
// two bits). Its later version can also leave out whole positions of a block of 256. This gives 1024 : 1.
// Indices stay far below that.
constexpr std::uint64_t kMaxRatio = 1024;

enum class Mode : std::uint8_t { Attributes, Triangles, Indices };
enum class FilterKind : std::uint8_t { None, Octahedral, Quaternion, Exponential };

struct Layout {
    Mode mode = Mode::Attributes;
    FilterKind filter = FilterKind::None;
    std::size_t count = 0;
    std::size_t stride = 0;
};

std::optional<Mode> modeOf(const std::string& name) {
    if (name == "ATTRIBUTES") {
        return Mode::Attributes;
    }
    if (name == "TRIANGLES") {
        return Mode::Triangles;
    }
    return name == "INDICES" ? std::optional(Mode::Indices) : std::nullopt;
}

std::optional<FilterKind> filterOf(const std::string& name) {
    if (name == "NONE") {
        return FilterKind::None;
    }
    if (name == "OCTAHEDRAL") {
        return FilterKind::Octahedral;
    }
    if (name == "QUATERNION") {
        return FilterKind::Quaternion;
    }
    return name == "EXPONENTIAL" ? std::optional(FilterKind::Exponential) : std::nullopt;
}

// Returns which demand of the extension's text on modes, filters, counts and strides is not met. The text is
// empty if all are met. The library asserts the same.
std::string contradiction(const Layout& layout) {
    if (layout.mode == Mode::Attributes) {
        if (layout.stride % 4 != 0) {
            return fmt::format("byteStride is {}, which is no multiple of 4", layout.stride);
        }
        if (layout.filter == FilterKind::Octahedral && layout.stride != 4 && layout.stride != 8) {
            return fmt::format("the filter OCTAHEDRAL takes a byteStride of 4 or 8, not {}", layout.stride);
        }
        if (layout.filter == FilterKind::Quaternion && layout.stride != 8) {
            return fmt::format("the filter QUATERNION takes a byteStride of 8, not {}", layout.stride);
        }
        return {};
    }
    if (layout.stride != 2 && layout.stride != 4) {
        return fmt::format("indices take a byteStride of 2 or 4, not {}", layout.stride);
    }
    if (layout.filter != FilterKind::None) {
        return "a filter needs the mode ATTRIBUTES";
    }
    if (layout.mode == Mode::Triangles && layout.count % 3 != 0) {
        return fmt::format("count is {}, which is no multiple of 3", layout.count);
    }
    return {};
}

Result<Layout> readLayout(const Document& document, const Json& extension, const std::string& pointer) {
    const std::string mode = extension["mode"].get<std::string>();
    const Json* filterName = find(extension, "filter");
    const std::string filter = filterName == nullptr ? "NONE" : filterName->get<std::string>();
    const auto fail = [&](std::string message) {
        return document.error("meshopt-layout", pointer, std::move(message), kExportWithoutMeshopt);
    };
    const std::optional<Mode> knownMode = modeOf(mode);
    if (!knownMode) {
        return fail(fmt::format("\"{}\" is no mode of meshopt compression that Glint reads", mode));
    }
    const std::optional<FilterKind> knownFilter = filterOf(filter);
    if (!knownFilter) {
        return fail(fmt::format("\"{}\" is no filter of meshopt compression that Glint reads", filter));
    }
    const Layout layout{*knownMode, *knownFilter, extension["count"].get<std::size_t>(),
                        extension["byteStride"].get<std::size_t>()};
    if (std::string problem = contradiction(layout); !problem.empty()) {
        return fail(std::move(problem));
    }
    return layout;
}

int decode(const Layout& layout, ByteView packed, base::Bytes& bytes) {
    switch (layout.mode) {
        case Mode::Attributes:
            return meshopt_decodeVertexBuffer(bytes.data(), layout.count, layout.stride, packed.data(),
                                              packed.size());
        case Mode::Triangles:
            return meshopt_decodeIndexBuffer(bytes.data(), layout.count, layout.stride, packed.data(),
                                             packed.size());
        case Mode::Indices:
            return meshopt_decodeIndexSequence(bytes.data(), layout.count, layout.stride, packed.data(),
                                               packed.size());
    }
    return -1;
}

void applyFilter(const Layout& layout, base::Bytes& bytes) {
    switch (layout.filter) {
        case FilterKind::None:
            break;
        case FilterKind::Octahedral:
            meshopt_decodeFilterOct(bytes.data(), layout.count, layout.stride);
            break;
        case FilterKind::Quaternion:
            meshopt_decodeFilterQuat(bytes.data(), layout.count, layout.stride);
            break;
        case FilterKind::Exponential:
            meshopt_decodeFilterExp(bytes.data(), layout.count, layout.stride);
            break;
    }
}

// Explains the library's error codes. -1 stands for a header byte that it does not know.
std::string explain(int code) {
    constexpr int kVersion = MESHOPTIMIZER_VERSION;
    switch (code) {
        case -1:
            return fmt::format(
                "has another mode, or a newer format than meshoptimizer {}.{}, which this Glint uses, reads",
                kVersion / 1000, kVersion / 10 % 100);
        case -2:
            return "its packed data ends early";
        default:
            return "its packed data is damaged";
    }
}

}  // namespace

Result<base::Bytes> unpackMeshopt(Document& document, const Json& extension, const std::string& pointer,
                                  ByteView packed, std::uint64_t byteLength) {
    const Result<Layout> layout = readLayout(document, extension, pointer);
    if (!layout) {
        return layout.error();
    }
    // This can't overflow, because the factors are within the limits of the table, 2^53 and 2^8.
    if (std::uint64_t{layout->count} * layout->stride != byteLength) {
        return document.error("meshopt-layout", pointer,
                              fmt::format("{} elements of {} bytes are not its {} bytes", layout->count,
                                          layout->stride, byteLength),
                              kExportWithoutMeshopt);
    }
    if (byteLength / kMaxRatio > packed.size()) {
        return document.error(
            "meshopt-size", pointer,
            fmt::format("says it unpacks {} bytes to {}, which no data can", packed.size(), byteLength),
            kExportWithoutMeshopt);
    }
    if (!document.chargeUnpackedBytes(byteLength)) {
        return document.error("meshopt-size", pointer,
                              "the scene's compressed buffer views unpack to too much",
                              "split the scene, or raise ImportOptions::maxFileBytes");
    }
    base::Bytes bytes(static_cast<std::size_t>(byteLength));
    if (bytes.empty()) {
        return bytes;
    }
    if (const int code = decode(*layout, packed, bytes); code != 0) {
        return document.error("meshopt-decode", pointer,
                              fmt::format("can't be unpacked: {} (code {})", explain(code), code),
                              kExportWithoutMeshopt);
    }
    applyFilter(*layout, bytes);
    return bytes;
}

}  // namespace glint::gltf
