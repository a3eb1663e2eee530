// An opened and checked glTF document, with the messages of its import. Every part of the importer reads from
// it.
#pragma once

#include "gltf/document/files.h"
#include "gltf/document/material_list.h"
#include "gltf/document/model.h"
#include "gltf/import_options.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::gltf {

// An amount that keeps hostile files from using up the machine's memory.
class Budget {
public:
    explicit Budget(std::uint64_t left) : left_(left) {}

    // Returns false if less than the amount is left.
    bool take(std::uint64_t amount) {
        const bool isEnough = amount <= left_;
        left_ -= isEnough ? amount : 0;
        return isEnough;
    }
    std::uint64_t left() const {
        return left_;
    }

private:
    std::uint64_t left_;
};

class Document {
public:
    // Reads, parses and checks the file. It opens no other file.
    static Result<std::unique_ptr<Document>> open(const std::filesystem::path& path,
                                                  const ImportOptions& options);
    // Makes the document of a set of materials, and checks it. It opens no file.
    static Result<std::unique_ptr<Document>> open(const MaterialSet& set, const ImportOptions& options);

    const ImportOptions& options() const {
        return options_;
    }
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
    // "data-uri", "uri-unsafe", "file-open", "file-size", "file-read".
    Result<base::Bytes> readUri(const std::string& uri, const std::string& pointer);
    // Lists each file once, in the order of opening.
    const std::vector<SourceFile>& files() const {
        return files_;
    }

    // The parameters of a set of materials that a program may set.
    const std::vector<EditedValue>& edited() const {
        return edited_;
    }

    // "scene.gltf#/materials/3". Pointers of a document that was made of a material list become those of the
    // list.
    std::string where(std::string_view pointer) const;
    Diagnostic error(std::string id, std::string_view pointer, std::string message,
                     std::string hint = {}) const;
    void warn(std::string id, std::string_view pointer, std::string message, std::string hint = {});
    void note(std::string id, std::string_view pointer, std::string message, std::string hint = {});
    // These include notes.
    std::vector<Diagnostic>& warnings() {
        return warnings_;
    }

    // Takes `count` elements from the budget of ImportOptions::maxVertices. The error is "vertex-limit" at
    // `pointer` if the budget is exhausted.
    Status chargeVertices(std::uint64_t count, std::string_view pointer);
    const Budget& vertices() const {
        return vertices_;
    }
    // Takes bytes from the budget of decoded images, which grows with the size of the files that were read.
    // Returns false if it is exhausted.
    bool chargeImage(std::uint64_t bytes);
    // Bytes of unpacked buffer views and meshes: ImportOptions::maxFileBytes.
    Budget& unpackedBytes() {
        return unpackedBytes_;
    }
    // Elements of accessors without a buffer view take no bytes of the file, so the file's size doesn't bound
    // them. They count each time that a primitive reads such an accessor.
    static constexpr std::uint64_t kMaxZeroElements = 1ULL << 22;
    Budget& zeroElements() {
        return zeroElements_;
    }

private:
    Document(const std::filesystem::path& path, const ImportOptions& options);

    Status parse();
    Status expand(const MaterialSet& set);
    Status check();
    Result<ByteView> buffer(int index);
    Result<ByteView> bufferRange(int buffer, std::uint64_t offset, std::uint64_t length,
                                 const std::string& pointer);
    Result<ByteView> unpackedView(int index, const Value& extension, const std::string& pointer);
    Result<base::Bytes> loadBuffer(const Json& buffer, const std::string& pointer);
    Result<base::Bytes> readRelative(const std::string& uri, const std::string& pointer);
    Result<base::Bytes> readFile(const std::filesystem::path& path);

    std::string name_;
    ImportOptions options_;
    std::vector<Diagnostic> warnings_;
    Budget vertices_;
    Budget unpackedBytes_;
    Budget zeroElements_{kMaxZeroElements};
    std::uint64_t imageBytes_ = 0;
    std::uint64_t fileBytes_;  // that all files together may still have
    std::vector<SourceFile> files_;
    base::Bytes file_;
    std::optional<ByteView> binary_;  // views file_
    Json json_;
    std::map<std::string, std::string, std::less<>> places_;  // ExpandedMaterials
    std::vector<EditedValue> edited_;
    tinygltf::Model model_;
    std::vector<std::optional<base::Bytes>> buffers_;
    std::vector<std::optional<base::Bytes>> unpackedViews_;
};

// Decodes the bytes of a buffer view that is compressed with EXT_meshopt_compression or
// KHR_meshopt_compression (codecs/meshopt.cpp). `packed` are the bytes; checkDocument() must have accepted
// the members of the extension. `byteLength` and `pointer` are those of the buffer view. Errors:
// "meshopt-layout" (members that contradict each other), "meshopt-decode", "meshopt-size" (more than the
// packed bytes can hold, or than the budget of ImportOptions::maxFileBytes).
Result<base::Bytes> unpackMeshopt(Document& document, const Value& extension, const std::string& pointer,
                                  ByteView packed, std::uint64_t byteLength);

}  // namespace glint::gltf
