#include "gltf/document/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace glint::gltf {

namespace {

// A hostile file can name one small image many times, and an image of one colour takes a few bytes whatever
// its size. A scene's images may therefore decode to kFreeImageBytes plus kMaxImageRatio times the bytes of
// its files, but to kMaxImageBytes at most. Photographs stay below 100 : 1, and drawings seldom reach 1000 :
// 1.
constexpr std::uint64_t kFreeImageBytes = 1ULL << 28;
constexpr std::uint64_t kMaxImageRatio = 1024;
constexpr std::uint64_t kMaxImageBytes = 1ULL << 33;

// Takes an amount from what is left of a budget. Returns false if it is exhausted.
bool take(std::uint64_t& left, std::uint64_t amount) {
    if (amount > left) {
        return false;
    }
    left -= amount;
    return true;
}

}  // namespace

Report::Report(std::string file, const ImportOptions& options)
    : file_(std::move(file)),
      options_(options),
      verticesLeft_(options.maxVertices),
      unpackedBytesLeft_(options.maxFileBytes) {}

std::string Report::where(std::string_view pointer) const {
    return pointer.empty() ? file_ : fmt::format("{}#{}", file_, pointer);
}

Diagnostic Report::error(std::string id, std::string_view pointer, std::string message,
                         std::string hint) const {
    return makeError(std::move(id), where(pointer), std::move(message), std::move(hint));
}

void Report::warn(std::string id, std::string_view pointer, std::string message, std::string hint) {
    warnings_.push_back(makeWarning(std::move(id), where(pointer), std::move(message), std::move(hint)));
}

void Report::note(std::string id, std::string_view pointer, std::string message, std::string hint) {
    warnings_.push_back({Severity::Note, std::move(id), where(pointer), std::move(message), std::move(hint)});
}

Status Report::chargeVertices(std::uint64_t count, std::string_view pointer) {
    if (!take(verticesLeft_, count)) {
        return error(
            "vertex-limit", pointer,
            fmt::format("with its {} elements the scene passes the limit of {}", count, options_.maxVertices),
            "split the scene, or raise ImportOptions::maxVertices");
    }
    return okStatus();
}

bool Report::chargeUnpackedBytes(std::uint64_t bytes) {
    return take(unpackedBytesLeft_, bytes);
}

bool Report::chargeZeroElements(std::uint64_t count) {
    return take(zeroElementsLeft_, count);
}

bool Report::chargeImageBytes(std::uint64_t bytes, std::uint64_t fileBytes) {
    // This can't overflow, because the contents of the files are below 2^54 bytes, as memory is.
    const std::uint64_t limit = std::min(kFreeImageBytes + kMaxImageRatio * fileBytes, kMaxImageBytes);
    if (imageBytes_ > limit || bytes > limit - imageBytes_) {
        return false;
    }
    imageBytes_ += bytes;
    return true;
}

}  // namespace glint::gltf
