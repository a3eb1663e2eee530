// An opened and checked glTF document. Every part of the importer reads from it.
#pragma once

#include "gltf/document/elements.h"
#include "gltf/document/file_source.h"
#include "gltf/document/schema.h"
#include "gltf/import.h"

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::gltf {

using ByteView = std::span<const std::uint8_t>;

class Document {
public:
    // Reads, parses and checks the file. It opens no other file.
    static Result<std::unique_ptr<Document>> open(const std::filesystem::path& path,
                                                  const ImportOptions& options);

    // The file's JSON, in which all types, ranges and references that the importer reads have been checked.
    // Views and accessors are read from it once.
    const Json& json() const {
        return json_;
    }
    // The accessor must be one that the importer reads (usedAccessors()).
    const Accessor& accessor(int index) const {
        return accessors_[static_cast<std::size_t>(index)];
    }
    // Returns how far apart the elements of a buffer view are in bytes, or 0 if they follow each other.
    std::size_t stride(int bufferView) const {
        return views_[static_cast<std::size_t>(bufferView)].stride;
    }
    const ImportOptions& options() const {
        return options_;
    }

    // Returns the bytes of a buffer view, decompressed if necessary. The first use of a buffer opens it.
    Result<ByteView> bufferView(int index);
    // Reads the file that a relative URI names.
    Result<base::Bytes> readFile(std::string_view uri, const std::string& pointer);
    // Takes `count` elements from the budget of ImportOptions::maxVertices. The error is "vertex-limit" at
    // `pointer` if the budget is exhausted.
    Status chargeVertices(std::uint64_t count, std::string_view pointer);
    // Takes bytes from the budget of unpacked buffer views, ImportOptions::maxFileBytes. Returns false if it
    // is exhausted.
    bool chargeUnpackedBytes(std::uint64_t bytes);
    // Elements of accessors without a buffer view take no bytes of the file, so the file's size doesn't bound
    // them. They count each time that a primitive reads such an accessor.
    static constexpr std::uint64_t kMaxZeroElements = 1ULL << 22;
    // Takes elements from that budget. Returns false if it is exhausted.
    bool chargeZeroElements(std::uint64_t count);
    // Takes bytes from the budget of decoded images, which grows with the files that were read. Returns false
    // if it is exhausted.
    bool chargeImageBytes(std::uint64_t bytes);

    // "scene.gltf#/materials/3"
    std::string where(std::string_view pointer) const;
    Diagnostic error(std::string id, std::string_view pointer, std::string message,
                     std::string hint = {}) const;
    void warn(std::string id, std::string_view pointer, std::string message, std::string hint = {});
    void note(std::string id, std::string_view pointer, std::string message, std::string hint = {});

    // These include notes.
    std::vector<Diagnostic>& warnings() {
        return warnings_;
    }
    const std::vector<SourceFile>& files() const {
        return source_.files();
    }

private:
    Document(const std::filesystem::path& path, const ImportOptions& options);

    Status parse();
    Status checkVersion();
    void readElements();
    Result<ByteView> buffer(int index);
    Result<ByteView> bufferRange(int buffer, std::uint64_t offset, std::uint64_t length,
                                 const std::string& pointer);
    Result<ByteView> unpackedView(int index, const Json& extension, const std::string& pointer);
    Result<base::Bytes> loadBuffer(const Json& buffer, const std::string& pointer);

    std::string name_;
    ImportOptions options_;
    FileSource source_;
    base::Bytes file_;
    std::optional<ByteView> binary_;  // views file_
    Json json_;
    std::vector<BufferView> views_;
    std::vector<Accessor> accessors_;
    std::vector<std::optional<base::Bytes>> buffers_;
    std::vector<std::optional<base::Bytes>> unpackedViews_;
    std::vector<Diagnostic> warnings_;
    std::uint64_t verticesLeft_;
    std::uint64_t unpackedBytesLeft_;
    std::uint64_t zeroElementsLeft_ = kMaxZeroElements;
    std::uint64_t imageBytes_ = 0;
};

}  // namespace glint::gltf
