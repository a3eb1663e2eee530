// Reads tables.bin from bytes: header, hash, sections.
#include "package/interop_hash.h"
#include "package/package_state.h"

#include <xxhash.h>

#include <bit>
#include <cstring>
#include <set>
#include <span>

namespace glint {
namespace {

// Computes the hash that PackageHeader::contentHash describes.
std::uint64_t contentHash(package::PackageHeader header, std::span<const std::uint8_t> file) {
    header.contentHash = 0;
    return XXH3_64bits_withSeed(file.data() + sizeof(header), file.size() - sizeof(header),
                                XXH3_64bits(&header, sizeof(header)));
}

static_assert(std::endian::native == std::endian::little, "packages are little endian and read in place");

Status readHeader(Package::State& state, const std::string& where) {
    const std::vector<std::uint8_t>& bytes = state.tables;
    constexpr std::size_t kMagicBytes = sizeof(package::kMagic);
    if (bytes.size() >= kMagicBytes && std::memcmp(bytes.data(), package::kMagic, kMagicBytes) != 0) {
        return makeError("package-foreign", where, "the file is not a Glint package table",
                         "give the folder that `glint compile` wrote");
    }
    package::PackageHeader& header = state.header;
    if (bytes.size() < sizeof(header)) {
        return makeError("package-truncated", where,
                         "the file ends within its header, after " + std::to_string(bytes.size()) + " bytes",
                         kRecompile);
    }
    std::memcpy(&header, bytes.data(), sizeof(header));
    if (header.version != package::kVersion) {
        return makeError("package-version", where,
                         "the package has format version " + std::to_string(header.version) +
                             ", this runtime reads version " + std::to_string(package::kVersion),
                         "compile the package with the glint of this runtime's release");
    }
    if (bytes.size() < header.fileBytes) {
        return makeError("package-truncated", where,
                         "the file has " + std::to_string(bytes.size()) + " of " +
                             std::to_string(header.fileBytes) + " bytes",
                         kRecompile);
    }
    if (bytes.size() > header.fileBytes) {
        return makeError("package-altered", where, "the file is longer than its header says", kRecompile);
    }
    if (contentHash(header, bytes) != header.contentHash) {
        return makeError("package-altered", where, "the contents differ from the hash in the header",
                         kRecompile);
    }
    if (header.interopHash != interopHash()) {
        return makeError("package-version", where,
                         "the package's shaders were built for other structures than this runtime's",
                         "compile the package with the glint of this runtime's release");
    }
    return okStatus();
}

// Checks the bounds of a section, then makes a span of its elements in place. The check divides, because a
// product could overflow.
template <typename T>
Status readSection(const Package::State& state, const package::PackageSection& section,
                   const std::string& where, std::span<const T>& elements) {
    const std::uint64_t size = state.tables.size();
    const bool inside = section.offset <= size && section.count <= (size - section.offset) / sizeof(T);
    const bool aligned = section.offset % 8 == 0;
    if (section.elementBytes != sizeof(T) || !inside || !aligned) {
        return makeError(
            "package-altered", where,
            "section " + std::to_string(static_cast<std::uint32_t>(section.kind)) + " does not fit the file",
            kRecompile);
    }
    elements = {reinterpret_cast<const T*>(state.tables.data() + section.offset),
                static_cast<std::size_t>(section.count)};
    return okStatus();
}

// Records of materials have any size that holds their textures.
Status readMaterials(Package::State& state, const package::PackageSection& section,
                     const std::string& where) {
    constexpr std::uint32_t kMostBytes = 1U << 16;
    const package::PackageHeader& header = state.header;
    const std::uint64_t end = header.materialTextureOffset +
                              std::uint64_t{header.materialTextureCount} * sizeof(gpu::TextureRecord);
    const bool fits = section.elementBytes % 4 == 0 && section.elementBytes > 0 &&
                      section.elementBytes <= kMostBytes && header.materialTextureOffset % 4 == 0 &&
                      end <= section.elementBytes;
    if (!fits || section.count > state.tables.size() / section.elementBytes) {
        return makeError("package-altered", where, "the records of materials do not fit their section",
                         kRecompile);
    }
    package::PackageSection bytes = section;
    bytes.count *= section.elementBytes;
    bytes.elementBytes = 1;
    state.materials = {{}, section.elementBytes, header.materialTextureOffset, header.materialTextureCount};
    return readSection(state, bytes, where, state.materials.bytes);
}

Status readKnownSection(Package::State& state, const package::PackageSection& section,
                        const std::string& where) {
    switch (section.kind) {
        case package::SectionKind::Modules:
            return readSection(state, section, where, state.modules);
        case package::SectionKind::Materials:
            return readMaterials(state, section, where);
        case package::SectionKind::Primitives:
            return readSection(state, section, where, state.primitives);
        case package::SectionKind::Textures:
            return readSection(state, section, where, state.textures);
        case package::SectionKind::Samplers:
            return readSection(state, section, where, state.samplers);
        case package::SectionKind::Strings:
            return readSection(state, section, where, state.strings);
        case package::SectionKind::Cases:
            return readSection(state, section, where, state.cases);
        case package::SectionKind::Scenes:
            return readSection(state, section, where, state.scenes);
        case package::SectionKind::Attributes:
            return readSection(state, section, where, state.attributes);
        case package::SectionKind::Effects:
            return readSection(state, section, where, state.effectEntries);
        case package::SectionKind::Emission:
            return readSection(state, section, where, state.emission);
        case package::SectionKind::Opacity:
            return readSection(state, section, where, state.opacity);
        case package::SectionKind::Layers:
            return readSection(state, section, where, state.layerEntries);
        case package::SectionKind::Features:
            return readSection(state, section, where, state.features);
    }
    return makeError(
        "package-altered", where,
        "the section kind " + std::to_string(static_cast<std::uint32_t>(section.kind)) + " is unknown",
        kRecompile);
}

}  // namespace

Status readTables(Package::State& state, const std::string& where) {
    GLINT_TRY_DO(readHeader(state, where));
    const std::uint64_t room = state.tables.size() - sizeof(package::PackageHeader);
    if (state.header.sectionCount > room / sizeof(package::PackageSection)) {
        return makeError("package-altered", where, "the section table does not fit the file", kRecompile);
    }
    std::set<package::SectionKind> seen;
    for (std::uint32_t i = 0; i < state.header.sectionCount; ++i) {
        package::PackageSection section{};
        std::memcpy(&section, state.tables.data() + sizeof(package::PackageHeader) + i * sizeof(section),
                    sizeof(section));
        if (!seen.insert(section.kind).second) {
            return makeError(
                "package-altered", where,
                "section " + std::to_string(static_cast<std::uint32_t>(section.kind)) + " is there twice",
                kRecompile);
        }
        GLINT_TRY_DO(readKnownSection(state, section, where));
    }
    // Every package has the sections up to that of the effects. Names of features are for messages only.
    constexpr std::size_t kSectionKinds = 10;
    seen.erase(package::SectionKind::Emission);
    seen.erase(package::SectionKind::Opacity);
    seen.erase(package::SectionKind::Features);
    seen.erase(package::SectionKind::Layers);
    if (seen.size() != kSectionKinds) {
        return makeError("package-altered", where,
                         "the package has " + std::to_string(seen.size()) + " of " +
                             std::to_string(kSectionKinds) + " sections",
                         kRecompile);
    }
    return okStatus();
}

}  // namespace glint
