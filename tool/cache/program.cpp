#include "cache/program.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <link.h>
#include <string_view>
#include <system_error>

namespace glint::compiler {

namespace fs = std::filesystem;

namespace {

// Returns the build ID among the notes of a segment, or an empty text. Layout: elf(5), "Notes (Nhdr)".
std::string_view findBuildId(std::string_view notes, std::size_t alignment) {
    const auto aligned = [&](std::size_t size) { return (size + alignment - 1) / alignment * alignment; };
    while (notes.size() >= sizeof(ElfW(Nhdr))) {
        ElfW(Nhdr) header;
        std::memcpy(&header, notes.data(), sizeof header);
        const std::size_t name = sizeof header;
        const std::size_t content = aligned(name + header.n_namesz);
        const std::size_t next = aligned(content + header.n_descsz);
        if (next > notes.size()) {
            break;
        }
        if (header.n_type == NT_GNU_BUILD_ID &&
            notes.substr(name, header.n_namesz) == std::string_view("GNU\0", 4)) {
            return notes.substr(content, header.n_descsz);
        }
        notes.remove_prefix(next);
    }
    return {};
}

std::string describeFile(const char* name) {
    const fs::path path = *name == '\0' ? fs::path("/proc/self/exe") : fs::path(name);
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);
    const auto time = fs::last_write_time(path, error);
    return fmt::format("{} {} {}", path.string(), size, time.time_since_epoch().count());
}

int addObject(dl_phdr_info* object, std::size_t, void* result) {
    std::string_view id;
    for (int i = 0; i < object->dlpi_phnum && id.empty(); ++i) {
        const ElfW(Phdr)& segment = object->dlpi_phdr[i];
        if (segment.p_type == PT_NOTE) {
            // NOLINTNEXTLINE(performance-no-int-to-ptr): the loader gives an address as a number.
            const auto* const notes = reinterpret_cast<const char*>(object->dlpi_addr + segment.p_vaddr);
            constexpr std::size_t kUsual = 4;
            id = findBuildId({notes, segment.p_memsz}, segment.p_align == 8 ? 8 : kUsual);
        }
    }
    std::string& text = *static_cast<std::string*>(result);
    for (const char byte : id) {
        text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
    }
    text += (id.empty() ? describeFile(object->dlpi_name) : std::string()) + "\n";
    return 0;
}

}  // namespace

std::string programIdentity() {
    std::string text;
    dl_iterate_phdr(addObject, &text);
    return text;
}

}  // namespace glint::compiler
