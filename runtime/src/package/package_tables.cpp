// Reads the files of a package and refuses files outside the package's folder.
#include "package/package.h"

#include <xxhash.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <set>
#include <span>
#include <system_error>

namespace glint {
namespace {

constexpr std::uint32_t kSpirvMagic = 0x07230203;
constexpr std::size_t kSpirvHeaderBytes = 20;
// Returns whether a name is a relative path of plain components, so that the name does not lead out of the
// folder.
bool staysInside(const std::filesystem::path& name) {
    if (name.empty() || name.is_absolute() || name.has_root_path()) {
        return false;
    }
    return std::ranges::all_of(
        name, [](const std::filesystem::path& part) { return !part.empty() && part != ".." && part != "."; });
}

// Returns whether symbolic links keep the file inside the folder too. `file` must exist.
bool resolvesInside(const std::filesystem::path& folder, const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::path root = std::filesystem::canonical(folder, error);
    if (error) {
        return false;
    }
    const std::filesystem::path target = std::filesystem::canonical(file, error);
    if (error) {
        return false;
    }
    return std::ranges::mismatch(root, target).in1 == root.end();
}

Result<std::vector<std::uint32_t>> readModule(const PackageFiles& files, const std::string& name,
                                              const package::ModuleEntry& entry) {
    const std::string where = files.where(name);
    GLINT_TRY(auto bytes, files.read(name, "package-module-missing", entry.bytes));
    if (bytes.size() != entry.bytes) {
        return makeError("package-module-altered", where,
                         phrase("the module has ", bytes.size(), " bytes, the package says ", entry.bytes),
                         kRecompile);
    }
    if (XXH3_64bits(bytes.data(), bytes.size()) != entry.hash) {
        return makeError("package-module-altered", where,
                         "the module's contents differ from the package's hash", kRecompile);
    }
    std::vector<std::uint32_t> words(bytes.size() / sizeof(std::uint32_t));
    const bool holdsHeader = bytes.size() % sizeof(std::uint32_t) == 0 && bytes.size() >= kSpirvHeaderBytes;
    if (holdsHeader) {
        std::memcpy(words.data(), bytes.data(), bytes.size());
    }
    if (!holdsHeader || words[0] != kSpirvMagic) {
        return makeError("package-module-altered", where, "the module is not SPIR-V", kRecompile);
    }
    return words;
}

// Reads up to one byte more than allowed. That byte tells the caller that the file is longer, without reading
// all of it.
Result<std::vector<std::uint8_t>> readWhole(const std::filesystem::path& path, const char* missingId,
                                            std::uint64_t maxBytes) {
    const std::string where = path.string();
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) {
        return makeError(missingId, where, "there is no such file",
                         "give the folder that `glint compile` wrote, or compile the package again");
    }
    const std::uint64_t size = std::filesystem::file_size(path, error);
    std::ifstream stream(path, std::ios::binary);
    if (error || !stream) {
        return makeError("package-read", where, "the file cannot be opened", "check its permissions");
    }
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(std::min(size, maxBytes + 1)));
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (static_cast<std::size_t>(stream.gcount()) != bytes.size()) {
        return makeError("package-read", where, "the file cannot be read to its end", "check the disk");
    }
    return bytes;
}

}  // namespace

PackageFiles filesOf(const std::filesystem::path& folder) {
    const auto where = [folder](const std::string& name) { return (folder / name).string(); };
    const auto read = [folder, where](const std::string& name, const char* missingId,
                                      std::uint64_t maxBytes) -> Result<std::vector<std::uint8_t>> {
        if (!staysInside(name) || name.find('\\') != std::string::npos ||
            name.find('\0') != std::string::npos) {
            return makeError("package-file-name", where(package::kTablesFile),
                             "the module file name \"" + name + "\" does not stay in the package's folder",
                             kRecompile);
        }
        GLINT_TRY(auto bytes, readWhole(folder / name, missingId, maxBytes));
        if (!resolvesInside(folder, folder / name)) {
            return makeError("package-file-name", where(name),
                             "the file is a link that leaves the package's folder", kRecompile);
        }
        return bytes;
    };
    return {where, read};
}

PackageFiles filesOf(std::span<const package::EmbeddedFile> files) {
    const auto where = [](const std::string& name) { return "embedded " + name; };
    const auto read = [files, where](const std::string& name, const char* missingId,
                                     std::uint64_t maxBytes) -> Result<std::vector<std::uint8_t>> {
        const auto file = std::ranges::find(files, name, &package::EmbeddedFile::name);
        if (file == files.end()) {
            return makeError(missingId, where(name), "there is no such file in memory",
                             "pass all files that `glint compile --embed` made");
        }
        const auto kept = file->bytes.first(
            static_cast<std::size_t>(std::min<std::uint64_t>(file->bytes.size(), maxBytes + 1)));
        return std::vector<std::uint8_t>(kept.begin(), kept.end());
    };
    return {where, read};
}

Status readModules(Package::State& state, const PackageFiles& files) {
    for (const package::ModuleEntry& entry : state.modules) {
        const std::string name(state.strings.data() + entry.file.offset, entry.file.length);
        // Entries that share a file have the same size and hash, which checkTables() has ensured.
        if (state.spirv.contains(name)) {
            continue;
        }
        GLINT_TRY(auto words, readModule(files, name, entry));
        const XXH128_hash_t hash = XXH3_128bits(words.data(), words.size() * sizeof(std::uint32_t));
        const auto kept = state.spirv.emplace(name, std::move(words)).first;
        state.hashes[kept->second.data()] = {hash.low64, hash.high64};
    }
    return okStatus();
}

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
                         phrase("the file ends within its header, after ", bytes.size(), " bytes"),
                         kRecompile);
    }
    std::memcpy(&header, bytes.data(), sizeof(header));
    if (header.version != package::kVersion) {
        return makeError("package-version", where,
                         phrase("the package has format version ", header.version,
                                ", this runtime reads version ", package::kVersion),
                         "compile the package with the glint of this runtime's release");
    }
    if (bytes.size() < header.fileBytes) {
        return makeError("package-truncated", where,
                         phrase("the file has ", bytes.size(), " of ", header.fileBytes, " bytes"),
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
            phrase("section ", static_cast<std::uint32_t>(section.kind), " does not fit the file"),
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
        case package::SectionKind::Fields:
            return readSection(state, section, where, state.fields);
    }
    return makeError("package-altered", where,
                     phrase("the section kind ", static_cast<std::uint32_t>(section.kind), " is unknown"),
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
            return makeError("package-altered", where,
                             phrase("section ", static_cast<std::uint32_t>(section.kind), " is there twice"),
                             kRecompile);
        }
        GLINT_TRY_DO(readKnownSection(state, section, where));
    }
    // Every package has the sections up to that of the effects, the features and the fields of records.
    constexpr std::size_t kSectionKinds = 12;
    seen.erase(package::SectionKind::Emission);
    seen.erase(package::SectionKind::Opacity);
    seen.erase(package::SectionKind::Layers);
    if (seen.size() != kSectionKinds) {
        return makeError("package-altered", where,
                         phrase("the package has ", seen.size(), " of ", kSectionKinds, " sections"),
                         kRecompile);
    }
    return okStatus();
}

std::uint32_t interopHash() {
    const std::string_view text = interopText();
    return static_cast<std::uint32_t>(XXH3_64bits(text.data(), text.size()));
}

}  // namespace glint
