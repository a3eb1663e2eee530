// Notices changes of files by asking for their states again and again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint::base {

// Polling needs no service of the system and works on every file system; it costs one or two microseconds of
// processor time for each file and poll.
class InputWatch {
public:
    // Replaces the watched files. Files that were watched before keep the state in which the last changed()
    // or accept() saw them, so that no change is lost while somebody works on them. A folder is watched for
    // files that come and go.
    void watch(std::span<const std::string> paths);

    // Returns the files whose contents changed since the last call. A file that was only touched has not
    // changed, and one that is missing has only if it stays away for a while: editors replace files by
    // renaming others, or remove and write them. Waits until the files that changed have been at rest for
    // kRestMs, as programs write large files piece by piece, but at most kPatienceMs.
    std::vector<std::string> changed();

    // Whether a file looks other than known. Folders do not count: what the program writes may change them.
    // Any thread may ask while no other member runs.
    bool looksChanged() const;

    // Takes the present contents of a file as known: the program itself has written it.
    void accept(const std::string& path);

    static constexpr int kRestMs = 10;
    static constexpr int kPatienceMs = 500;
    static constexpr int kMissingMs = 250;

private:
    // What one call to the system says of a file.
    struct Look {
        std::int64_t time = 0;  // of the last change, in the file system's clock
        std::uint64_t bytes = 0;
        std::uint64_t number = 0;  // of the file, which a rename changes

        friend bool operator==(const Look&, const Look&) = default;
    };
    struct File {
        std::optional<Look> look;           // no value: missing
        std::optional<std::uint64_t> hash;  // of the contents; none for folders and missing files
    };

    static std::optional<Look> lookAt(const std::string& path);
    static File stateOf(const std::string& path);
    // Returns the files that look other than known.
    std::vector<std::string> suspects() const;

    std::map<std::string, File> files_;
};

}  // namespace glint::base
