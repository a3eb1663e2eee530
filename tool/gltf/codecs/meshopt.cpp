// Document: buffer views that are compressed with EXT_meshopt_compression or KHR_meshopt_compression.
#include "base/files.h"
#include "gltf/document/document.h"
#include "gltf/document/model.h"
#include "gltf/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <meshoptimizer.h>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

namespace glint::gltf {

namespace {

constexpr const char* kExportWithoutMeshopt = "export the scene again, or without meshopt compression";

// The attribute codec stores 16 values of one byte position in a quarter of a byte at best (a group header of
// two bits). Its version 1 can also leave out whole positions of a block of 256. This gives 1024 : 1.
// Indices stay far below that.
constexpr std::uint64_t kMaxRatio = 1024;

enum class Mode : std::uint8_t { Attributes, Triangles, Indices };
constexpr Named<Mode> kModes[] = {
    {Mode::Attributes, "ATTRIBUTES"}, {Mode::Triangles, "TRIANGLES"}, {Mode::Indices, "INDICES"}};
constexpr std::span<const Named<Mode>> namesOf(Mode /*of*/) {
    return kModes;
}

enum class FilterKind : std::uint8_t { None, Octahedral, Quaternion, Exponential, Color };
constexpr Named<FilterKind> kFilters[] = {{FilterKind::None, "NONE"},
                                          {FilterKind::Octahedral, "OCTAHEDRAL"},
                                          {FilterKind::Quaternion, "QUATERNION"},
                                          {FilterKind::Exponential, "EXPONENTIAL"},
                                          {FilterKind::Color, "COLOR"}};
constexpr std::span<const Named<FilterKind>> namesOf(FilterKind /*of*/) {
    return kFilters;
}

struct Layout {
    Mode mode = Mode::Attributes;
    FilterKind filter = FilterKind::None;
    std::size_t count = 0;
    std::size_t stride = 0;
};

// Returns which demand of the extension's text on modes, filters, counts and strides is not met. The text is
// empty if all are met. The library asserts the same.
std::string contradiction(const Layout& layout) {
    if (layout.mode == Mode::Attributes) {
        if (layout.stride % 4 != 0) {
            return fmt::format("byteStride is {}, which is no multiple of 4", layout.stride);
        }
        const bool isColor = layout.filter == FilterKind::Color;
        if ((layout.filter == FilterKind::Octahedral || isColor) && layout.stride != 4 &&
            layout.stride != 8) {
            return fmt::format("the filter {} takes a byteStride of 4 or 8, not {}", nameOf(layout.filter),
                               layout.stride);
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

Result<Layout> readLayout(const Document& document, const Value& extension, const std::string& pointer) {
    const std::string mode = memberOr<std::string>(extension, "mode", "");
    const auto filter = memberOr<std::string>(extension, "filter", "NONE");
    const auto fail = [&](std::string message) {
        return document.error("meshopt-layout", pointer, std::move(message), kExportWithoutMeshopt);
    };
    const std::optional<Mode> knownMode = valueNamed<Mode>(mode);
    if (!knownMode) {
        return fail(fmt::format("\"{}\" is no mode of meshopt compression that Glint reads", mode));
    }
    const std::optional<FilterKind> knownFilter = valueNamed<FilterKind>(filter);
    if (!knownFilter) {
        return fail(fmt::format("\"{}\" is no filter of meshopt compression that Glint reads", filter));
    }
    const Layout layout{*knownMode, *knownFilter,
                        static_cast<std::size_t>(memberOr<std::uint64_t>(extension, "count", 0)),
                        static_cast<std::size_t>(memberOr<std::uint64_t>(extension, "byteStride", 0))};
    if (std::string problem = contradiction(layout); !problem.empty()) {
        return fail(std::move(problem));
    }
    return layout;
}

// The library's error codes.
enum DecodeResult : int { kDecoded = 0, kUnknownHeader = -1, kEndsEarly = -2, kBadData = -3 };

// The attribute codec, versions 0 and 1: KHR_meshopt_compression, appendix A, "Mode 0". Glint has a decoder
// of its own, because the library of Debian 12 (0.18) reads version 0 alone.
class AttributeDecoder {
public:
    // `bytes` has layout.count elements of layout.stride bytes, which must be a multiple of 4 up to 256.
    AttributeDecoder(const Layout& layout, std::span<std::uint8_t> bytes) : layout_(layout), bytes_(bytes) {}

    int decode(ByteView packed) {
        if (packed.empty()) {
            return kEndsEarly;
        }
        version_ = packed[0] & 15U;
        if ((packed[0] & 0xF0U) != 0xA0U || version_ > 1) {
            return kUnknownHeader;
        }
        // The tail has the element before the first one, and the modes of the channels.
        const std::size_t tailSize = layout_.stride + (version_ == 0 ? 0 : layout_.stride / 4);
        const std::size_t padded = std::max<std::size_t>(tailSize, version_ == 0 ? 32 : 24);
        if (packed.size() - 1 < padded) {
            return kEndsEarly;
        }
        const ByteView tail = packed.last(tailSize);
        std::ranges::copy(tail.first(layout_.stride), last_.begin());
        modes_ = tail.subspan(layout_.stride);
        if (!std::ranges::all_of(modes_, [](std::uint8_t mode) { return mode < 2 || (mode & 15U) == 2; })) {
            return kBadData;
        }
        rest_ = packed.subspan(1, packed.size() - 1 - padded);
        const std::size_t mostInBlock =
            std::min((kBlockBytes / layout_.stride) & ~(kGroup - 1), kMostInBlock);
        for (std::size_t first = 0; first < layout_.count; first += mostInBlock) {
            if (!decodeBlock(first, std::min(mostInBlock, layout_.count - first))) {
                return kEndsEarly;
            }
        }
        return rest_.empty() ? kDecoded : kBadData;
    }

private:
    static constexpr std::size_t kGroup = 16;
    static constexpr std::size_t kMostInBlock = 256;
    static constexpr std::size_t kBlockBytes = 8192;
    // The deltas of one byte of all elements of a block.
    using Plane = std::array<std::uint8_t, kMostInBlock>;

    // Returns the next bytes, or nothing if there are fewer.
    std::optional<ByteView> take(std::size_t size) {
        if (size > rest_.size()) {
            return std::nullopt;
        }
        const ByteView taken = rest_.first(size);
        rest_ = rest_.subspan(size);
        return taken;
    }

    bool decodeBlock(std::size_t first, std::size_t count) {
        const std::size_t channels = layout_.stride / 4;
        const auto controls = take(version_ == 0 ? 0 : channels);
        if (!controls) {
            return false;
        }
        std::array<Plane, 4> planes{};
        for (std::size_t channel = 0; channel < channels; ++channel) {
            for (std::size_t i = 0; i < 4; ++i) {
                const unsigned control = version_ == 0 ? 0 : (*controls)[channel] >> (2 * i) & 3U;
                if (!readPlane(control, count, planes[i])) {
                    return false;
                }
            }
            const unsigned mode = version_ == 0 ? 0 : modes_[channel];
            const Target target{first * layout_.stride + 4 * channel, count, &last_[4 * channel]};
            if (mode == 0) {
                addDeltas<std::uint8_t>(planes, target);
            } else if (mode == 1) {
                addDeltas<std::uint16_t>(planes, target);
            } else {
                addBits(planes, target, static_cast<int>(mode >> 4U));
            }
        }
        return true;
    }

    bool readPlane(unsigned control, std::size_t count, Plane& plane) {
        if (control == 2) {
            plane.fill(0);
            return true;
        }
        if (control == 3) {
            const auto literal = take(count);
            if (literal) {
                std::ranges::copy(*literal, plane.begin());
            }
            return literal.has_value();
        }
        constexpr std::array<std::array<unsigned, 4>, 3> kWidths{{{0, 1, 2, 4}, {1, 2, 4, 8}, {0, 2, 4, 8}}};
        const std::array<unsigned, 4>& widths = kWidths[version_ == 0 ? 2 : control];
        const std::size_t groups = (count + kGroup - 1) / kGroup;
        const auto headers = take((groups + 3) / 4);
        for (std::size_t i = 0; headers && i < groups; ++i) {
            const unsigned width = widths[(*headers)[i / 4] >> (2 * (i % 4)) & 3U];
            if (!readGroup(width, std::span(plane).subspan(kGroup * i).first<kGroup>())) {
                return false;
            }
        }
        return headers.has_value();
    }

    // Reads 16 deltas of `width` bits. One whose bits are all set is a byte that follows them.
    bool readGroup(unsigned width, std::span<std::uint8_t, kGroup> deltas) {
        const auto codes = take(2 * std::size_t{width});
        if (!codes) {
            return false;
        }
        if (width == 0 || width == 8) {
            std::ranges::fill(deltas, std::uint8_t{0});
            std::ranges::copy(*codes, deltas.begin());
            return true;
        }
        const unsigned sentinel = (1U << width) - 1;
        for (std::size_t i = 0; i < kGroup; ++i) {
            const std::size_t bit = i * width;
            // Single bits begin with the lowest of their byte, others with the highest.
            const std::size_t shift = width == 1 ? bit % 8 : 8 - width - bit % 8;
            const unsigned code = (*codes)[bit / 8] >> shift & sentinel;
            deltas[i] = static_cast<std::uint8_t>(code);
            if (code == sentinel) {
                const auto whole = take(1);
                if (!whole) {
                    return false;
                }
                deltas[i] = whole->front();
            }
        }
        return true;
    }

    // Where the four bytes of a channel go, in each of the block's elements.
    struct Target {
        std::size_t offset;  // of the first element's
        std::size_t count;
        std::uint8_t* last;  // those of the element before the block; receives those of its last element
    };

    // Undoes differences of little-endian values, whose sign is in their lowest bit.
    template <typename T>
    void addDeltas(const std::array<Plane, 4>& planes, const Target& target) {
        for (std::size_t part = 0; part < 4; part += sizeof(T)) {
            T value{};
            std::memcpy(&value, target.last + part, sizeof value);
            for (std::size_t i = 0; i < target.count; ++i) {
                unsigned delta = 0;
                for (std::size_t k = 0; k < sizeof(T); ++k) {
                    delta |= unsigned{planes[part + k][i]} << (8 * k);
                }
                value = static_cast<T>(value + ((delta & 1U) != 0 ? ~(delta >> 1U) : delta >> 1U));
                std::memcpy(&bytes_[target.offset + i * layout_.stride + part], &value, sizeof value);
            }
            std::memcpy(target.last + part, &value, sizeof value);
        }
    }

    // Undoes exclusive ors of 32 bits, which are turned to the left by `turn` bits.
    void addBits(const std::array<Plane, 4>& planes, const Target& target, int turn) {
        std::uint32_t value = 0;
        std::memcpy(&value, target.last, sizeof value);
        for (std::size_t i = 0; i < target.count; ++i) {
            const std::uint32_t delta = planes[0][i] | std::uint32_t{planes[1][i]} << 8U |
                                        std::uint32_t{planes[2][i]} << 16U |
                                        std::uint32_t{planes[3][i]} << 24U;
            value ^= std::rotr(delta, turn);
            std::memcpy(&bytes_[target.offset + i * layout_.stride], &value, sizeof value);
        }
        std::memcpy(target.last, &value, sizeof value);
    }

    const Layout& layout_;
    std::span<std::uint8_t> bytes_;
    unsigned version_ = 0;
    ByteView modes_;
    ByteView rest_;  // what is still packed
    std::array<std::uint8_t, 256> last_{};
};

int decode(const Layout& layout, ByteView packed, base::Bytes& bytes) {
    switch (layout.mode) {
        case Mode::Attributes:
            return AttributeDecoder(layout, bytes).decode(packed);
        case Mode::Triangles:
            return meshopt_decodeIndexBuffer(bytes.data(), layout.count, layout.stride, packed.data(),
                                             packed.size());
        case Mode::Indices:
            return meshopt_decodeIndexSequence(bytes.data(), layout.count, layout.stride, packed.data(),
                                               packed.size());
    }
    return kUnknownHeader;
}

// The filter COLOR: KHR_meshopt_compression, appendix B. A colour is Y, Co, Cg and alpha, in as many bits as
// the highest one of alpha says.
template <typename T>
void decodeColors(std::span<std::uint8_t> bytes) {
    constexpr int kLargest = std::numeric_limits<T>::max();
    for (std::size_t i = 0; i < bytes.size(); i += 4 * sizeof(T)) {
        std::array<T, 4> color{};
        std::memcpy(color.data(), &bytes[i], sizeof color);
        using Signed = std::make_signed_t<T>;
        const int y = color[0];
        // Their signs count. NOLINTBEGIN(bugprone-signed-char-misuse)
        const int orange = static_cast<Signed>(color[1]);
        const int green = static_cast<Signed>(color[2]);
        // NOLINTEND(bugprone-signed-char-misuse)
        // An alpha of 0 has no such bit and is not valid.
        const int scale = std::max((1 << std::bit_width(color[3])) - 1, 1);
        const int alpha = color[3] & (scale >> 1);
        const std::array<int, 4> decoded{y + orange - green, y + green, y - orange - green,
                                         alpha << 1 | (alpha & 1)};
        for (std::size_t k = 0; k < 4; ++k) {
            const float scaled = static_cast<float>(decoded[k]) * (kLargest / static_cast<float>(scale));
            color[k] = static_cast<T>(std::clamp(std::round(scaled), 0.0F, static_cast<float>(kLargest)));
        }
        std::memcpy(&bytes[i], color.data(), sizeof color);
    }
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
        case FilterKind::Color:
            if (layout.stride == 4) {
                decodeColors<std::uint8_t>(bytes);
            } else {
                decodeColors<std::uint16_t>(bytes);
            }
            break;
    }
}

std::string explain(int code) {
    switch (code) {
        case kUnknownHeader:
            return "has another mode, or a newer format than those of the extension";
        case kEndsEarly:
            return "its packed data ends early";
        default:
            return "its packed data is damaged";
    }
}

}  // namespace

Result<base::Bytes> unpackMeshopt(Document& document, const Value& extension, const std::string& pointer,
                                  ByteView packed, std::uint64_t byteLength) {
    GLINT_TRY(const auto layout, readLayout(document, extension, pointer));
    // This can't overflow, because the factors are within the limits of the table, 2^53 and 2^8.
    if (std::uint64_t{layout.count} * layout.stride != byteLength) {
        return document.error("meshopt-layout", pointer,
                              fmt::format("{} elements of {} bytes are not its {} bytes", layout.count,
                                          layout.stride, byteLength),
                              kExportWithoutMeshopt);
    }
    if (byteLength / kMaxRatio > packed.size()) {
        return document.error(
            "meshopt-size", pointer,
            fmt::format("says it unpacks {} bytes to {}, which no data can", packed.size(), byteLength),
            kExportWithoutMeshopt);
    }
    if (!document.unpackedBytes().take(byteLength)) {
        return document.error("meshopt-size", pointer,
                              "the scene's compressed buffer views unpack to too much",
                              "split the scene, or raise ImportOptions::maxFileBytes");
    }
    base::Bytes bytes(static_cast<std::size_t>(byteLength));
    if (bytes.empty()) {
        return bytes;
    }
    if (const int code = decode(layout, packed, bytes); code != kDecoded) {
        return document.error("meshopt-decode", pointer,
                              fmt::format("can't be unpacked: {} (code {})", explain(code), code),
                              kExportWithoutMeshopt);
    }
    applyFilter(layout, bytes);
    return bytes;
}

}  // namespace glint::gltf
