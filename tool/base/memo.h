// Keeps results of long computations from run to run.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace glint::base {

// Implementations are thread-safe, and report no failures: a value can be lost at any time.
class Memo {
public:
    Memo() = default;
    Memo(const Memo&) = delete;
    Memo& operator=(const Memo&) = delete;
    virtual ~Memo() = default;
    // `kind` names the sort of result. `key` holds everything that the value depends on.
    virtual std::optional<std::string> find(std::string_view kind, std::string_view key) = 0;
    virtual void put(std::string_view kind, std::string_view key, std::string_view value) = 0;
};

}  // namespace glint::base
