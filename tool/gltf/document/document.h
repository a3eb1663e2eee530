// An opened and checked glTF document. Every part of the importer reads from it.
#pragma once

#include "gltf/document/files.h"
#include "gltf/document/model.h"
#include "gltf/document/report.h"

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint::gltf {

class Document : public Report {
public:
    // Reads, parses and checks the file. It opens no other file.
    static Result<std::unique_ptr<Document>> open(const std::filesystem::path& path,
                                                  const ImportOptions& options);

    // The document as tinygltf reads it. All types, ranges and references that the importer reads have been
    // checked.
    const tinygltf::Model& model() const {
        return model_;
    }
    // The members of the document that tinygltf can't be trusted with (model.cpp): buffers, images, materials
    // and the root's extensions, checked like the rest.
    const Json& json() const {
        return json_;
    }
    // The accessor must be one that the importer reads (usedAccessors()).
    const tinygltf::Accessor& accessor(int index) const {
        return model_.accessors[static_cast<std::size_t>(index)];
    }
    // Returns how far apart the elements of a buffer view are in bytes, or 0 if they follow each other.
    std::size_t stride(int bufferView) const {
        return model_.bufferViews[static_cast<std::size_t>(bufferView)].byteStride;
    }
    // Returns whether the file lists the extension as required.
    bool requiresExtension(std::string_view extension) const;

    // Returns the bytes of a buffer view, decompressed if necessary. The first use of a buffer opens it.
    Result<ByteView> bufferView(int index);
    // Reads the data URI, or the file that a relative URI names. `pointer` is that of its owner. Errors:
    // "data-uri", and those of FileSource.
    Result<base::Bytes> readUri(const std::string& uri, const std::string& pointer);
    // Takes bytes from the budget of decoded images. Returns false if it is exhausted.
    bool chargeImage(std::uint64_t bytes);

    const std::vector<SourceFile>& files() const {
        return source_.files();
    }

private:
    Document(const std::filesystem::path& path, const ImportOptions& options);

    Status parse(const std::string& name);
    Result<ByteView> buffer(int index);
    Result<ByteView> bufferRange(int buffer, std::uint64_t offset, std::uint64_t length,
                                 const std::string& pointer);
    Result<ByteView> unpackedView(int index, const Value& extension, const std::string& pointer);
    Result<base::Bytes> loadBuffer(const Json& buffer, const std::string& pointer);

    FileSource source_;
    base::Bytes file_;
    std::optional<ByteView> binary_;  // views file_
    Json json_;
    tinygltf::Model model_;
    std::vector<std::optional<base::Bytes>> buffers_;
    std::vector<std::optional<base::Bytes>> unpackedViews_;
};

}  // namespace glint::gltf
