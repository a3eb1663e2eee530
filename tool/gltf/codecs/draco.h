// Decodes primitives that are compressed with KHR_draco_mesh_compression.
#pragma once

#include "gltf/document/accessor.h"
#include "gltf/document/document.h"

#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace draco {
class Mesh;
}

namespace glint::gltf {

class DracoMesh {
public:
    // Decodes the data of the extension object, which checkDocument() accepted. `pointer` is that of the
    // extension. Errors: "draco-decode" with the decoder's message, "draco-size" if the header claims more
    // than its data can hold, "vertex-limit", and those of reading the buffer view.
    static Result<DracoMesh> decode(Document& document, const Value& extension, const std::string& pointer);

    DracoMesh(DracoMesh&& other) noexcept;
    DracoMesh& operator=(DracoMesh&& other) noexcept;
    ~DracoMesh();

    std::size_t pointCount() const;
    // Returns a triangle list. Each index is below pointCount().
    const std::vector<std::uint32_t>& indices() const {
        return indices_;
    }
    // Whether there is an attribute with that unique identifier.
    bool has(std::uint32_t id) const;
    // Returns the elements of that attribute, packed tightly in the format of their accessor. The error is
    // "draco-attribute" if there is no such attribute or its values have another form.
    Result<base::Bytes> attribute(const Document& document, std::uint32_t id, const ElementFormat& format,
                                  const std::string& pointer) const;

private:
    explicit DracoMesh(std::unique_ptr<draco::Mesh> mesh);

    std::unique_ptr<draco::Mesh> mesh_;
    std::vector<std::uint32_t> indices_;
};

}  // namespace glint::gltf
