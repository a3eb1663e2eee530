// A glTF document, opened and checked: what every part of the importer reads from.
#pragma once

#include "gltf/file_source.h"
#include "gltf/import.h"
#include "gltf/schema.h"

#include <glint/result.h>

#include <tiny_gltf.h>

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
    // Reads, parses and checks the file; opens no other.
    static Result<std::unique_ptr<Document>> open(const std::filesystem::path& path,
                                                  const ImportOptions& options);

    // The file's JSON, for extensions and images, and tinygltf's view of it (projectDocument()) for the rest.
    // All references in both are in range.
    const Json& json() const {
        return json_;
    }
    const tinygltf::Model& model() const {
        return model_;
    }
    const ImportOptions& options() const {
        return options_;
    }

    // The bytes of a buffer view, unpacked where they are compressed. Opens its buffer on first use.
    Result<ByteView> bufferView(int index);
    // Reads the file that a relative URI names.
    Result<Bytes> readFile(std::string_view uri, const std::string& pointer);
    // Takes `count` elements off the budget of ImportOptions::maxVertices; "vertex-limit" at `pointer` where
    // that is exhausted.
    Status chargeVertices(std::uint64_t count, std::string_view pointer);
    // Takes bytes off the budget of unpacked buffer views, ImportOptions::maxFileBytes; false where that is
    // exhausted.
    bool chargeUnpackedBytes(std::uint64_t bytes);
    // Elements of accessors without a buffer view cost the file nothing, so that its size doesn't bound them.
    // Each time that a primitive reads one counts.
    static constexpr std::uint64_t kMaxZeroElements = 1ULL << 22;
    // Takes elements off that budget; false where it is exhausted.
    bool chargeZeroElements(std::uint64_t count);
    // Takes bytes off the budget of decoded images, which grows with the files that were read; false where
    // that is exhausted.
    bool chargeImageBytes(std::uint64_t bytes);

    // "scene.gltf#/materials/3"
    std::string where(std::string_view pointer) const;
    Diagnostic error(std::string id, std::string_view pointer, std::string message,
                     std::string hint = {}) const;
    void warn(std::string id, std::string_view pointer, std::string message, std::string hint = {});
    void note(std::string id, std::string_view pointer, std::string message, std::string hint = {});

    // Notes, too.
    std::vector<Diagnostic>& warnings() {
        return warnings_;
    }
    const std::vector<SourceFile>& files() const {
        return source_.files();
    }

private:
    Document(const std::filesystem::path& path, const ImportOptions& options);

    Status parse();
    Status checkVersion() const;
    Status parseModel();
    bool mirrorsJson() const;
    Result<ByteView> buffer(int index);
    Result<ByteView> bufferRange(int buffer, std::uint64_t offset, std::uint64_t length,
                                 const std::string& pointer);
    Result<ByteView> unpackedView(int index, const Json& extension, const std::string& pointer);
    Result<Bytes> loadBuffer(const Json& buffer, const std::string& pointer);

    std::string name_;
    ImportOptions options_;
    FileSource source_;
    Bytes file_;
    std::optional<ByteView> binary_;  // views file_
    Json json_;
    tinygltf::Model model_;
    std::vector<std::optional<Bytes>> buffers_;
    std::vector<std::optional<Bytes>> unpackedViews_;
    std::vector<Diagnostic> warnings_;
    std::uint64_t verticesLeft_;
    std::uint64_t unpackedBytesLeft_;
    std::uint64_t zeroElementsLeft_ = kMaxZeroElements;
    std::uint64_t imageBytes_ = 0;
};

}  // namespace glint::gltf
