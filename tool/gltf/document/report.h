// The messages of an import, and the budgets that keep hostile files from using up the machine's memory.
#pragma once

#include "gltf/import_options.h"

#include <glint/result.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glint::gltf {

class Report {
public:
    // `file` is the scene's name in messages.
    Report(std::string file, const ImportOptions& options);

    const ImportOptions& options() const {
        return options_;
    }

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
    // Takes bytes from the budget of decoded images, which grows with `fileBytes`, the size of the files that
    // were read. Returns false if it is exhausted.
    bool chargeImageBytes(std::uint64_t bytes, std::uint64_t fileBytes);

private:
    std::string file_;
    ImportOptions options_;
    std::vector<Diagnostic> warnings_;
    std::uint64_t verticesLeft_;
    std::uint64_t unpackedBytesLeft_;
    std::uint64_t zeroElementsLeft_ = kMaxZeroElements;
    std::uint64_t imageBytes_ = 0;
};

}  // namespace glint::gltf
